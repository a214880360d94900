# The lints as tests (label host). Each is a script that takes the root of the tree to look at; selftest.sh proves that each refuses what it should.
foreach(lint format layers kernel_syntax kernel_symbols kernel_contraction)
  add_test(NAME lint.${lint} COMMAND ${CMAKE_SOURCE_DIR}/tools/lint/${lint}.sh ${CMAKE_SOURCE_DIR})
  list(APPEND lints lint.${lint})
endforeach()
add_test(NAME lint.selftest COMMAND ${CMAKE_SOURCE_DIR}/tools/lint/selftest.sh)
set_tests_properties(${lints} lint.selftest PROPERTIES LABELS "host;lint" TIMEOUT 300)
