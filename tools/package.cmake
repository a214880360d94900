# install() and the relocatable tarball: bin/clvr and bin/clvr-bench find the libraries they were built with in lib/clvr beside them, on any x86-64 Linux with
# glibc 2.36 and GCC 12's runtime. Not carried: glibc, libstdc++, libgcc_s, and OpenCL drivers (those belong to the machine).
# DT_RPATH, not DT_RUNPATH: it also serves the libraries that the libraries need. tools/check_package.sh tries the tarball on a bare Debian 13.
set_target_properties(clvr clvr-bench PROPERTIES INSTALL_RPATH "$ORIGIN/../lib/clvr")
target_link_options(clvr PRIVATE LINKER:--disable-new-dtags)
target_link_options(clvr-bench PRIVATE LINKER:--disable-new-dtags)

install(TARGETS clvr clvr-bench RUNTIME_DEPENDENCY_SET clvr_libraries RUNTIME DESTINATION bin)
install(
  RUNTIME_DEPENDENCY_SET clvr_libraries
  PRE_EXCLUDE_REGEXES "^ld-linux" "^lib(c|m|dl|rt|pthread|resolv|stdc\\+\\+|gcc_s)\\.so"
  LIBRARY DESTINATION lib/clvr)
install(FILES LICENSE README.md DESTINATION share/doc/clvr)

# Manual pages and completions, as the programs write them from their own description of their options.
set(share ${CMAKE_BINARY_DIR}/share)
add_custom_command(
  OUTPUT ${share}/written
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${share}
  COMMAND clvr --share-files ${share}
  COMMAND clvr-bench --share-files ${share}
  COMMAND ${CMAKE_COMMAND} -E touch ${share}/written
  DEPENDS clvr clvr-bench
  VERBATIM)
add_custom_target(clvr_share ALL DEPENDS ${share}/written)
install(DIRECTORY ${share}/ DESTINATION share PATTERN written EXCLUDE)

# The licence of each carried library, as its Debian package states it.
install(CODE [[
  set(prefix "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}")
  find_program(DPKG_QUERY dpkg-query)
  file(GLOB libraries "${prefix}/lib/clvr/*.so*")
  foreach(library IN LISTS libraries)
    cmake_path(GET library FILENAME name)
    if(DPKG_QUERY AND NOT IS_SYMLINK "${library}")
      execute_process(COMMAND ${DPKG_QUERY} -S "*/${name}" OUTPUT_VARIABLE owner ERROR_QUIET)
      string(REGEX MATCH "^[^:,\n]+" package "${owner}")
      if(EXISTS "/usr/share/doc/${package}/copyright")
        file(COPY_FILE "/usr/share/doc/${package}/copyright" "${prefix}/share/doc/clvr/${package}.copyright" ONLY_IF_DIFFERENT)
      endif()
    endif()
  endforeach()
]])

set(CPACK_GENERATOR TGZ DEB)
set(CPACK_PACKAGE_VENDOR clvr)
set(CPACK_PACKAGE_CONTACT "clvr's authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "volume renderer for scientific and medical data on OpenCL")
set(CPACK_PACKAGE_DESCRIPTION "Turns CT, MRI, microscopy and simulation volumes into pictures by path tracing on any\nOpenCL device, and removes their noise with a small neural network.")
set(CPACK_PACKAGE_FILE_NAME clvr-${PROJECT_VERSION}-linux-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
# The .deb carries its libraries as the tarball does, so that one package serves Debian 12 and every later one, whose libraries have other versions. It
# wants a device to compute on: PoCL, unless another OpenCL driver is there.
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libc6 (>= 2.36), libstdc++6 (>= 12), libgcc-s1 (>= 12), ca-certificates, pocl-opencl-icd | opencl-icd")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "ffmpeg, xdg-utils")
include(CPack)
