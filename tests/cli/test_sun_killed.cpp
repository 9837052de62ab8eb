#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

#include "base/text.h"
#include "cli/program.h"
#include "support/support.h"

namespace relevo::test::test_sun_killed {
namespace {

std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.push_back(entry.path().filename());
    return names;
}

/// Of a process, in seconds; it may have ended without being waited for.
double processor_s(pid_t process) {
    std::ifstream file("/proc/" + std::to_string(process) + "/stat");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    std::istringstream fields(text.substr(text.rfind(')') + 2));
    std::string skipped;
    for (int field = 3; field < 14; ++field)
        fields >> skipped;
    double user = 0, system = 0;  // proc(5): fields 14 and 15
    fields >> user >> system;
    return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

/// Starts `relevo` and kills it once it has used so much of the processor: on a busy machine wall
/// time says nothing of how far it is.
/// @return whether it was killed before it had ended
bool killed_after(const std::vector<std::string>& arguments, double after_s) {
    const pid_t child = fork();
    if (child == 0) {
        std::vector<char*> words{const_cast<char*>("relevo")};
        for (const std::string& word : arguments)
            words.push_back(const_cast<char*>(word.c_str()));
        words.push_back(nullptr);
        execv((build_dir() / "bin/relevo").c_str(), words.data());
        _exit(127);
    }
    siginfo_t ended{};
    while (processor_s(child) < after_s &&
           waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           ended.si_pid == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0);
    return WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
}

TEST(SunHours, KilledAtAnyMomentAreWholeOrNotThere) {
    const std::filesystem::path where = scratch_dir("sun_hours_killed");
    const std::string output = (where / "day.tif").string();
    const std::vector<std::string> verb{"-q",         "sun",  "hours", bundled_dem(), "--date",
                                        "2026-03-20", "--tz", "UTC",   "-o",          output};
    const Measured reference = measured(verb);
    ASSERT_EQ(reference.run.status, 0) << reference.run.err;
    const std::string whole = read_text(output, "test");
    std::filesystem::remove(output);
    std::mt19937 lot(7);
    int killed = 0;
    for (int i = 0; i < 8; ++i) {
        // The first one in the middle of the work, others once it writes, or is about to end.
        const double share = i == 0 ? 0.3 : 0.3 + 0.7 * std::uniform_real_distribution<>()(lot);
        killed += killed_after(verb, reference.processor_s * share);
        for (const std::string& name : names_in(where)) {
            EXPECT_EQ(name, "day.tif");
            EXPECT_TRUE(read_text(output, "test") == whole);
        }
        std::filesystem::remove(output);
    }
    EXPECT_GT(killed, 0);
    ASSERT_EQ(relevo(verb).status, 0);
    EXPECT_EQ(names_in(where), std::vector<std::string>{"day.tif"});
    EXPECT_TRUE(read_text(output, "test") == whole);
}

}  // namespace
}  // namespace relevo::test::test_sun_killed
