#include "viewer/film_export.h"

#include <filesystem>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/files_in_use.h"
#include "base/log.h"
#include "base/text.h"
#include "session/batch.h"
#include "session/film_batch.h"
#include "session/scene_inputs.h"
#include "viewer/export.h"
#include "viewer/translation.h"

namespace relevo::viewer {
FilmExport::FilmExport(std::shared_ptr<const FilmPlan> plan, std::string device,
                       std::function<void()> on_change)
    : plan_(std::move(plan)),
      device_(std::move(device)),
      on_change_(std::move(on_change)),
      thread_([this] { run(); }) {}

FilmExport::~FilmExport() {
    if (!is_done_) log::warning(printable(file()) + ": cancelled, there is no film");
    cancel();
    thread_.join();
}

std::string FilmExport::result() const {
    if (failure_) std::rethrow_exception(failure_);
    return result_;
}

void FilmExport::run() {
    try {
        result_ = write();
    } catch (const Cancelled&) {
        result_ = tr_format("{}: cancelled, there is no film", printable(file()));
    } catch (const Error&) {
        failure_ = std::current_exception();
    } catch (const std::exception& error) {
        failure_ = std::make_exception_ptr(
            Error(ErrorCode::Failed,
                  tr_format("film: {}: {}; use a smaller size", printable(file()), error.what())));
    }
    is_done_ = true;
    on_change_();
}

std::string FilmExport::write() {
    session::SceneTimes times;
    times.use(plan_->of.wish.scene, plan_->of.dem);
    session::SceneInputs inputs(RELEVO_VERSION);
    FilesInUse files;
    for (const scene::JobFile& file : plan_->job.files)
        files.add_input(file.path, file.what);
    std::vector<scene::Shot> shots = plan_->frames.shots;
    session::settle(shots, times, inputs);
    for (const scene::Shot& shot : shots)
        inputs.add_to(files, shot.scene);
    session::FilmOptions options{.device = device_,
                                 .allow_blank = true,
                                 .settings = plan_->film.film,
                                 .comment = scene::job_record(plan_->job)};
    options.drawn = [this](std::size_t drawn) {
        drawn_ = drawn;
        on_change_();
        if (is_cancelled_) throw Cancelled();
    };
    if (is_cancelled_) throw Cancelled();
    const session::FilmReport report = session::draw_film(shots, options, times, files);
    std::string text =
        tr_format("{}: film saved in {}, {} frames, {:.3g} s", printable(file()), folder_of(file()),
                  frames(), static_cast<double>(frames()) / plan_->film.film.fps);
    if (report.blank > 0)
        text += tr_format_plural("; {} frame shows only sky, it is frame {}",
                                 "; {} frames show only sky, the first is frame {}", report.blank,
                                 report.first_blank);
    for (const std::string& note : report.stamp_notes)
        text += "; " + note;
    return text;
}

}  // namespace relevo::viewer
