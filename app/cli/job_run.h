#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/files_in_use.h"
#include "base/held_notices.h"
#include "cli/format_arguments.h"
#include "cli/plan.h"
#include "cli/scene_arguments.h"
#include "scene/job.h"
#include "session/scene_inputs.h"
#include "session/scene_times.h"

namespace relevo::cli {

/// A job that no file holds: that of `relevo film`.
struct JobText {
    std::string text;
    std::filesystem::path folder;  ///< from which its paths count
};

/// What the command line says of a job.
struct JobArguments {
    SceneArguments scene;
    FormatArguments format;         ///< of pictures
    std::string job;                ///< its file
    std::optional<JobText> text{};  ///< instead of a file
    std::string output, device = "auto", shard, contact_sheet;
    int columns = 0;  ///< of the contact sheet; 0: chosen
    bool overwrite = false, resume = false, dry_run = false, yes = false, sidecar = false;
    bool audit = false, allow_blank = false, missing = false;
    PlanArguments plan{};  ///< of `relevo plan run`
    std::optional<Verb> verb{};
};

/// A job on its way: its pictures, and what they are made from.
struct JobRun {
    log::HeldNotices notices;
    FilesInUse files;
    session::SceneTimes times;
    session::SceneInputs inputs{RELEVO_VERSION};
    scene::Job job;
    std::vector<scene::Shot> shots;

    /// Reads the job and draws up its pictures.
    /// @throws Error as scene::read_job() and scene::shots_of()
    void read(const JobArguments& arguments);
    /// Settles a job whose result is one file, and reports on it for --dry-run.
    /// @param what  "a film of 30 frames"
    /// @returns false for --dry-run: nothing is to be drawn
    /// @throws Error (BadInput) if a file has its name, and as FilesInUse::check_planned
    bool begin_file(const std::filesystem::path& output, const JobArguments& arguments,
                    const std::string& what);

  private:
    /// Hashes the files of a scene, so that changes after they were read are noticed.
    void hash(const scene::Scene& scene);
    void read_job(const JobArguments& arguments);
    /// Gives a map its size, as its file allows.
    void fit(scene::Shot& shot);
};

/// Checks, draws and encodes the film of a job.
void run_film(const JobArguments& arguments, JobRun& work);

/// Draws the pictures of a job into one file.
void run_contact_sheet(const JobArguments& arguments, JobRun& work);

/// Reads a job and makes its pictures or its film.
void run_job(const JobArguments& arguments);

}  // namespace relevo::cli
