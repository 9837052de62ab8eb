# Read by ctest when it starts: an entry for each suite of a GoogleTest program.
# In: layer, program, folder (where the tests run).
if(NOT EXISTS "${program}")
    add_test("${layer}_NOT_BUILT" "${program}")
    return()
endif()
execute_process(COMMAND "${program}" --gtest_list_tests
    WORKING_DIRECTORY "${folder}" OUTPUT_VARIABLE listed RESULT_VARIABLE status TIMEOUT 60)
if(NOT status EQUAL 0)
    message(FATAL_ERROR "${program} --gtest_list_tests: ${status}")
endif()
# Cases that a preset leaves out by the environment, which --gtest_filter replaces.
set(without "")
if("$ENV{GTEST_FILTER}" MATCHES "^-(.*)")
    set(without "-${CMAKE_MATCH_1}")
endif()
string(REGEX MATCHALL "(^|\n)[^ \n][^\n]*\\.[^\n]*" suites "${listed}")
foreach(suite IN LISTS suites)
    string(REGEX REPLACE "^\n?([^ ]+)\\..*" "\\1" suite "${suite}")
    if(suite MATCHES "^DISABLED_|/DISABLED_")
        continue()
    endif()
    add_test("${layer}.${suite}" "${program}" "--gtest_filter=${suite}.*${without}")
    # A suite of which a case was skipped, and none failed, says so by its status (tests/support/main.cpp).
    set_tests_properties("${layer}.${suite}" PROPERTIES WORKING_DIRECTORY "${folder}" TIMEOUT 1800
        ENVIRONMENT "RELEVO_SKIP_STATUS=77" SKIP_RETURN_CODE 77)
endforeach()
