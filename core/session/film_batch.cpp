#include "session/film_batch.h"

#include <exception>
#include <memory>
#include <mutex>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "session/shot_session.h"
#include "session/task_queue.h"

namespace relevo::session {
namespace {

/// A film to which frames are added on another thread.
class Encoding {
  public:
    explicit Encoding(film::Film& film) : film_(film) {}

    /// @throws what the encoder has thrown so far
    void add(image::Image8 frame) {
        rethrow();
        queue_.add([this, kept = std::make_shared<image::Image8>(std::move(frame))] {
            if (thrown()) return;
            try {
                film_.add(*kept);
            } catch (...) {
                const std::lock_guard lock(mutex_);
                thrown_ = std::current_exception();
            }
        });
    }

    /// Waits for all frames. @throws as add()
    void finish() {
        queue_.finish();
        rethrow();
    }

  private:
    std::exception_ptr thrown() {
        const std::lock_guard lock(mutex_);
        return thrown_;
    }
    void rethrow() {
        if (const std::exception_ptr thrown_by_encoder = thrown())
            std::rethrow_exception(thrown_by_encoder);
    }

    film::Film& film_;
    std::mutex mutex_;
    std::exception_ptr thrown_;
    TaskQueue queue_{1};  // last: its thread uses the others
};

/// Draws a shot. @returns the frame
image::Image8 draw(ShotSession& sessions, const scene::Shot& shot, bool& shows_ground,
                   std::vector<std::string>& stamp_notes) {
    Session& session = sessions.of(shot);
    session.show(shot.scene, shot.utc);
    image::Picture picture = session.make_picture();
    shows_ground = session.shows_ground();
    stamp_notes = session.stamp_notes();
    return std::get<image::Image8>(std::move(picture.pixels));
}

}  // namespace

FilmReport draw_film(const std::vector<scene::Shot>& shots, const FilmOptions& options,
                     SceneTimes& times, FilesInUse& files) {
    const scene::Shot& first = shots.front();
    film::Film film(files.open_alone(first.output, options.overwrite, "run"), first.scene.width_px,
                    first.scene.height_px, options.settings, options.comment);
    FilmReport report;
    {
        ShotSession sessions({.device = options.device, .format = PictureFormat{}}, times, files);
        Encoding encoding(film);
        std::size_t number = 0;
        for (const scene::Shot& shot : shots) {
            ++number;
            bool shows_ground = true;
            image::Image8 frame;
            try {
                std::vector<std::string> notes;
                frame = draw(sessions, shot, shows_ground, notes);
                if (number == 1) report.stamp_notes = std::move(notes);
            } catch (...) {
                if (!sessions.was_opened()) throw;
                failed(
                    fmt::format("{}: frame {} of {} ({}) cannot be drawn, so there is no film: {}",
                                printable(shot.output.string()), number, shots.size(),
                                sun::to_iso(shot.utc), reason_of(std::current_exception())));
            }
            if (!shows_ground && report.blank++ == 0) report.first_blank = number;
            encoding.add(std::move(frame));
            options.drawn(number);
        }
        encoding.finish();
    }
    if (report.blank == shots.size() && !options.allow_blank)
        failed(fmt::format("{}: the film shows only sky; turn the camera or add --allow-blank",
                           printable(first.output.string())));
    film.finish();
    return report;
}

}  // namespace relevo::session
