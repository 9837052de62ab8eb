#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace relevo::test {

/// What the program did.
struct Result {
    int status = -1;
    std::string out;  ///< standard output
    std::string err;  ///< standard error
};

/// Runs a program.
/// @param environment  "NAME=value", besides what there is
Result run(const std::filesystem::path& program, const std::vector<std::string>& arguments,
           const std::vector<std::string>& environment = {});

/// Runs `relevo` of the build under test. Pictures are drawn on the software device, whatever GPU
/// is there, unless the arguments name another: a run on a machine without one fails and says so.
Result relevo(const std::vector<std::string>& arguments,
              const std::vector<std::string>& environment = {});

/// A run of `relevo`, and what it took.
struct Measured {
    Result run;
    int peak_mib = 0;  ///< of memory
    double processor_s = 0;
};
Measured measured(std::vector<std::string> arguments);

/// Expects that a run of `relevo` fails with a status and exactly this message, and says nothing
/// else.
void expect_failure(const std::vector<std::string>& arguments, int status,
                    const std::string& message);

/// An answer about one day: the keys of the only one of its `days` beside those of all days. Others
/// stay.
nlohmann::json of_one_day(const nlohmann::json& answer);

/// The DEM that comes along.
std::string bundled_dem();

}  // namespace relevo::test
