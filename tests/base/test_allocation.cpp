#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "base/allocation.h"
#include "support/support.h"

namespace relevo::test {
namespace {

namespace fs = std::filesystem;

/// A computer of 8 processors and what its kernel says of control groups.
struct Machine {
    fs::path root = scratch_dir("machine");
    fs::path own = root / "own";

    void write(const std::string& name, const std::string& text) const {
        fs::create_directories((root / name).parent_path());
        std::ofstream(root / name) << text;
    }
    Allocation with(const std::map<std::string, std::string>& variables) const {
        return allocation_of(
            8,
            [&](const char* name) -> std::optional<std::string> {
                const auto found = variables.find(name);
                if (found == variables.end()) return std::nullopt;
                return found->second;
            },
            root, own);
    }
};

TEST(Allocation, ThreadsAreThoseOfTheSchedulerButNoMoreThanThereAre) {
    const Machine machine;
    EXPECT_EQ(machine.with({}).threads, 8);
    EXPECT_EQ(machine.with({}).threads_by, "");
    EXPECT_EQ(machine.with({{"SLURM_CPUS_PER_TASK", "3"}}).threads, 3);
    EXPECT_EQ(machine.with({{"SLURM_CPUS_PER_TASK", "3"}}).threads_by, "SLURM_CPUS_PER_TASK");
    EXPECT_EQ(machine.with({{"SLURM_CPUS_PER_TASK", "64"}}).threads, 8);
    EXPECT_EQ(machine.with({{"NSLOTS", "undefined"}}).threads, 8);
    EXPECT_EQ(machine.with({{"NCPUS", "2"}, {"RELEVO_THREADS", "5"}}).threads, 5);
    EXPECT_EQ(machine.with({{"LSB_DJOB_NUMPROC", "4"}}).threads, 4);
}

TEST(Allocation, MemoryIsTheLeastThatGroupsAndSlurmGrant) {
    const Machine machine;
    EXPECT_FALSE(machine.with({}).memory_bytes);
    // Version 2: of the group itself and of those around it. man 7 cgroups
    machine.write("own", "0::/job/step\n");
    machine.write("job/step/memory.max", "max\n");
    EXPECT_FALSE(machine.with({}).memory_bytes);
    machine.write("job/memory.max", "3000000000\n");
    EXPECT_EQ(machine.with({}).memory_bytes, 3000000000);
    EXPECT_EQ(machine.with({}).memory_by, "cgroup");
    EXPECT_EQ(machine.with({{"SLURM_MEM_PER_NODE", "2048"}}).memory_bytes,
              std::int64_t{2048} << 20);
    EXPECT_EQ(machine.with({{"SLURM_MEM_PER_NODE", "2048"}}).memory_by, "SLURM_MEM_PER_NODE");
    EXPECT_EQ(machine.with({{"SLURM_MEM_PER_NODE", "0"}}).memory_bytes, 3000000000);
    EXPECT_EQ(
        machine.with({{"SLURM_MEM_PER_CPU", "100"}, {"SLURM_CPUS_PER_TASK", "3"}}).memory_bytes,
        std::int64_t{300} << 20);
    // Version 1, beside other controllers; it has a huge number where there is no limit.
    machine.write("own", "5:cpu,cpuacct:/x\n4:memory:/box\n");
    machine.write("memory/box/memory.limit_in_bytes", "9223372036854771712\n");
    EXPECT_FALSE(machine.with({}).memory_bytes);
    machine.write("memory/box/memory.limit_in_bytes", "500000000\n");
    EXPECT_EQ(machine.with({}).memory_bytes, 500000000);
}

}  // namespace
}  // namespace relevo::test
