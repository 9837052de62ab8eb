#include "sun/events.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/sign_change.h"
#include "sun/position.h"

namespace relevo::sun {

namespace {

constexpr double kCivil_rad = radians(-6.0);
constexpr double kNautical_rad = radians(-12.0);
constexpr double kAstronomical_rad = radians(-18.0);
// Golden and blue hour are given by the centre's true elevation; photographers do not agree.
constexpr double kGoldenFrom_rad = radians(-4.0), kGoldenTo_rad = radians(6.0);
constexpr double kBlueFrom_rad = radians(-6.0), kBlueTo_rad = radians(-4.0);

// Between samples the sun's elevation has at most one extreme, except within a degree of the pole
// at the equinoxes, where two may lie closer: between them it then changes by less than 0.1 arcsec.
constexpr double kSample_s = 1800;
constexpr double kRoot_s = 1e-4;
constexpr double kExtreme_s = 0.5;

/// The highest (or, with sign -1, lowest) point of f between a and c, by golden section.
template <typename F>
double extreme(F&& f, double a, double c, double sign) {
    constexpr double kGolden = 0.6180339887498949;
    double x1 = c - kGolden * (c - a), x2 = a + kGolden * (c - a);
    double f1 = sign * f(x1), f2 = sign * f(x2);
    while (c - a > kExtreme_s) {
        if (f1 > f2) {
            c = x2;
            x2 = x1;
            f2 = f1;
            x1 = c - kGolden * (c - a);
            f1 = sign * f(x1);
        } else {
            a = x1;
            x1 = x2;
            f1 = f2;
            x2 = a + kGolden * (c - a);
            f2 = sign * f(x2);
        }
    }
    return (a + c) / 2;
}

struct Sample {
    double t_s, elevation_rad, east_au, distance_au;
};

/// A span of time above a threshold, or the moments at which it is crossed.
struct Crossings {
    std::vector<double> rising_s, setting_s;
    std::vector<TimeSpan> above;
    Crossing state = Crossing::Crosses;
};

/// The sun's way over the sky of one place within one span of time.
class Path {
  public:
    Path(const PositionTable& table, const TimeSpan& span, const Observer& observer)
        : table_(table), span_(span), observer_(observer) {
        const int steps = std::max(4, static_cast<int>(std::ceil(span.length_s() / kSample_s)));
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

    /// @param threshold_rad  of a distance in au
    Crossings crossings(const std::function<double(double)>& threshold_rad) const {
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
                sign_change(height_at, samples[i].t_s, a, samples[i + 1].t_s, b, kRoot_s);
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

    Crossings crossings(double threshold_rad) const {
        return crossings([threshold_rad](double) { return threshold_rad; });
    }

    void add_transits(std::vector<Event>& events) const {
        const auto east = [this](double t) { return sample(t).east_au; };
        for (std::size_t i = 0; i + 1 < samples_.size(); ++i) {
            const Sample &a = samples_[i], &b = samples_[i + 1];
            if ((a.east_au > 0) == (b.east_au > 0)) continue;
            add(events, a.east_au > 0 ? EventKind::Transit : EventKind::LowerTransit,
                sign_change(east, a.t_s, a.east_au, b.t_s, b.east_au, kRoot_s));
        }
    }

    void add(std::vector<Event>& events, EventKind kind, double t_s) const {
        const Instant utc = span_.begin + t_s;
        const glm::dvec3 sun = table_.vector_au(utc, observer_);
        events.push_back({kind, utc, azimuth_of(sun), elevation_of(sun)});
    }

    void add(std::vector<Event>& events, EventKind rising, EventKind setting,
             const Crossings& crossings) const {
        for (const double t : crossings.rising_s)
            add(events, rising, t);
        for (const double t : crossings.setting_s)
            add(events, setting, t);
    }

  private:
    Sample sample(double t_s) const {
        const glm::dvec3 sun = table_.vector_au(span_.begin + t_s, observer_);
        return {t_s, elevation_of(sun), sun.x, glm::length(sun)};
    }

    const PositionTable& table_;
    const TimeSpan& span_;
    const Observer& observer_;
    std::vector<Sample> samples_, extremes_;
    std::vector<Sample> at_ends_;  // extremes that only a threshold between them and the end needs
};

/// What of `spans` is in none of `others`.
std::vector<TimeSpan> without(const std::vector<TimeSpan>& spans,
                              const std::vector<TimeSpan>& others) {
    std::vector<TimeSpan> left;
    for (TimeSpan span : spans) {
        for (const TimeSpan& other : others) {
            if (other.end <= span.begin || other.begin >= span.end) continue;
            if (other.begin > span.begin) left.push_back({span.begin, other.begin});
            span.begin = std::min(other.end, span.end);
        }
        if (span.begin < span.end) left.push_back(span);
    }
    return left;
}

}  // namespace

std::string_view name_of(EventKind kind) {
    constexpr std::array<std::string_view, 10> kNames = {
        "astronomical_dawn", "nautical_dawn", "civil_dawn", "sunrise",
        "transit",           "sunset",        "civil_dusk", "nautical_dusk",
        "astronomical_dusk", "lower_transit"};
    return kNames[static_cast<std::size_t>(kind)];
}

std::optional<Instant> Day::first(EventKind kind) const {
    for (const Event& event : events)
        if (event.kind == kind) return event.utc;
    return std::nullopt;
}

std::vector<Instant> Day::all(EventKind kind) const {
    std::vector<Instant> times;
    for (const Event& event : events)
        if (event.kind == kind) times.push_back(event.utc);
    return times;
}

Day day_events(const PositionTable& table, const TimeSpan& span, const Observer& observer,
               const DayOptions& options) {
    const Path path(table, span, observer);
    Day day;
    day.span = span;
    day.definition = options.rule.description();

    const Crossings sun = path.crossings(
        [&](double distance_au) { return options.rule.center_elevation_rad(distance_au); });
    const Crossings civil = path.crossings(kCivil_rad);
    const Crossings nautical = path.crossings(kNautical_rad);
    const Crossings astronomical = path.crossings(kAstronomical_rad);
    path.add(day.events, EventKind::Sunrise, EventKind::Sunset, sun);
    path.add(day.events, EventKind::CivilDawn, EventKind::CivilDusk, civil);
    path.add(day.events, EventKind::NauticalDawn, EventKind::NauticalDusk, nautical);
    path.add(day.events, EventKind::AstronomicalDawn, EventKind::AstronomicalDusk, astronomical);
    path.add_transits(day.events);
    std::ranges::sort(day.events, [](const Event& a, const Event& b) { return a.utc < b.utc; });
    day.sun = sun.state;
    day.civil = civil.state;
    day.nautical = nautical.state;
    day.astronomical = astronomical.state;
    day.sun_up = sun.above;
    for (const TimeSpan& up : sun.above)
        day.day_length_s += up.length_s();
    day.golden_hour =
        without(path.crossings(kGoldenFrom_rad).above, path.crossings(kGoldenTo_rad).above);
    day.blue_hour = without(path.crossings(kBlueFrom_rad).above, path.crossings(kBlueTo_rad).above);
    return day;
}

Day day_events(Date date, const Zone& zone, const geo::Geodetic& place, const DayOptions& options,
               const EarthRotation& rotation) {
    const Observer observer(place);
    const TimeSpan span = zone.day(date);
    Day day = day_events(PositionTable(span.begin, span.end, rotation), span, observer, options);
    day.date = date;
    return day;
}

std::vector<Day> day_events(Date first, Date last, const Zone& zone, const geo::Geodetic& place,
                            const DayOptions& options, const EarthRotation& rotation) {
    if (last < first)
        bad_input(fmt::format("sun: from {} to {}: ends before it begins", to_string(first),
                              to_string(last)));
    const Observer observer(place);
    std::vector<Day> days;
    for (Date date = first; date <= last; date = add_days(date, 1)) {
        if (const auto span = zone.find_day(date)) {
            days.emplace_back();
            days.back().date = date;
            days.back().span = *span;
        }
    }
    if (days.empty()) return days;
    const PositionTable table(days.front().span.begin, days.back().span.end, rotation);
    for (Day& day : days) {
        const Date date = day.date;
        day = day_events(table, day.span, observer, options);
        day.date = date;
    }
    return days;
}

}  // namespace relevo::sun
