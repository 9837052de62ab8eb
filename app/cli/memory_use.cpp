#include "cli/memory_use.h"

#include <cstdlib>
#include <fstream>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/temporary_folder.h"

namespace relevo::cli {
namespace {

/// Runs this program without output. @returns whether it succeeded
bool run_self(std::vector<std::string> arguments) {
    std::vector<char*> words;
    for (std::string& argument : arguments)
        words.push_back(argument.data());
    words.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const int error =
        posix_spawn(&child, "/proc/self/exe", &actions, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    return error == 0 && waitpid(child, &status, 0) == child && status == 0;
}

}  // namespace

double peak_memory_mib() {
    // Not getrusage(), whose peak includes that of the process that has started this one.
    constexpr std::string_view kPeak = "VmHWM:";
    constexpr double kKibAMib = 1024;
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with(kPeak))
            return std::strtod(line.c_str() + kPeak.size(), nullptr) / kKibAMib;
    return 0;
}

std::optional<double> memory_floor_mib(const std::string& device) {
    const TemporaryFolder folder("relevo");
    if (folder.path().empty()) return std::nullopt;
    const auto file_in = [&](const char* name) { return (folder.path() / name).string(); };
    const std::string dem = file_in("dem.asc"), timings = file_in("timings.json");
    std::ofstream(dem)
        << "ncols 2\nnrows 2\nxllcorner 500000\nyllcorner 5200000\ncellsize 30\n0 1\n2 3\n";
    if (!run_self({"relevo", "-q", "capture", dem, "--crs", "EPSG:32632", "--device", device,
                   "--allow-blank", "--timings", timings, "-o", file_in("picture.png")}))
        return std::nullopt;
    std::ifstream file(timings);
    return nlohmann::json::parse(file).at("memory_mib").at("peak").get<double>();
}

}  // namespace relevo::cli
