# The lints as tests (label host). Each is a script that takes the root of the tree to look at; selftest.sh proves that each refuses what it should.
find_program(CLVR_CLANG_FORMAT clang-format-14) # another version formats otherwise: then there is no such test
foreach(lint format layers documents kernel_syntax kernel_symbols kernel_contraction)
  if(lint STREQUAL "format" AND NOT CLVR_CLANG_FORMAT)
    message(STATUS "no clang-format-14 here: the format of the source is not tested")
    continue()
  endif()
  add_test(NAME lint.${lint} COMMAND ${CMAKE_SOURCE_DIR}/tools/lint/${lint}.sh ${CMAKE_SOURCE_DIR})
  list(APPEND lints lint.${lint})
endforeach()
add_test(NAME lint.selftest COMMAND ${CMAKE_SOURCE_DIR}/tools/lint/selftest.sh)
set_tests_properties(${lints} lint.selftest PROPERTIES LABELS "host;lint" TIMEOUT 900)
