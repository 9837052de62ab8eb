#include "light/point/direct_light.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/sign_change.h"
#include "base/units.h"
#include "sun/moon_events.h"
#include "sun/position.h"
#include "sun/position_table.h"

namespace relevo::light {
namespace {

constexpr int kDirections = 18000;  // 0.02 degrees, which the sun takes 5 s for
constexpr double kCoarse_s = 1920;  // halved until clear, or
constexpr double kFine_s = 1.875;
constexpr double kRoot_s = 1e-3;
constexpr double kHole_s = 5;

// The sun's way over the sky, with room for refraction, which never makes it faster than this, and
// for its own motion.
constexpr double kFastest_rad_s = 15.1 * kArcsecond_rad;

// Near the zenith azimuths run all round.
constexpr double kZenith_rad = radians(88);

}  // namespace

/// The search for direct light within one span of time.
class LightSearch {
  public:
    LightSearch(const DirectLight& light, const sun::PositionTable& table)
        : light_(light),
          table_(table),
          limb_(light.limb() == sun::Limb::Upper   ? 1
                : light.limb() == sun::Limb::Lower ? -1
                                                   : 0) {}

    /// When the sun stands in holes within an interval.
    std::vector<sun::TimeSpan> not_known(const LitInterval& lit) {
        std::vector<sun::TimeSpan> found;
        if (light_.hole_rad_.empty()) return found;
        begin_ = lit.begin.utc;
        const double length_s = lit.length_s();
        const int pieces = std::max(1, static_cast<int>(std::ceil(length_s / kHole_s)));
        bool before = false;
        for (int i = 0; i < pieces; ++i) {
            const bool here = in_hole(moment(length_s * (i + 0.5) / pieces));
            if (here && !before) found.push_back({begin_ + length_s * i / pieces, {}});
            if (here)
                found.back().end =
                    i + 1 == pieces ? lit.end.utc : begin_ + length_s * (i + 1) / pieces;
            before = here;
        }
        return found;
    }

    bool lit_at(sun::Instant utc) {
        begin_ = utc;
        return clearance(moment(0)) > 0;
    }

    std::vector<LitInterval> lit(const sun::TimeSpan& span) {
        begin_ = span.begin;
        const double length_s = span.length_s();
        Moment a = moment(0);
        is_lit_ = clearance(a) > 0;
        if (is_lit_) open(a, true);
        const int pieces = std::max(1, static_cast<int>(std::ceil(length_s / kCoarse_s)));
        for (int i = 1; i <= pieces; ++i) {
            const Moment b = moment(length_s * i / pieces);
            search(a, b);
            a = b;
        }
        if (is_lit_) close(a, true);
        return std::move(found_);
    }

  private:
    struct Moment {
        double t_s = 0;
        double azimuth_rad = 0, true_rad = 0, apparent_rad = 0, semidiameter_rad = 0;
    };

    Moment moment(double t_s) const {
        const glm::dvec3 sun = table_.vector_au(begin_ + t_s, light_.observer_);
        const double true_rad = sun::elevation_of(sun);
        return {t_s, sun::azimuth_of(sun), true_rad, light_.refraction_.apparent_rad(true_rad),
                sun::semidiameter_rad(glm::length(sun), table_.body())};
    }

    bool in_hole(const Moment& m) const {
        const auto n = light_.hole_rad_.size();
        const double turns = m.azimuth_rad / (2 * kPi);
        const auto before = static_cast<std::size_t>((turns - std::floor(turns)) * double(n)) % n;
        return m.apparent_rad + limb_ * m.semidiameter_rad <=
               std::max(light_.hole_rad_[before], light_.hole_rad_[(before + 1) % n]);
    }

    double horizon_rad(double azimuth_rad) const {
        return light_.horizon_ ? light_.horizon_->elevation_rad(azimuth_rad)
                               : light_.skyline_.elevation_rad(azimuth_rad);
    }

