# Target `coverage`: runs the host and device tests of a build with CLVR_COVERAGE and reports which lines of runtime/ and host/ they reached,
# as a table and as coverage/index.html in the build folder.
find_program(GCOVR gcovr REQUIRED)
add_custom_target(
  coverage
  COMMAND ${CMAKE_COMMAND} -E make_directory coverage
  COMMAND find . -name "*.gcda" -delete
  COMMAND ${CMAKE_CTEST_COMMAND} --output-on-failure -L "^(host|device)$" -LE lint
  COMMAND ${GCOVR} --root ${CMAKE_SOURCE_DIR} --filter ${CMAKE_SOURCE_DIR}/runtime/ --filter ${CMAKE_SOURCE_DIR}/host/ --exclude-throw-branches
          --print-summary --txt --html-details coverage/index.html ${CMAKE_BINARY_DIR}
  WORKING_DIRECTORY ${CMAKE_BINARY_DIR}
  USES_TERMINAL VERBATIM)
get_property(test_programs DIRECTORY ${CMAKE_SOURCE_DIR}/tests PROPERTY BUILDSYSTEM_TARGETS)
add_dependencies(coverage clvr ${test_programs})
