#include <chrono>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/output_file.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/job_run.h"
#include "film/film.h"
#include "session/film_batch.h"

namespace relevo::cli {
namespace {

namespace fs = std::filesystem;

/// A film on its way.
class FilmRun {
  public:
    FilmRun(const JobArguments& arguments, JobRun& work)
        : arguments_(arguments),
          work_(work),
          output_(work.shots.front().output),
          name_(printable(output_.string())),
          settings_(work.job.film.value_or(film::Settings())) {}

    void run() {
        refuse_options();
        check_frames();
        if (!work_.begin_file(output_, arguments_, "a film of " + length())) return;
        make_folder_of(output_, "run");
        draw();
    }

  private:
    /// Options of pictures that can be made one by one.
    void refuse_options() const {
        const auto refuse = [&](bool given, const char* option) {
            if (given)
                bad_usage(fmt::format(
                    "{}: {} is one film, made at once; -o frames/{{n:04}}.png makes its "
                    "frames as pictures",
                    option, name_));
        };
        refuse(arguments_.resume, "--resume");
        refuse(!arguments_.shard.empty(), "--shard");
        refuse(arguments_.sidecar, "--sidecar");
        refuse(arguments_.audit, "--audit");
        refuse(arguments_.format.bits.has_value(), "--bits");
        refuse(arguments_.format.quality.has_value(), "--quality");
        refuse(!arguments_.format.layers.empty(), "--layers");
    }

    void check_frames() const {
        const scene::Scene& first = work_.shots.front().scene;
        for (const scene::Shot& shot : work_.shots)
            if (shot.scene.width_px != first.width_px || shot.scene.height_px != first.height_px)
                bad_input(fmt::format(
                    "run: {}: a film has frames of one size but frame 1 has {}x{} and frame {} "
                    "{}x{}",
                    name_, first.width_px, first.height_px, shot.number, shot.scene.width_px,
                    shot.scene.height_px));
        for (const scene::Shot& shot : work_.shots)
            if (shot.scene.stamps.margin)
                bad_input(
                    fmt::format("run: {}: --margin: not of films, whose view would change its "
                                "size with the stamps",
                                name_));
        for (const scene::Shot& shot : work_.shots)
            if (shot.scene.transparent)
                bad_input(
                    fmt::format("run: {}: films have no transparency, remove transparent of "
                                "frame {}",
                                name_, shot.number));
        film::check(output_, first.width_px, first.height_px, settings_);
    }

    /// "300 frames, 10 s".
    std::string length() const {
        const double frames = static_cast<double>(work_.shots.size());
        return fmt::format("{} frame{}, {:.3g} s", work_.shots.size(), frames == 1 ? "" : "s",
                           frames / settings_.fps);
    }

    void draw() const {
        const auto began = std::chrono::steady_clock::now();
        session::FilmOptions options{.device = arguments_.device,
                                     .overwrite = arguments_.overwrite,
                                     .allow_blank = arguments_.allow_blank,
                                     .settings = settings_,
                                     .comment = scene::job_record(work_.job)};
        session::FilmReport report;
        {
            ProgressBar bar;
            options.drawn = [&](std::size_t done) { bar.show(done, work_.shots.size()); };
            report = session::draw_film(work_.shots, options, work_.times, work_.files);
        }
        const double took_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        work_.notices.release();
        std::error_code ignored;
        const auto bytes = static_cast<double>(fs::file_size(output_, ignored));
        log::info(fmt::format("{}: {}, {:.1f} MB, made in {}", name_, length(),
                              ignored ? 0.0 : bytes * 1e-6, duration_text(took_s)));
        for (const std::string& note : report.stamp_notes)
            log::info(fmt::format("{}: {}", name_, note));
        if (report.blank > 0)
            log::warning(fmt::format("{} of {} frames show only sky, the first is frame {}",
                                     report.blank, work_.shots.size(), report.first_blank));
    }

    const JobArguments& arguments_;
    JobRun& work_;
    fs::path output_;
    std::string name_;
    film::Settings settings_;
};

}  // namespace

void run_film(const JobArguments& arguments, JobRun& work) {
    FilmRun(arguments, work).run();
}

}  // namespace relevo::cli
