#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace relevo {

/// A variable of the environment; nothing where it is not set.
using Environment = std::function<std::optional<std::string>(const char* name)>;
/// That of this process.
std::optional<std::string> environment_variable(const char* name);

/// The processors and the memory that a scheduler or a container gives a process.
struct Allocation {
    int threads = 1;
    std::string threads_by;  ///< "SLURM_CPUS_PER_TASK"; empty: the processors it may run on
    std::optional<std::int64_t> memory_bytes;
    std::string memory_by;  ///< "SLURM_MEM_PER_NODE", "cgroup"
};

/// Threads: the first of RELEVO_THREADS, SLURM_CPUS_PER_TASK, NCPUS (PBS), LSB_DJOB_NUMPROC (LSF)
/// and NSLOTS (Grid Engine) that is a number from 1, but no more than `processors`. Memory: the
/// least of the limits of the process's control groups and of what Slurm grants.
/// @param processors  that the process may run on
/// @param cgroups     where control groups are mounted: /sys/fs/cgroup
/// @param own         which of them are the process's: /proc/self/cgroup
Allocation allocation_of(int processors, const Environment& environment,
                         const std::filesystem::path& cgroups = "/sys/fs/cgroup",
                         const std::filesystem::path& own = "/proc/self/cgroup");

/// That of this process, found once.
const Allocation& allocation();

}  // namespace relevo
