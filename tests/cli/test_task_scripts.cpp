#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/parallel_for.h"
#include "base/text.h"
#include "cli/job_fixture.h"
#include "cli/program.h"
#include "cli/task_scripts.h"
#include "support/support.h"

namespace relevo::test::test_task_scripts {
namespace {

namespace fs = std::filesystem;

/// Writes a program in shell.
fs::path program(const fs::path& path, const std::string& text) {
    std::ofstream(path) << "#!/bin/sh\n" + text;
    fs::permissions(path, fs::perms::owner_all);
    return path;
}

/// Tasks whose program writes its folder and its words, each with a 0 behind it, into `said`.
/// Their names have all that shells take as something else.
struct OddTasks {
    fs::path where = scratch_dir("odd");
    fs::path folder = where / "a folder\nin two lines", said = where / "said";
    cli::TaskList list;

    OddTasks() {
        fs::create_directory(folder);
        list.program =
            program(where / "the program's $name",
                    fmt::format("printf '%s\\0' \"$PWD\" \"$@\" > '{}'\n", said.string()));
        list.folder = folder.string();
        list.command = {
            "sun", "--co=it's \"x\" $HOME `id` \\ ; & | * ?", "--", "two\nlines.tif", "-dash", "",
            "ü"};
        list.merge = {"merge", "--output=a b.vrt", "--", "-folder\n"};
        list.tasks = 3;
        list.threads = 2;
        list.memory_mib = 1000;
        list.task_s = 700;
    }

