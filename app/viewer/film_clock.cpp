#include "viewer/film_clock.h"

#include <algorithm>
#include <cmath>

namespace relevo::viewer {

void FilmClock::set_film(int frames, double fps) {
    frames = std::max(1, frames);
    if (frames != frames_) {
        const double last = std::max(1, frames_ - 1);
        at_ = std::round(frame() / last * (frames - 1));
    }
    frames_ = frames;
    fps_ = fps;
}

int FilmClock::frame() const {
    return std::clamp(static_cast<int>(at_), 0, frames_ - 1);
}

void FilmClock::go_to(int frame) {
    at_ = std::clamp(frame, 0, frames_ - 1);
}

void FilmClock::play() {
    if (frame() == frames_ - 1) at_ = 0;
    is_playing_ = true;
}

void FilmClock::advance(double passed_s) {
    if (!is_playing_) return;
    at_ += passed_s * fps_;
    if (at_ < frames_ - 1) return;
    at_ = frames_ - 1;
    is_playing_ = false;
}

}  // namespace relevo::viewer
