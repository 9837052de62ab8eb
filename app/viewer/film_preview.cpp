#include "viewer/film_preview.h"

#include <utility>

// The preview shows shots of the job that the film is made from. Rejected: camera and sun from
// formulas of the window, which would differ from the file; and a thread that draws frames ahead,
// which would queue them.
namespace relevo::viewer {
void FilmPreview::show(const scene::Shot& frame, const Pose& pose) {
    Document& document = state_.document;
    document.scene = frame.scene;
    document.pose = pose;
    // An overlay that is in no file is not in the film.
    document.overlay = {};
    if (frame.scene.overlay) document.overlay = choice_of(*frame.scene.overlay);
    state_.set_utc(frame.utc);
    document.utc = frame.utc;  // also beyond the years of the calendar
}

void FilmPreview::end() {
    if (!before_) return;
    state_.document = *std::exchange(before_, std::nullopt);
    state_.set_utc(state_.document.utc);
}

}  // namespace relevo::viewer