    /// What the program was called with.
    std::string expected(const std::vector<std::string>& words) const {
        std::string text = folder.string() + '\0';
        for (const std::string& word : words)
            text += word + '\0';
        return text;
    }
    std::vector<std::string> task_words(int task) const {
        return {"sun", list.command[1],  "--resume", "--shard", fmt::format("{}/3", task),
                "--",  "two\nlines.tif", "-dash",    "",        "ü"};
    }
};

TEST(TaskScripts, AWordIsThatWordToAShell) {
    EXPECT_EQ(cli::shell_word("r0001_c0002.tif"), "r0001_c0002.tif");
    EXPECT_EQ(cli::shell_word(""), "''");
    EXPECT_EQ(cli::shell_word("a b"), "'a b'");
    EXPECT_EQ(cli::shell_word("it's"), R"('it'\''s')");
    EXPECT_EQ(cli::shell_word("~"), "'~'");
}

TEST(TaskScripts, LinesForParallelSurviveAnyName) {
    const OddTasks odd;
    const std::string text = cli::parallel_lines(odd.list);
    const std::vector<std::string> lines = split(trimmed(text), '\n');
    ASSERT_EQ(lines.size(), 3u) << text;
    for (int task = 1; task <= 3; ++task) {
        const Result run = test::run("/bin/sh", {"-c", lines[static_cast<std::size_t>(task) - 1]});
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(read_text(odd.said, "test"), odd.expected(odd.task_words(task)));
    }
    EXPECT_NE(lines[0].find("RELEVO_THREADS=2 "), std::string::npos) << lines[0];
}

TEST(TaskScripts, TheScriptForSlurmSubmitsTasksAndTheirMerge) {
    const OddTasks odd;
    const fs::path script = odd.where / "submit.sh";
    std::ofstream(script) << cli::slurm_script(odd.list);
    // A stand-in keeps what it is given: options in one file, the job in another.
    const fs::path bin = odd.where / "bin";
    fs::create_directory(bin);
    program(bin / "sbatch",
            fmt::format("cd '{0}' && n=$(ls | grep -c '^job' || true) && cat > job$n && "
                        "printf '%s\\n' \"$@\" > options$n && echo \"4$n;cluster\"\n",
                        odd.where.string()));
    const Result run = test::run("/bin/sh", {script.string(), "--partition=a b"},
                                 {"PATH=" + bin.string() + ":/usr/bin:/bin"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.out, "tasks 40 merge 41\n");
    EXPECT_EQ(read_text(odd.where / "options0", "test"), "--parsable\n--partition=a b\n");
    EXPECT_EQ(read_text(odd.where / "options1", "test"),
              "--parsable\n--partition=a b\n--dependency=afterok:40\n--kill-on-invalid-dep=yes\n");
    const std::string job = read_text(odd.where / "job0", "test");
    for (const char* line : {"#SBATCH --array=1-3\n", "#SBATCH --cpus-per-task=2\n",
                             "#SBATCH --mem=1250M\n", "#SBATCH --time=35\n"})
        EXPECT_NE(job.find(line), std::string::npos) << line << job;
    EXPECT_EQ(
        test::run("/bin/sh", {(odd.where / "job0").string()}, {"SLURM_ARRAY_TASK_ID=2"}).status, 0);
    EXPECT_EQ(read_text(odd.said, "test"), odd.expected(odd.task_words(2)));
    EXPECT_EQ(test::run("/bin/sh", {(odd.where / "job1").string()}).status, 0);
    EXPECT_EQ(read_text(odd.said, "test"), odd.expected(odd.list.merge));
}

TEST(TaskScripts, AFailedTaskIsRequeuedTwice) {
    OddTasks odd;
    odd.list.program = program(odd.where / "fails", "exit 3\n");
    program(odd.where / "scontrol",
            fmt::format("printf '%s ' \"$@\" >> '{}'\n", odd.said.string()));
    program(odd.where / "sleep", "");
    const std::string text = cli::slurm_script(odd.list);
    const std::size_t begin = text.find("'RELEVO_TASK'\n") + 14, end = text.find("\nRELEVO_TASK\n");
    const fs::path job = odd.where / "job";
    std::ofstream(job) << text.substr(begin, end - begin);
    for (const char* restarts : {"0", "1", "2"})
        EXPECT_EQ(
            test::run("/bin/sh", {job.string()},
                      {"PATH=" + odd.where.string() + ":/usr/bin:/bin", "SLURM_ARRAY_JOB_ID=7",
                       "SLURM_ARRAY_TASK_ID=2", std::string("SLURM_RESTART_COUNT=") + restarts})
                .status,
            3);
    EXPECT_EQ(read_text(odd.said, "test"), "requeue 7_2 requeue 7_2 ");
}

/// A plan of tiles of the bundled DEM.
Result planned(const fs::path& where, const std::vector<std::string>& more) {
    std::vector<std::string> words{
        "plan",  "sun",     "shadow", bundled_dem(), "--sun",
        "123,8", "--tiles", "101",    "-o",          (where / "out").string()};
    words.insert(words.end(), more.begin(), more.end());
    return relevo(words);
}

TEST(Plan, SaysWhatATaskTakesAndWritesWhatDoesIt) {
    const fs::path where = scratch_dir("plan it's");
    const fs::path lines = where / "tasks.txt", slurm = where / "submit.sh";
    const Result plan =
        planned(where, {"--parallel", lines.string(), "--slurm", slurm.string(), "--cpus", "1"});
    ASSERT_EQ(plan.status, 0) << plan.err;
    for (const char* text :
         {"tiles               16 of 101 x 101 posts, 0 there already\n", "\nhalo ", "\nmemory ",
          "\ncomputing ", "\nreading ", "\nwriting ", "\ntasks               "})
        EXPECT_NE(plan.out.find(text), std::string::npos) << text << plan.out;
    EXPECT_TRUE(fs::exists(where / "out/plan.json"));
    EXPECT_FALSE(fs::exists(where / "out/r0001_c0001.tif"));
    // The line does what was planned, and the folder knows its plan.
    const Result task = test::run("/bin/sh", {"-c", read_text(lines, "test")});
    ASSERT_EQ(task.status, 0) << task.err;
    EXPECT_EQ(relevo({"-q", "merge", (where / "out").string()}).status, 0);
    const Result again = planned(where, {});
    EXPECT_NE(again.out.find("16 there already"), std::string::npos) << again.out;
    EXPECT_NE(again.out.find("tasks               none, all is there\n"), std::string::npos)
        << again.out;
    EXPECT_EQ(planned(where, {"--parallel", lines.string(), "--overwrite"}).status, 0);
    EXPECT_NE(planned(where, {"--parallel", lines.string()}).err.find("exists"), std::string::npos);
    EXPECT_EQ(relevo({"plan", "sun", "shadow", bundled_dem(), "--sun", "123,8", "-o", "x"}).err,
              "relevo: error: plan: needs --tiles\n");
}

TEST(Plan, GivesAWorkstationAsManyTasksAsItHasProcessors) {
    const fs::path where = scratch_dir("plan of a workstation");
    const auto tasks = [&](int processors, const std::vector<std::string>& more) {
        std::vector<std::string> words{
            "plan",  "sun",     "shadow", bundled_dem(), "--sun",
            "123,8", "--tiles", "101",    "-o",          (where / "out").string()};
        words.insert(words.end(), more.begin(), more.end());
        const Result plan = relevo(words, {fmt::format("RELEVO_THREADS={}", processors)});
        EXPECT_EQ(plan.status, 0) << plan.err;
        return plan.out;
    };
    const std::string lines = (where / "tasks.txt").string();
    const int processors = thread_count();
    // Seconds of work in all: less than one task's minutes.
    const std::string all = tasks(processors, {"--parallel", lines});
    EXPECT_NE(all.find(fmt::format("\ntasks               {}, ", processors)), std::string::npos)
        << all;
    EXPECT_NE(all.find(" each on 1 threads\n"), std::string::npos) << all;
    EXPECT_NE(all.find(fmt::format("\nparallel -j {} < ", processors)), std::string::npos) << all;
    const std::string text = read_text(lines, "test");
    EXPECT_EQ(std::ranges::count(text, '\n'), processors);
    EXPECT_NE(text.find("RELEVO_THREADS=1 "), std::string::npos) << text;
    // A task that takes all processors is alone, and so is one of a cluster.
    const std::string wide = tasks(
        processors, {"--parallel", lines, "--overwrite", "--cpus", std::to_string(processors)});
    EXPECT_NE(wide.find("\ntasks               1, "), std::string::npos) << wide;
    EXPECT_NE(tasks(processors, {}).find("\ntasks               1, "), std::string::npos);
}

class PlanOfAJob : public JobTest {};

TEST_F(PlanOfAJob, TasksMakeThePicturesAndTheMergeNamesMissingOnes) {
    const std::string path =
        job("\"effects\": {\"only\": []},\n\"time\": {\"at\": \"0:00\", \"date\": "
            "\"2026-06-21\"},\n\"sweep\": [{\"times\": {\"from\": \"8:00\", \"to\": \"19:00\", "
            "\"step\": \"5h30min\"}}],\n\"output\": \"out/{time:%H%M}.png\"")
            .string();
    const fs::path lines = dir_ / "tasks.txt";
    const Result plan = relevo({"plan", "run", path, "--parallel", lines.string()});
    ASSERT_EQ(plan.status, 0) << plan.err;
    EXPECT_NE(plan.out.find("pictures            3, 0 there already\n"), std::string::npos)
        << plan.out;
    EXPECT_FALSE(fs::exists(dir_ / "out/0800.png"));
    const Result missing = relevo({"run", path, "--missing"});
    EXPECT_EQ(missing.status, 1);
    const std::string out = (dir_ / "out").string();
    EXPECT_EQ(missing.out, fmt::format("{0}/0800.png\n{0}/1330.png\n{0}/1900.png\n", out));
    const Result task = test::run("/bin/sh", {"-c", read_text(lines, "test")});
    ASSERT_EQ(task.status, 0) << task.err;
    EXPECT_EQ(relevo({"run", path, "--missing"}).status, 0);
    fs::resize_file(dir_ / "out/1330.png", 100);
    const Result cut = relevo({"run", path, "--missing", "-q"});
    EXPECT_EQ(cut.status, 1);
    EXPECT_EQ(cut.err,
              fmt::format("relevo: error: run: 1 of 3 pictures are missing or not whole, the "
                          "first is {}/1330.png; make them with --resume\n",
                          printable(out)));
}

}  // namespace
}  // namespace relevo::test::test_task_scripts
