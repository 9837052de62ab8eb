#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cli/program.h"
#include "support/support.h"

namespace relevo::test {

inline std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The files below a folder, by their names there.
inline std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
    std::map<std::string, std::string> result;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file())
            result[entry.path().lexically_relative(folder).string()] = bytes_of(entry.path());
    return result;
}

/// Jobs of `relevo run` in a folder of the test's own.
class JobTest : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(dir_ / name) << text;
        return dir_ / name;
    }
    /// A job of the bundled DEM with small pictures and these members.
    std::filesystem::path job(const std::string& members,
                              const std::string& name = "job.json") const {
        return write(name, "{\"format\": 1, \"dem\": {\"files\": [\"" + bundled_dem() +
                               "\"]}, \"picture\": {\"size\": [64, 48]},\n" + members + "}");
    }
    /// The error that a run ends with.
    std::string error(const std::filesystem::path& path, std::vector<std::string> more = {},
                      int status = 3) const {
        more.insert(more.begin(), {"run", path.string()});
        const Result result = relevo(more);
        EXPECT_EQ(result.status, status) << result.err;
        EXPECT_EQ(result.out, "");
        const std::string begin = "relevo: error: ";
        const std::size_t at = result.err.rfind(begin);
        return at == std::string::npos
                   ? result.err
                   : result.err.substr(at + begin.size(),
                                       result.err.size() - at - begin.size() - 1);
    }

    std::filesystem::path dir_ = scratch_dir("run");
};

}  // namespace relevo::test
