#include "support/support.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include <fmt/format.h>

namespace relevo::test {

std::filesystem::path source_dir() {
    return RELEVO_SOURCE_DIR;
}

std::filesystem::path build_dir() {
    return RELEVO_BINARY_DIR;
}

std::optional<std::filesystem::path> test_data_dir() {
    if (const char* given = std::getenv("RELEVO_TEST_DATA"); given && *given) return given;
    const std::filesystem::path beside = source_dir().parent_path() / "shared";
    if (std::filesystem::is_directory(beside)) return beside;
    return std::nullopt;
}

std::filesystem::path scratch_dir(std::string_view name) {
    std::string test = "none";
    if (const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info())
        test = fmt::format("{}.{}", info->test_suite_name(), info->name());
    std::replace(test.begin(), test.end(), '/', '_');  // of parameterised tests
    const std::filesystem::path dir =
        build_dir() / "scratch" / program_invocation_short_name / test / name;
    std::filesystem::remove_all(dir);
    std::filesystem::create_directories(dir);
    return dir;
}

std::string error_of(const std::function<void()>& body) {
    try {
        body();
    } catch (const Error& error) {
        return fmt::format("exit {}: {}", error.exit_status(), error.what());
    }
    return "no error";
}

std::size_t Csv::column(std::string_view name) const {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) bad_input(fmt::format("read_csv: no column {}", name));
    return static_cast<std::size_t>(found - header.begin());
}

namespace {

std::vector<std::string> csv_fields(const std::string& line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (const char c : line) {
        if (c == '"') {
            quoted = !quoted;
        } else if (c == ',' && !quoted) {
            fields.emplace_back();
        } else if (c != '\r') {
            fields.back() += c;
        }
    }
    return fields;
}

}  // namespace

Csv read_csv(const std::filesystem::path& path) {
    std::ifstream file(path);
    if (!file) bad_input(fmt::format("read_csv: {}: cannot be read", path.string()));
    Csv csv;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        if (csv.header.empty())
            csv.header = csv_fields(line);
        else
            csv.rows.push_back(csv_fields(line));
    }
    return csv;
}

void print_accuracy(std::string_view title, std::vector<double> errors, std::string_view unit,
                    double limit) {
    if (errors.empty()) {
        fmt::print("[ accuracy ] {}: no rows\n", title);
        return;
    }
    std::sort(errors.begin(), errors.end());
    fmt::print("[ accuracy ] {}: n {}, median {:.4g}, worst {:.4g} {} (limit {:g})\n", title,
               errors.size(), errors[errors.size() / 2], errors.back(), unit, limit);
    std::fflush(stdout);
}

}  // namespace relevo::test