    /// How far what must stand over the terrain does so [rad].
    double clearance(const Moment& m) const {
        if (limb_ == 0 || m.true_rad > kZenith_rad)
            return m.apparent_rad - horizon_rad(m.azimuth_rad);
        // Along the limb: its upper half must be over the terrain anywhere, its lower half
        // everywhere.
        const double step_rad = light_.skyline_.step_rad() / 2;
        const double aside_rad = m.semidiameter_rad / std::cos(m.true_rad);
        const int steps = static_cast<int>(std::ceil(aside_rad / step_rad));
        double best = -kPi;
        for (int i = -steps; i <= steps; ++i) {
            const double x = i / double(steps);
            const double up_rad = m.semidiameter_rad * std::sqrt(1 - x * x);
            const double edge_rad = light_.refraction_.apparent_rad(m.true_rad + limb_ * up_rad);
            const double over =
                edge_rad - light_.skyline_.elevation_rad(m.azimuth_rad + x * aside_rad);
            best = std::max(best, limb_ * over);
        }
        return limb_ * best;
    }

    /// What the table of the horizon says of all the time between two moments.
    enum class Verdict { Lit, Shaded, Unclear };
    Verdict verdict(const Moment& a, const Moment& b) const {
        const double way_rad = kFastest_rad_s * (b.t_s - a.t_s) / 2;
        const double disc_rad = limb_ == 0 ? 0 : std::max(a.semidiameter_rad, b.semidiameter_rad);
        const double middle_rad = (a.apparent_rad + b.apparent_rad) / 2;
        const double high_rad = middle_rad + way_rad + disc_rad;
        const double low_rad = middle_rad - way_rad - disc_rad;
        const double turn_rad = std::remainder(b.azimuth_rad - a.azimuth_rad, 2 * kPi);
        const double wide_rad =
            high_rad < kZenith_rad ? (way_rad + disc_rad) / std::cos(high_rad) : kPi;
        const Skyline::Range range = light_.skyline_.range(a.azimuth_rad + turn_rad / 2, wide_rad);
        // Between two entries of the table the horizon may stand out of their range.
        const double slack_rad = 0.5 * (range.highest_rad - range.lowest_rad) + kArcsecond_rad;
        if (low_rad > range.highest_rad + slack_rad) return Verdict::Lit;
        if (high_rad < range.lowest_rad - slack_rad) return Verdict::Shaded;
        return Verdict::Unclear;
    }

    void search(const Moment& a, const Moment& b) {
        switch (verdict(a, b)) {
            case Verdict::Lit:
                if (!is_lit_) turn(a);
                return;
            case Verdict::Shaded:
                if (is_lit_) turn(a);
                return;
            case Verdict::Unclear:
                break;
        }
        if (b.t_s - a.t_s > kFine_s) {
            const Moment middle = moment((a.t_s + b.t_s) / 2);
            search(a, middle);
            search(middle, b);
            return;
        }
        if ((clearance(b) > 0) != is_lit_) turn(edge(a, b));
    }

    /// Where the light changes between two moments.
    Moment edge(const Moment& a, const Moment& b) const {
        const double fa = clearance(a), fb = clearance(b);
        if ((fa > 0) == (fb > 0)) return a;  // the table and the exact horizon differ by a hair
        const auto clearance_at = [&](double t_s) { return clearance(moment(t_s)); };
        return moment(sign_change(clearance_at, a.t_s, fa, b.t_s, fb, kRoot_s));
    }

    void turn(const Moment& at) {
        is_lit_ = !is_lit_;
        is_lit_ ? open(at, false) : close(at, false);
    }
    LightEdge light_edge(const Moment& at, bool midnight) const {
        return {begin_ + at.t_s, at.azimuth_rad, at.apparent_rad, midnight};
    }
    void open(const Moment& at, bool midnight) {
        found_.push_back({light_edge(at, midnight), {}, {}});
    }
    void close(const Moment& at, bool midnight) {
        found_.back().end = light_edge(at, midnight);
        if (found_.back().length_s() <= 0) found_.pop_back();
    }

