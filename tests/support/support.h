#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"

namespace relevo::test {

/// The root of the project's sources, and of the build that is under test.
std::filesystem::path source_dir();
std::filesystem::path build_dir();

/// Test data that is not part of the project: `$RELEVO_TEST_DATA`, else `../shared` beside the
/// sources where that exists. Empty: print what is skipped with SKIP_WITHOUT_TEST_DATA.
std::optional<std::filesystem::path> test_data_dir();

/// An empty folder for files of a test, cleared by the test's next run: "<build>/scratch/<program>/
/// <suite>.<case>/<name>", so that cases may run at once in processes of their own. What a static
/// holds belongs to the case that came first.
std::filesystem::path scratch_dir(std::string_view name = "files");

/// The whole message of the Error that `body` throws, "exit N: message"; "no error" if it throws
/// none.
std::string error_of(const std::function<void()>& body);

/// Rows of a CSV file with a header line; lines that begin with '#' are left out.
/// Quoted fields may contain commas. @throws Error if the file cannot be read.
struct Csv {
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;
    std::size_t column(std::string_view name) const;  ///< index of the named column; throws if none
};
Csv read_csv(const std::filesystem::path& path);

/// Prints median and worst of a set of absolute errors, the way every accuracy claim is printed:
/// `[ accuracy ] title: n 2500, median 0.05, worst 0.12 arcsec (limit 0.2)`.
void print_accuracy(std::string_view title, std::vector<double> errors, std::string_view unit,
                    double limit);

}  // namespace relevo::test

/// Skips the test, saying what was not run, where the outside test data is not there.
#define SKIP_WITHOUT_TEST_DATA(variable)                                              \
    const auto variable##_found = ::relevo::test::test_data_dir();                    \
    if (!variable##_found)                                                            \
        GTEST_SKIP() << "not run: needs the outside test data; set RELEVO_TEST_DATA"; \
    const std::filesystem::path variable = *variable##_found
