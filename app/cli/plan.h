#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/files_in_use.h"
#include "cli/task_scripts.h"
#include "cli/verb.h"
#include "figure/raster_run.h"

/// `relevo plan COMMAND...`: what a command takes, and the tasks that do it.
namespace relevo::cli {

/// Options of the verbs of `plan`.
struct PlanArguments {
    bool on = false;
    std::string slurm, parallel;  ///< files
    int threads = 0;              ///< of a task; 0: those of this run
    int task_minutes = 10, most_tasks = 1000;

    static constexpr std::array<std::string_view, 5> kNames{"--slurm", "--parallel", "--cpus",
                                                            "--task-minutes", "--most-tasks"};
    /// Whether a verb is one of `plan`.
    static bool is_for(const Verb& verb);
    void add_to(Verb verb);
    /// Refuses before any work what a plan has no use for, and names of scripts that cannot be
    /// written: opens each, and drops it.
    /// @param shard  what --shard says
    /// @throws Error (Usage) for --shard, and as FilesInUse::open_alone()
    void check(const FilesInUse& files, const std::string& shard, bool overwrite) const;
    /// The names of the scripts that are asked for.
    std::vector<std::filesystem::path> scripts() const;
    /// The words of the command that is planned: of the verb, its options, "--" and the rest.
    std::vector<std::string> words(const Verb& verb) const;
};

/// A command that is to be done by many tasks.
struct PlannedWork {
    std::size_t left = 0;    ///< tiles or pictures
    double ready_s = 0;      ///< of each task, before its work proper
    double computing_s = 0;  ///< of all, on `threads`
    int threads = 1;
    double memory_mib = 0;
    std::vector<std::string> words, merge_words;
    std::size_t rasters = 0;  ///< that are merged: tiles times bands
    bool overwrite = false;   ///< scripts
};

/// Prints the tasks, and writes the scripts that are asked for.
/// @throws Error as OutputFile
void tell_tasks(const PlanArguments& arguments, const PlannedWork& work);

/// Prints tiles, halo, memory, processor hours and bytes of rasters in tiles, and tell_tasks().
/// @param posts  of the DEM
/// @param words  PlannedWork::words
void tell_raster_plan(const PlanArguments& arguments, const figure::RasterRun& run,
                      const figure::RasterRunOptions& options, const dem::Posts& posts,
                      std::vector<std::string> words);

}  // namespace relevo::cli
