#include "cli/job_run.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/output_file.h"
#include "base/progress.h"
#include "base/text.h"
#include "image/image.h"
#include "scene/panorama.h"
#include "scene/sheet.h"
#include "scene/stereo.h"
#include "session/batch.h"
#include "session/trust.h"

namespace relevo::cli {
namespace {

/// More pictures than anybody means without saying so.
constexpr std::size_t kMostUnasked = 100'000;
constexpr std::size_t kMost = 1'000'000'000;

/// Warns of skipped pictures in one line.
void warn_of_skipped(const std::vector<std::string>& reasons) {
    if (reasons.size() == 1) log::warning("1 picture is skipped: " + reasons.front());
    if (reasons.size() > 1)
        log::warning(
            fmt::format("{} pictures are skipped; the first: {}", reasons.size(), reasons.front()));
}

}  // namespace

void JobRun::hash(const scene::Scene& scene) {
    try {
        inputs.record(scene);
    } catch (const Error&) {
        // What settles the scene says what is wrong with it.
    }
}

void JobRun::read_job(const JobArguments& arguments) {
    if (arguments.text) {
        job = scene::read_job_text(arguments.text->text, "film", arguments.text->folder);
        job.output_may_leave = true;
        return;
    }
    job = scene::read_job(arguments.job,
                          [&](scene::Scene& scene) { arguments.scene.apply_to(scene); });
    if (!arguments.output.empty()) {
        job.output = arguments.output;
        job.output_given = false;
        job.folder.clear();
    }
    job.output_may_leave = arguments.scene.trust;
    files.add_input(arguments.job, "the job");
}

void JobRun::fit(scene::Shot& shot) {
    scene::Scene& scene = shot.scene;
    const bool linear =
        image::is_picture_name(shot.output) && image::holds_linear_light(shot.output);
    if (linear) scene.stamps.margin = false;  // without stamps
    times.fit_map(scene);
    // Most films have even sides; the pixels of a map need not be quite square.
    if (!scene.ortho || !job.is_film()) return;
    scene.width_px = std::max(scene.width_px / 2 * 2, 2);
    scene.height_px = std::max(scene.height_px / 2 * 2, 2);
}

void JobRun::read(const JobArguments& arguments) {
    if (!arguments.dry_run) times.before_reading([this](const auto& scene) { hash(scene); });
    read_job(arguments);
    session::Trust trusted(arguments.scene.named(), "job: " + printable(job.file),
                           session::NamedBy::File);
    for (const scene::JobFile& file : job.files)
        files.add_input(file.path, file.what);
    scene::Shots drawn_up = scene::shots_of(
        job,
        [&](const scene::Scene& scene) {
            trusted.check_names(scene);  // before its DEM is opened
            return times.of(scene);
        },
        arguments.yes ? kMost : kMostUnasked,
        [&](const scene::Scene& scene) {
            trusted.check_names(scene);
            return times.motion_ground(scene);
        });
    for (scene::Shot& shot : drawn_up.shots) {
        trusted.keep_folders(shot.scene.effects);
        scene::check_panorama(shot.scene);
        scene::check_stereo(shot.scene);
        scene::check_sheet(shot.scene, shot.output);
        fit(shot);
    }
    trusted.tell();
    warn_of_skipped(drawn_up.left_out);
    for (const std::string& warning : drawn_up.warnings)
        log::warning(warning);
    shots = std::move(drawn_up.shots);
}

bool JobRun::begin_file(const std::filesystem::path& output, const JobArguments& arguments,
                        const std::string& what) {
    session::settle(shots, times, inputs);
    for (const scene::Shot& shot : shots)
        inputs.add_to(files, shot.scene);
    files.check_planned({output}, "run");
    const bool taken = !arguments.overwrite && is_taken(output);
    const std::string refusal =
        fmt::format("run: {}: exists; pass --overwrite to replace it", printable(output.string()));
    if (!arguments.dry_run) {
        if (taken) bad_input(refusal);
        return true;
    }
    fmt::print("{}\n", output.string());
    std::string time;
    try {
        time = "some " +
               duration_text(session::time_batch(shots, {.device = arguments.device}, times));
    } catch (const Error& error) {
        time = fmt::format("an unknown time ({})", error.what());
    }
    notices.release();
    log::info(fmt::format("{} would take {}", what, time));
    if (taken) log::warning("would be refused: " + refusal);
    return false;
}

}  // namespace relevo::cli
