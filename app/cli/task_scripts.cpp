#include "cli/task_scripts.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace relevo::cli {
namespace {

constexpr double kTimeMargin = 3;
constexpr int kLeastMinutes = 10, kTries = 3;

bool is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-./=:,+@%").find(c) != std::string_view::npos;
}

bool has_line_break(const TaskList& tasks) {
    const auto has = [](const std::string& text) { return text.find('\n') != text.npos; };
    return has(tasks.program) || has(tasks.folder) || std::ranges::any_of(tasks.command, has) ||
           std::ranges::any_of(tasks.merge, has);
}

std::vector<std::string> with_shard(const TaskList& tasks) {
    std::vector<std::string> words = tasks.command;
    // Before "--", after which all words are names.
    words.insert(std::ranges::find(words, "--"), "--resume");
    return words;
}

/// Goes to where names count from.
std::string go_there(const TaskList& tasks) {
    return (has_line_break(tasks) ? kLineBreak : "") + ("cd " + shell_word(tasks.folder));
}

int minutes_of(const TaskList& tasks) {
    return std::max(kLeastMinutes, static_cast<int>(std::ceil(kTimeMargin * tasks.task_s / 60)));
}

int memory_of(const TaskList& tasks) {
    return static_cast<int>(std::ceil(kTaskMemoryMargin * tasks.memory_mib));
}

}  // namespace

std::string shell_word(const std::string& word) {
    if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
    std::string quoted = "'";
    for (const char c : word) {
        if (c == '\'')
            quoted += R"('\'')";
        else if (c == '\n')
            quoted += R"('"${nl}"')";
        else
            quoted += c;
    }
    return quoted + "'";
}

std::string shell_line(const std::string& program, const std::vector<std::string>& arguments) {
    std::string line = shell_word(program);
    for (const std::string& argument : arguments)
        line += " " + shell_word(argument);
    return line;
}

std::string slurm_script(const TaskList& tasks) {
    std::vector<std::string> words = with_shard(tasks);
    const auto names = std::ranges::find(words, "--");
    const std::string before = shell_line(tasks.program, {words.begin(), names});
    const std::string after = names == words.end()
                                  ? std::string()
                                  : " " + shell_line("--", {std::next(names), words.end()});
    std::string text = fmt::format(
        "#!/bin/sh\n"
        "# Written by relevo plan. Submits {0} tasks, and a job that merges what they made:\n"
        "#   sh THIS_FILE [options of sbatch]\n"
        "# After a failure remove its cause and run this script again: tiles that are there are "
        "kept.\n"
        "set -eu\n"
        "tasks=$(sbatch --parsable \"$@\" <<'RELEVO_TASK'\n"
        "#!/bin/sh\n"
        "#SBATCH --job-name=relevo\n"
        "#SBATCH --array=1-{0}\n"
        "#SBATCH --cpus-per-task={1}\n"
        "#SBATCH --mem={2}M\n"
        "#SBATCH --time={3}\n"
        "#SBATCH --requeue\n"
        "#SBATCH --open-mode=append\n",
        tasks.tasks, tasks.threads, memory_of(tasks), minutes_of(tasks));
    text += go_there(tasks) + " || exit 1\n" + before +
            fmt::format(" --shard \"$SLURM_ARRAY_TASK_ID/{}\"", tasks.tasks) + after + "\n";
    text += fmt::format(
        "status=$?\n"
        "# Tried {} times; a wrong command line (status 2) only once.\n"
        "if [ $status -ne 0 ] && [ $status -ne 2 ] && [ \"${{SLURM_RESTART_COUNT:-0}}\" -lt {} ]\n"
        "then scontrol requeue \"${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID\" && sleep 60\n"
        "fi\n"
        "exit $status\n"
        "RELEVO_TASK\n"
        ")\n"
        "tasks=${{tasks%%;*}}\n",
        kTries, kTries - 1);
    text += fmt::format(
        "merge=$(sbatch --parsable \"$@\" \"--dependency=afterok:$tasks\" "
        "--kill-on-invalid-dep=yes "
        "<<'RELEVO_MERGE'\n"
        "#!/bin/sh\n"
        "#SBATCH --job-name=relevo-merge\n"
        "#SBATCH --cpus-per-task=1\n"
        "#SBATCH --mem={}M\n"
        "#SBATCH --time={}\n"
        "{} || exit 1\n"
        "exec {}\n"
        "RELEVO_MERGE\n"
        ")\n"
        "echo \"tasks $tasks merge ${{merge%%;*}}\"\n",
        1024 + tasks.rasters / 10, 60 + tasks.rasters / 1000, go_there(tasks),
        shell_line(tasks.program, tasks.merge));
    return text;
}

std::string parallel_lines(const TaskList& tasks) {
    std::vector<std::string> words = with_shard(tasks);
    const auto at = std::ranges::find(words, "--") - words.begin();
    words.insert(words.begin() + at, {"--shard", ""});
    std::string text;
    for (std::size_t task = 1; task <= tasks.tasks; ++task) {
        words[static_cast<std::size_t>(at) + 1] = fmt::format("{}/{}", task, tasks.tasks);
        text += fmt::format("{} && RELEVO_THREADS={} {}\n", go_there(tasks), tasks.threads,
                            shell_line(tasks.program, words));
    }
    return text;
}

}  // namespace relevo::cli
