# Precompiled headers: parsing the headers of libraries again for every file was a third of a build. No file relies on
# them: the presets of the sanitizers set CMAKE_DISABLE_PRECOMPILE_HEADERS, so that a file which lacks an include does not
# compile there. Files that have other options than their target cannot use them (SKIP_PRECOMPILE_HEADERS).
#
# relevo_precompiled has the headers that most files of core/ include; its only source is empty. Layers use it by
# target_precompile_headers(<target> REUSE_FROM relevo_precompiled). nlohmann/json.hpp is not among them: each file would
# take a second longer, also one that does not use it.
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/precompiled.cpp CONTENT "")
add_library(relevo_precompiled OBJECT ${CMAKE_BINARY_DIR}/generated/precompiled.cpp)
target_link_libraries(relevo_precompiled PRIVATE relevo_options fmt::fmt glm::glm)
set(relevo_precompiled_headers <algorithm> <array> <atomic> <charconv> <chrono> <cmath> <cstdint> <cstring> <deque>
    <filesystem> <functional> <future> <limits> <map> <memory> <mutex> <optional> <set> <span> <string> <string_view>
    <thread> <unordered_map> <utility> <vector> <fmt/format.h> <fmt/ranges.h> <glm/glm.hpp>)
target_precompile_headers(relevo_precompiled PRIVATE ${relevo_precompiled_headers})

# The same for tests, which are compiled with other options: those of tests, and of tests that are REFERENCES.
function(relevo_precompiled_for_tests name options)
    add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/generated/precompiled.cpp)
    # As programs are compiled, not libraries.
    set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
    target_compile_options(${name} PRIVATE ${options} -fPIE)
    target_link_libraries(${name} PRIVATE relevo_options fmt::fmt glm::glm GTest::gmock)
    target_precompile_headers(${name} PRIVATE ${relevo_precompiled_headers} <gmock/gmock.h> <gtest/gtest.h>)
endfunction()
if(RELEVO_TESTS)
    relevo_precompiled_for_tests(relevo_precompiled_tests "${relevo_test_options}")
    relevo_precompiled_for_tests(relevo_precompiled_references "${relevo_reference_options}")
endif()
