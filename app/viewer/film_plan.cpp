#include "viewer/film_plan.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

/// The message without the name of the job, which has no file.
std::string text_of(const Error& error) {
    const std::string what = error.what();
    constexpr std::string_view kJob = "job: film:";
    if (!what.starts_with(kJob)) return what;
    const std::size_t after_line = what.find(": ", kJob.size());
    return after_line == std::string::npos ? what : what.substr(after_line + 2);
}

void check_frames(double frames) {
    if (frames > kMostFilmFrames)
        bad_input(
            tr_format("film: expected at most {} frames but got {:.0f}; a shorter film, a higher "
                      "speed, or relevo film makes it",
                      kMostFilmFrames, frames));
}

}  // namespace

FilmPlan plan_film(const FilmWanted& wanted, session::SceneTimes& times) {
    FilmPlan plan;
    plan.of = wanted;
    const FilmWish& wish = wanted.wish;
    try {
        if (const std::string problem = film_problem(wish.choice, wish.views.size());
            !problem.empty())
            bad_input(problem);
        check_frames(wish.choice.duration_s * wish.choice.fps);
        plan.scene = film_scene(wish);
        plan.film = film_job(wish, times, plan.note);
        plan.job =
            scene::read_job_text(scene::film_job_text(plan.scene, plan.film, ""), "film", "");
        plan.job.output_may_leave = true;
        for (const scene::Axis& axis : plan.job.sweep)
            check_frames(static_cast<double>(axis.count().value_or(0)));
        plan.frames = scene::shots_of(
            plan.job, [&](const scene::Scene& scene) { return times.of(scene); }, kMostFilmFrames,
            [&](const scene::Scene& scene) { return times.motion_ground(scene); });
        for (const std::string& warning : plan.frames.warnings)
            plan.note += (plan.note.empty() ? "" : "\n") + warning;
    } catch (const Error& error) {
        plan.frames = {};
        plan.error = text_of(error);
    } catch (const std::exception& error) {
        plan.frames = {};
        plan.error = tr_format("film: {}; choose a shorter one", error.what());
    }
    return plan;
}

FilmWork::FilmWork(std::function<void()> on_change)
    : LatestWork(std::move(on_change),
                 [](const FilmWanted& of, const FilmWanted& now) { return of.dem == now.dem; }) {}

void FilmWork::work_out(const FilmWanted* wanted) {
    if (!wanted) {
        times_.reset();
        dem_.reset();
        return;
    }
    const std::string key = session::dem_key(wanted->wish.scene);
    if (!times_ || dem_ != wanted->dem || key != dem_key_) {
        times_ = std::make_unique<session::SceneTimes>();
        times_->use(wanted->wish.scene, wanted->dem);
        dem_ = wanted->dem;
        dem_key_ = key;
    }
    publish(std::make_shared<FilmPlan>(plan_film(*wanted, *times_)), /*done=*/true);
}

}  // namespace relevo::viewer
