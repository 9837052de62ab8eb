#include "sun/sky_path.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "base/golden_section.h"
#include "base/sign_change.h"
#include "sun/position.h"

namespace relevo::sun {
namespace {

// Between samples the body's elevation has at most one extreme, except within a degree of the pole
// at the equinoxes, where two may lie closer: between them it then changes by less than 0.1 arcsec.
constexpr double kPathSample_s = 1800;
constexpr double kPathRoot_s = 1e-4;
constexpr double kExtreme_s = 0.5;

/// The highest (or, with sign -1, lowest) point of f between a and c.
template <typename F>
double extreme(F&& f, double a, double c, double sign) {
    return highest_place([&](double t_s) { return sign * f(t_s); }, a, c, kExtreme_s);
}

}  // namespace

SkyPath::SkyPath(const PositionTable& table, const TimeSpan& span, const Observer& observer)
    : table_(table), span_(span), observer_(observer) {
    const int steps = std::max(4, static_cast<int>(std::ceil(span.length_s() / kPathSample_s)));
    std::vector<Sample> coarse;
    for (int i = 0; i <= steps; ++i)
        coarse.push_back(sample(span.length_s() * i / steps));
    // Highest and lowest points are samples, too: in between, it only rises or only sets.
    const auto elevation = [this](double t) { return sample(t).elevation_rad; };
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        samples_.push_back(coarse[i]);
        if (i + 2 >= coarse.size()) continue;
        const double before = coarse[i].elevation_rad, here = coarse[i + 1].elevation_rad;
        const double after = coarse[i + 2].elevation_rad;
        if ((here > before) != (after > here))
            extremes_.push_back(sample(
                extreme(elevation, coarse[i].t_s, coarse[i + 2].t_s, here > before ? 1 : -1)));
    }
    // One in the first or the last step that is nearer to the end of the span than to its
    // neighbour shows in no three samples.
    for (const std::size_t i : {std::size_t{0}, coarse.size() - 2}) {
        const Sample &a = coarse[i], &b = coarse[i + 1];
        for (const double sign : {1.0, -1.0}) {
            const Sample found = sample(extreme(elevation, a.t_s, b.t_s, sign));
            if (found.t_s - a.t_s > 2 * kExtreme_s && b.t_s - found.t_s > 2 * kExtreme_s &&
                sign * found.elevation_rad >
                    std::max(sign * a.elevation_rad, sign * b.elevation_rad))
                at_ends_.push_back(found);
        }
    }
    samples_.insert(samples_.end(), extremes_.begin(), extremes_.end());
    std::ranges::sort(samples_, [](const Sample& a, const Sample& b) { return a.t_s < b.t_s; });
}

Crossings SkyPath::crossings(const std::function<double(double)>& threshold_rad) const {
    const auto height = [&](const Sample& s) {
        return s.elevation_rad - threshold_rad(s.distance_au);
    };
    const auto height_at = [&](double t) { return height(sample(t)); };
    std::vector<Sample> samples = samples_;
    for (const Sample& extreme : at_ends_) {
        const auto after =
            std::upper_bound(samples.begin(), samples.end(), extreme,
                             [](const Sample& a, const Sample& b) { return a.t_s < b.t_s; });
        const bool above = height(extreme) > 0;
        if (above != (height(*after) > 0) && above != (height(*(after - 1)) > 0))
            samples.insert(after, extreme);
    }
    Crossings found;
    double above_since_s = 0;
    bool above = height(samples.front()) > 0;
    const bool above_at_first = above;
    for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
        const double a = height(samples[i]), b = height(samples[i + 1]);
        if ((b > 0) == above) continue;
        const double t =
            sign_change(height_at, samples[i].t_s, a, samples[i + 1].t_s, b, kPathRoot_s);
        above = b > 0;
        (above ? found.rising_s : found.setting_s).push_back(t);
        if (above)
            above_since_s = t;
        else
            found.above.push_back({span_.begin + above_since_s, span_.begin + t});
    }
    if (above) found.above.push_back({span_.begin + above_since_s, span_.end});
    if (found.rising_s.empty() && found.setting_s.empty())
        found.state = above_at_first ? Crossing::AboveAllDay : Crossing::BelowAllDay;
    return found;
}

void SkyPath::add_transits(std::vector<Event>& events) const {
    const auto east = [this](double t) { return sample(t).east_au; };
    for (std::size_t i = 0; i + 1 < samples_.size(); ++i) {
        const Sample &a = samples_[i], &b = samples_[i + 1];
        if ((a.east_au > 0) == (b.east_au > 0)) continue;
        add(events, a.east_au > 0 ? EventKind::Transit : EventKind::LowerTransit,
            sign_change(east, a.t_s, a.east_au, b.t_s, b.east_au, kPathRoot_s));
    }
}

void SkyPath::add(std::vector<Event>& events, EventKind kind, double t_s) const {
    const Instant utc = span_.begin + t_s;
    const glm::dvec3 body = table_.vector_au(utc, observer_);
    events.push_back({kind, utc, azimuth_of(body), elevation_of(body)});
}

void SkyPath::add(std::vector<Event>& events, EventKind rising, EventKind setting,
                  const Crossings& crossings) const {
    for (const double t : crossings.rising_s)
        add(events, rising, t);
    for (const double t : crossings.setting_s)
        add(events, setting, t);
}

SkyPath::Sample SkyPath::sample(double t_s) const {
    const glm::dvec3 body = table_.vector_au(span_.begin + t_s, observer_);
    return {t_s, elevation_of(body), body.x, glm::length(body)};
}

}  // namespace relevo::sun
