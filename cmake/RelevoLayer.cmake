# Flags that every target of the project is compiled with. Warnings are for developers alone, as errors: a compiler that warns
# of more than ours must not keep people from building, and looking for them takes a twentieth of the time. Others see
# none, nor do benches: GCC 12 sees overruns in std::string at -O3 that are not there (its bug 105329).
add_library(relevo_options INTERFACE)
set(warnings -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
    -Woverloaded-virtual -Wcast-qual -Wimplicit-fallthrough
    -Wno-missing-field-initializers  # designated initialisers leave members at their defaults
    -Wno-restrict                    # GCC 12 sees overlaps in std::string at -O3 (its bug 105329)
    -Werror)
if(CMAKE_UNITY_BUILD)
    # Files of a batch are included, as headers are: a local name may be that of another file's constant.
    list(APPEND warnings -Wno-subobject-linkage -Wno-shadow -Wshadow=local)
endif()
target_compile_options(relevo_options INTERFACE $<IF:$<AND:$<BOOL:${RELEVO_TESTS}>,$<NOT:$<CONFIG:Release>>>,${warnings},-w>
    # GCC compiles a tenth faster where it frees no memory before it has 1 GiB.
    $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1048576>)

# The largest batches take 2.3 GB of memory: no more at once than there is memory for. Ninja alone starts two more commands
# than there are processors.
if(CMAKE_UNITY_BUILD)
    cmake_host_system_information(RESULT memory_mib QUERY TOTAL_PHYSICAL_MEMORY)
    math(EXPR at_once "${memory_mib} / 2500")
    if(at_once LESS 1)
        set(at_once 1)
    endif()
    set_property(GLOBAL PROPERTY JOB_POOLS compile=${at_once})
    set(CMAKE_JOB_POOL_COMPILE compile)
endif()

# relevo_layer(<name> SOURCES ... [DEPENDS <lower layers>...] [LINKS <libraries used inside>...]
#              [PUBLIC_LINKS <libraries seen in headers>...])
#
# One static library for a layer of core/, alias relevo::<name>. Includes are written from core/:
# #include "sun/position.h".
function(relevo_layer name)
    cmake_parse_arguments(LAYER "" "" "SOURCES;DEPENDS;LINKS;PUBLIC_LINKS" ${ARGN})
    add_library(relevo_${name} STATIC ${LAYER_SOURCES})
    add_library(relevo::${name} ALIAS relevo_${name})
    target_include_directories(relevo_${name} PUBLIC ${CMAKE_SOURCE_DIR}/core ${CMAKE_SOURCE_DIR}/include)
    target_link_libraries(relevo_${name} PRIVATE relevo_options ${LAYER_LINKS})
    list(TRANSFORM LAYER_DEPENDS PREPEND relevo::)
    target_link_libraries(relevo_${name} PUBLIC ${LAYER_DEPENDS} ${LAYER_PUBLIC_LINKS})
    if(TARGET relevo_precompiled)  # tests/sweep_on_arm has none
        target_precompile_headers(relevo_${name} REUSE_FROM relevo_precompiled)
    endif()
endfunction()

# relevo_test(<layer> [REFERENCES] [SUITES] SOURCES ... [DEPENDS <layers>...] [LINKS ...])
#
# One GoogleTest program for a layer. ctest has an entry for each case, "<layer>.<suite>.<case>", or with SUITES for each
# suite, "<layer>.<suite>"; they are found when ctest starts, so that a build runs nothing of what it has built. Tests that
# do no sums of their own are compiled without optimisation in the presets of developers, which takes half the time;
# REFERENCES are those that compute what they compare with.
include(GoogleTest)
set(relevo_test_options $<$<CONFIG:Dev,Asan,Tsan>:-O0>)
set(relevo_reference_options $<$<CONFIG:Dev,Asan,Tsan>:-O1>)
function(relevo_test name)
    cmake_parse_arguments(TEST "REFERENCES;SUITES" "" "SOURCES;DEPENDS;LINKS" ${ARGN})
    add_executable(test_${name} ${TEST_SOURCES})
    if(TEST_REFERENCES)
        target_compile_options(test_${name} PRIVATE ${relevo_reference_options})
        target_precompile_headers(test_${name} REUSE_FROM relevo_precompiled_references)
    else()
        target_compile_options(test_${name} PRIVATE ${relevo_test_options})
        target_precompile_headers(test_${name} REUSE_FROM relevo_precompiled_tests)
    endif()
    list(TRANSFORM TEST_DEPENDS PREPEND relevo::)
    target_link_libraries(test_${name} PRIVATE relevo_options relevo_test_support ${TEST_DEPENDS}
        ${TEST_LINKS} fmt::fmt GTest::gmock GTest::gtest)
    if(TEST_SUITES)
        file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/test_${name}_suites.cmake @ONLY CONTENT
"set(layer @name@)
set(program \"@CMAKE_RUNTIME_OUTPUT_DIRECTORY@/test_@name@\")
set(folder \"@CMAKE_CURRENT_BINARY_DIR@\")
include(\"@CMAKE_SOURCE_DIR@/cmake/TestSuites.cmake\")
")
        set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES
            ${CMAKE_CURRENT_BINARY_DIR}/test_${name}_suites.cmake)
    else()
        gtest_discover_tests(test_${name} TEST_PREFIX ${name}. NO_PRETTY_VALUES DISCOVERY_MODE PRE_TEST
            DISCOVERY_TIMEOUT 60
            PROPERTIES TIMEOUT 600)
    endif()
endfunction()

# relevo_module(<plugin id> SOURCES ... [LINKS ...])
#
# The native module of a plugin: a shared library that knows nothing of Relevo but the interface.
function(relevo_module id)
    cmake_parse_arguments(MODULE "" "" "SOURCES;LINKS" ${ARGN})
    add_library(relevo_plugin_${id} MODULE ${MODULE_SOURCES})
    set_target_properties(relevo_plugin_${id} PROPERTIES PREFIX "" OUTPUT_NAME ${id}
        LIBRARY_OUTPUT_DIRECTORY ${RELEVO_MODULE_DIR}/plugins CXX_VISIBILITY_PRESET hidden)
    target_include_directories(relevo_plugin_${id} PRIVATE ${CMAKE_SOURCE_DIR}/include)
    target_link_libraries(relevo_plugin_${id} PRIVATE relevo_options ${MODULE_LINKS})
    set_property(GLOBAL APPEND PROPERTY RELEVO_PLUGIN_MODULES relevo_plugin_${id})
    install(TARGETS relevo_plugin_${id} LIBRARY DESTINATION lib/relevo/plugins COMPONENT librelevo0)
endfunction()
