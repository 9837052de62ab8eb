#include "light/point/walk.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"

namespace relevo::light {

Walk::Walk(std::vector<geo::Geodetic> places) : places_(std::move(places)) {
    if (places_.size() < 2)
        bad_input(fmt::format("walk: {} point{}: too few, expected two or more", places_.size(),
                              places_.size() == 1 ? "" : "s"));
    distance_m_.push_back(0);
    for (std::size_t i = 1; i < places_.size(); ++i)
        distance_m_.push_back(distance_m_.back() +
                              geo::geodesic(places_[i - 1], places_[i]).distance_m);
}

void Walk::check_duration() const {
    if (duration_s() > kLongest_s)
        bad_input(fmt::format(
            "walk: {:.1f} km take {:.1f} days, expected at most {:.0f}; walk faster, or cut "
            "the track up",
            length_m() / 1000, duration_s() / 86400, kLongest_s / 86400));
}

Walk Walk::at_speed(std::vector<geo::Geodetic> places, sun::Instant start, double speed_m_s) {
    Walk walk(std::move(places));
    if (!(speed_m_s > 0) || std::isinf(speed_m_s))
        bad_input(fmt::format("walk: a speed of {:.10g} m/s, expected one above 0", speed_m_s));
    if (!(walk.length_m() > 0))
        bad_input("walk: all points are at the same place, expected a track with a length");
    if (!(walk.length_m() / speed_m_s <= 1e9))  // beyond it an instant may not hold it
        bad_input(fmt::format("walk: {:.1f} km at {:.3g} km/h take too long",
                              walk.length_m() / 1000, speed_m_s * 3.6));
    for (const double distance_m : walk.distance_m_)
        walk.utc_.push_back(start + distance_m / speed_m_s);
    walk.check_duration();
    return walk;
}

Walk Walk::timed(std::vector<geo::Geodetic> places, std::vector<sun::Instant> times) {
    Walk walk(std::move(places));
    walk.utc_ = std::move(times);
    for (std::size_t i = 1; i < walk.utc_.size(); ++i)
        if (walk.utc_[i] < walk.utc_[i - 1])
            bad_input(
                fmt::format("walk: point {}: its time, {}, is before that of the "
                            "point before, {}; expected times in order",
                            i + 1, sun::exact_iso(walk.utc_[i]), sun::exact_iso(walk.utc_[i - 1])));
    if (!(walk.duration_s() > 0))
        bad_input(
            fmt::format("walk: all points have the same time, {}, expected times that increase",
                        sun::exact_iso(walk.utc_.front())));
    walk.check_duration();
    return walk;
}

Walk Walk::starting_at(sun::Instant start) const {
    Walk walk = *this;
    for (std::size_t i = 0; i < walk.utc_.size(); ++i)
        walk.utc_[i] = start + (utc_[i] - utc_.front());
    return walk;
}

}  // namespace relevo::light
