#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// A command's tasks as text for Slurm and for GNU parallel.
namespace relevo::cli {

inline constexpr double kTaskMemoryMargin = 1.25;  ///< of a task's memory over its estimate

/// Many processes of one command, and what is done once all have succeeded.
struct TaskList {
    std::string program;               ///< an absolute path
    std::string folder;                ///< in which relative names count
    std::vector<std::string> command;  ///< arguments, without --shard
    std::vector<std::string> merge;    ///< arguments
    std::size_t tasks = 1;
    int threads = 1;  ///< of a task
    double memory_mib = 0;
    double task_s = 0;        ///< of a task
    std::size_t rasters = 0;  ///< tiles that are merged, times their bands
};

/// A word as a POSIX shell reads it, whatever is in it. A line break is ${nl}, so that the word
/// stays on one line; kLineBreak sets that.
std::string shell_word(const std::string& word);
inline constexpr const char* kLineBreak = R"(nl=$(printf '\n.') && nl=${nl%.} && )";

/// Arguments of `program` as a line of a shell.
std::string shell_line(const std::string& program, const std::vector<std::string>& arguments);

/// A shell script that submits an array of tasks, and a job that merges once all have succeeded.
/// Its own arguments go to sbatch: `sh FILE --partition=long`. A task that fails is tried three
/// times. One whose node fails is requeued. Each time the tiles that are there are kept.
std::string slurm_script(const TaskList& tasks);

/// A task a line: `parallel < FILE`.
std::string parallel_lines(const TaskList& tasks);

}  // namespace relevo::cli
