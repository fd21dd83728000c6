# Writes a file of ctest tests, one for each test suite of a program:
# cmake -DUNIT= -DPROGRAM= -DOUTPUT= -DFILTER= -DLABEL= -DCAMPAIGNS= -DPROPERTIES= -P DiscoverSuites.cmake
# A suite is one process: its cases share what the first of them made, and there are 300 program starts, not 2,000.
# FILTER: gtest's; with one, the program is one test. CAMPAIGNS: the tests that have the label campaign, too. PROPERTIES:
# ctest's, as set_tests_properties() takes them.
cmake_minimum_required(VERSION 3.25)
set(tests "")
function(add_suite name filter)
  set(labels ${LABEL})
  if(name IN_LIST CAMPAIGNS)
    list(APPEND labels campaign)
  endif()
  string(APPEND tests "add_test([=[${name}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${filter}]=])\n"
    "set_tests_properties([=[${name}]=] PROPERTIES ${PROPERTIES} LABELS [=[${labels}]=])\n")
  set(tests ${tests} PARENT_SCOPE)
endfunction()

if(FILTER STREQUAL "*")
  execute_process(COMMAND "${PROGRAM}" --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "(^|\n)[^ \n][^\n]*\\.( |\n)" suites "${listed}")
  foreach(suite IN LISTS suites)
    string(REGEX REPLACE "^\n?(.*)\\.[ \n]$" "\\1" suite "${suite}")
    add_suite("${UNIT}.${suite}" "${suite}.*")
  endforeach()
else()
  add_suite("${UNIT}" "${FILTER}")
endif()
file(WRITE "${OUTPUT}" "${tests}")