    const DirectLight& light_;
    const sun::PositionTable& table_;
    const double limb_;  // 1 upper, -1 lower, 0 centre
    sun::Instant begin_;
    bool is_lit_ = false;
    std::vector<LitInterval> found_;
};

namespace {

std::vector<double> elevations_of(const std::vector<HorizonPoint>& profile) {
    std::vector<double> elevation_rad;
    for (const HorizonPoint& point : profile)
        elevation_rad.push_back(point.elevation_rad);
    return elevation_rad;
}

}  // namespace

namespace {

std::vector<sun::Day> flat_moon_days(sun::Date first, sun::Date last, const sun::Zone& zone,
                                     const geo::Geodetic& place, const sun::RiseRule& rule,
                                     const sun::EarthRotation& rotation) {
    std::vector<sun::Day> days;
    for (const sun::MoonDay& moon : sun::moon_days(first, last, zone, place, rule, rotation)) {
        sun::Day& day = days.emplace_back();
        day.date = moon.date;
        day.span = moon.span;
        day.events = moon.events;
        day.sun = moon.moon;
        day.sun_up = moon.moon_up;
        day.day_length_s = moon.moon_up_s;
        day.definition = rule.description();
    }
    return days;
}

}  // namespace

double LitInterval::not_known_s() const {
    double sum_s = 0;
    for (const sun::TimeSpan& span : not_known)
        sum_s += span.length_s();
    return sum_s;
}

DirectLight::DirectLight(const TerrainHorizon& horizon, const LightOptions& options)
    : DirectLight(horizon, options, horizon.profile(kDirections)) {}

DirectLight::DirectLight(const TerrainHorizon& horizon, const LightOptions& options,
                         const std::vector<HorizonPoint>& profile)
    : horizon_(&horizon),
      options_(options),
      skyline_(elevations_of(profile)),
      observer_(horizon.place()),
      refraction_(options.refraction ? *options.refraction
                                     : sun::Refraction::standard(horizon.place())) {
    if (std::any_of(profile.begin(), profile.end(), [](const HorizonPoint& p) { return p.hole; }))
        for (const HorizonPoint& point : profile) {
            holes_.push_back(point.hole);
            hole_rad_.push_back(point.hole ? point.hole_rad : -kPi / 2);
        }
    define("the terrain horizon");
}

DirectLight::DirectLight(const geo::Geodetic& place, Skyline skyline, std::string_view over,
                         const LightOptions& options)
    : options_(options),
      skyline_(std::move(skyline)),
      observer_(place),
      refraction_(options.refraction ? *options.refraction : sun::Refraction::standard(place)) {
    define(over);
}

void DirectLight::define(std::string_view over) {
    const char* body = name_of(options_.body);
    const std::string part =
        options_.limb == sun::Limb::Upper   ? fmt::format("any part of the {}'s disc", body)
        : options_.limb == sun::Limb::Lower ? fmt::format("all of the {}'s disc", body)
                                            : fmt::format("centre of the {}", body);
    definition_ =
        fmt::format("direct light: {} over {}, {}", part, over, refraction_.description());
}

LightDay DirectLight::day(sun::Date date, const sun::Zone& zone,
                          const sun::EarthRotation& rotation) const {
    zone.day(date);  // says so where the zone skipped that day
    return days(date, date, zone, rotation).front();
}

std::vector<LitInterval> DirectLight::lit_within(const sun::TimeSpan& span) const {
    return lit_within(span, sun::PositionTable(span.begin, span.end, options_.body));
}

std::vector<LitInterval> DirectLight::lit_within(const sun::TimeSpan& span,
                                                 const sun::PositionTable& table) const {
    std::vector<LitInterval> lit = LightSearch(*this, table).lit(span);
    for (LitInterval& interval : lit)
        interval.not_known = LightSearch(*this, table).not_known(interval);
    return lit;
}

bool DirectLight::lit_at(sun::Instant utc, const sun::PositionTable& table) const {
    return LightSearch(*this, table).lit_at(utc);
}

std::vector<LightDay> DirectLight::days(sun::Date first, sun::Date last, const sun::Zone& zone,
                                        const sun::EarthRotation& rotation) const {
    std::vector<sun::Day> flat =
        options_.body == sun::Body::Sun
            ? sun::day_events(first, last, zone, observer_.place(), options_.flat, rotation)
            : flat_moon_days(first, last, zone, observer_.place(), options_.flat.rule, rotation);
    std::vector<LightDay> days;
    if (flat.empty()) return days;
    const sun::PositionTable table(flat.front().span.begin, flat.back().span.end, rotation,
                                   options_.body);
    for (sun::Day& of_day : flat) {
        LightDay day;
        day.date = of_day.date;
        day.span = of_day.span;
        day.lit = lit_within(day.span, table);
        for (const LitInterval& interval : day.lit) {
            day.lit_s += interval.length_s();
            day.not_known_s += interval.not_known_s();
        }
        day.flat = std::move(of_day);
        days.push_back(std::move(day));
    }
    return days;
}

}  // namespace relevo::light
