#include "base/allocation.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <thread>

#include <sched.h>

namespace relevo {
namespace {

/// A whole number from 1 that fills the text, but for a line end.
std::optional<std::int64_t> positive(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' '))
        text.pop_back();
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || number < 1) return std::nullopt;
    return number;
}

/// The number in a file of one line; nothing for "max", and where there is no such file.
std::optional<std::int64_t> limit_in(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::string line;
    if (!std::getline(file, line)) return std::nullopt;
    const auto bytes = positive(line);
    // Version 1 has a number of this size where there is no limit.
    return bytes && *bytes < std::int64_t{1} << 60 ? bytes : std::nullopt;
}

/// The least limit of a control group and of those around it.
std::optional<std::int64_t> limit_of_groups(const std::filesystem::path& mount,
                                            std::filesystem::path group, const char* file) {
    std::optional<std::int64_t> least;
    for (group = group.relative_path();; group = group.parent_path()) {
        if (const auto limit = limit_in(mount / group / file))
            least = std::min(*limit, least.value_or(*limit));
        if (group.empty()) return least;
    }
}

/// Control groups, versions 1 and 2. Source: man 7 cgroups, "/proc/pid/cgroup".
std::optional<std::int64_t> limit_of_cgroups(const std::filesystem::path& mount,
                                             const std::filesystem::path& own) {
    std::optional<std::int64_t> least;
    std::ifstream file(own);
    for (std::string line; std::getline(file, line);) {
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const std::string group = line.substr(second + 1);
        std::optional<std::int64_t> limit;
        if (controllers.empty())
            limit = limit_of_groups(mount, group, "memory.max");
        else if (("," + controllers + ",").find(",memory,") != std::string::npos)
            limit = limit_of_groups(mount / "memory", group, "memory.limit_in_bytes");
        if (limit) least = std::min(*limit, least.value_or(*limit));
    }
    return least;
}

/// What Slurm grants a task on its node, which not every Slurm enforces.
std::optional<std::int64_t> limit_of_slurm(const Environment& environment, std::string& by) {
    constexpr std::int64_t kMiB = 1 << 20;
    const auto number = [&](const char* name) -> std::optional<std::int64_t> {
        const auto text = environment(name);
        return text ? positive(*text) : std::nullopt;
    };
    by = "SLURM_MEM_PER_NODE";
    if (const auto mib = number("SLURM_MEM_PER_NODE")) return *mib * kMiB;
    by = "SLURM_MEM_PER_CPU";
    const auto mib = number("SLURM_MEM_PER_CPU");
    const auto processors = number("SLURM_CPUS_PER_TASK");
    if (mib) return *mib * processors.value_or(1) * kMiB;
    return std::nullopt;
}

/// The processors that this process may run on.
int usable_processors() {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace

std::optional<std::string> environment_variable(const char* name) {
    const char* const value = std::getenv(name);
    return value ? std::optional<std::string>(value) : std::nullopt;
}

Allocation allocation_of(int processors, const Environment& environment,
                         const std::filesystem::path& cgroups, const std::filesystem::path& own) {
    constexpr std::array kThreads{"RELEVO_THREADS", "SLURM_CPUS_PER_TASK", "NCPUS",
                                  "LSB_DJOB_NUMPROC", "NSLOTS"};
    Allocation found{.threads = std::max(1, processors),
                     .threads_by = {},
                     .memory_bytes = limit_of_cgroups(cgroups, own),
                     .memory_by = "cgroup"};
    for (const char* const name : kThreads) {
        const auto text = environment(name);
        const auto number = text ? positive(*text) : std::nullopt;
        if (!number) continue;
        if (*number < found.threads) {
            found.threads = static_cast<int>(*number);
            found.threads_by = name;
        }
        break;
    }
    std::string by;
    const auto granted = limit_of_slurm(environment, by);
    if (granted && *granted < found.memory_bytes.value_or(*granted + 1)) {
        found.memory_bytes = granted;
        found.memory_by = by;
    }
    if (!found.memory_bytes) found.memory_by.clear();
    return found;
}

const Allocation& allocation() {
    static const Allocation found = allocation_of(usable_processors(), environment_variable);
    return found;
}

}  // namespace relevo
