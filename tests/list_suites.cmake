# cmake -DPROGRAM=.. -DNAME=.. -DLIST=.. -P list_suites.cmake: writes the suites of a test program into LIST, one CTest test per
# suite. The tests of a suite run in one process, which builds the kernels and the suite's common data once.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" lines "${listed}")
set(tests "")
foreach(line ${lines})
  if(line MATCHES "^([^ ]+)\\.($| )")
    set(suite ${CMAKE_MATCH_1})
    string(APPEND tests "add_test([=[${NAME}.${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n"
      "set_tests_properties([=[${NAME}.${suite}]=] PROPERTIES TIMEOUT 1800)\n")
    if(NAME STREQUAL cli)
      string(APPEND tests "set_tests_properties([=[${NAME}.${suite}]=] PROPERTIES FIXTURES_REQUIRED checked_device)\n")
    endif()
    if(suite MATCHES "AuthorsPacking|RandomScenes|Diagnose[A-Za-z]*Test|ProgrammePartsTest|CliTest")  # long: these begin first
      string(APPEND tests "set_tests_properties([=[${NAME}.${suite}]=] PROPERTIES COST 200)\n")
    endif()
  endif()
endforeach()
file(WRITE ${LIST} "${tests}")
