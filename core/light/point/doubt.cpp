#include "light/point/doubt.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "base/units.h"
#include "sun/position.h"
#include "sun/position_table.h"

namespace relevo::light {
namespace {

// The sun turns by 0.0042 degrees a second, faster only where it stands high.
constexpr double kDoubtStep_s = 30;

/// Where the sun or the moon stands on days that are in order: those that follow each other without
/// a gap, as the days of a year do and eclipses do not, have one table.
class Tables {
  public:
    Tables(const std::vector<LightDay>& days, sun::Body body) : days_(days), body_(body) {}

    const sun::PositionTable& of(std::size_t day) {
        if (!table_ || days_[day].span.end > table_->to()) {
            std::size_t last = day;
            while (last + 1 < days_.size() && days_[last + 1].span.begin <= days_[last].span.end)
                ++last;
            table_.emplace(days_[day].span.begin, days_[last].span.end, body_);
        }
        return *table_;
    }

  private:
    const std::vector<LightDay>& days_;
    sun::Body body_;
    std::optional<sun::PositionTable> table_;
};

std::optional<double> farthest_m(const std::vector<OpenSector>& sectors) {
    if (sectors.empty()) return std::nullopt;
    return std::ranges::max_element(sectors, {}, &OpenSector::needed_m)->needed_m;
}

/// Where terrain of a height could hide a summit, or the sun over it.
std::vector<OpenSector> open_for(const TerrainHorizon& horizon, const Alignments& found,
                                 double highest_m) {
    std::vector<OpenSector> sectors;
    const auto look = [&](double azimuth_rad, double elevation_rad, double until_m) {
        if (const auto open =
                open_beyond(horizon, horizon.at(azimuth_rad), highest_m, elevation_rad, until_m))
            sectors.push_back(*open);
    };
    if (found.sight.visible)
        look(found.sight.azimuth_rad, found.sight.elevation_rad, found.sight.distance_m);
    for (const Alignment& passage : found.passages)
        if (passage.sun_visible) look(passage.azimuth_rad, passage.elevation_rad, kInfinity);
    std::ranges::sort(sectors, {}, &Sector::from_azimuth_rad);
    return sectors;
}

/// Fills in where terrain beyond the DEM could matter, by `open_for` of its height.
template <typename OpenFor>
void settle_open(Doubt& doubt, const dem::Posts& posts, const std::optional<double>& highest_m,
                 const OpenFor& open_for) {
    doubt.highest_m = highest_beyond_m(posts, highest_m);
    doubt.open = open_for(doubt.highest_m);
    if (!highest_m) doubt.earths_needed_m = farthest_m(open_for(kHighestTerrain_m));
}

}  // namespace

double highest_beyond_m(const dem::Posts& posts, const std::optional<double>& given_m) {
    const dem::Posts* const around = posts.surroundings();
    const float highest_m = std::max(posts.highest_m(), around ? around->highest_m() : -INFINITY);
    return given_m.value_or(std::min<double>(highest_m, kHighestTerrain_m));
}

Doubt doubt_of(const TerrainHorizon& horizon, const std::vector<HorizonPoint>& profile,
               const std::optional<double>& highest_m) {
    Doubt doubt;
    settle_open(doubt, horizon.posts(), highest_m,
                [&](double bound_m) { return open_sectors(horizon, profile, bound_m); });
    std::vector<bool> holes;
    for (const HorizonPoint& point : profile)
        holes.push_back(point.hole);
    doubt.holes = sectors_of(holes);
    return doubt;
}

Doubt doubt_of(const DirectLight& light, const std::vector<LightDay>& days,
               const std::vector<HorizonPoint>& profile, const std::optional<double>& highest_m) {
    Doubt doubt;
    doubt.matters = Matters::Sun;
    doubt.body = light.body();
    const auto n = profile.size();
    std::vector<double> lowest_rad(n, kInfinity);
    std::vector<bool> holes(n, false);
    Tables tables(days, light.body());
    // Every direction from one moment to the next, at the lower of the two elevations.
    const auto walk = [&](const sun::PositionTable& table, const sun::Instant& from,
                          const sun::Instant& to, const auto& visit) {
        const double length_s = to - from;
        const int steps = std::max(1, static_cast<int>(std::ceil(length_s / kDoubtStep_s)));
        double before_index = 0, before_rad = 0;
        for (int i = 0; i <= steps; ++i) {
            const glm::dvec3 sun =
                table.vector_au(i == steps ? to : from + length_s * i / steps, light.observer());
            const double index = sun::azimuth_of(sun) / (2 * kPi) * double(n);
            const double elevation_rad = light.refraction().apparent_rad(sun::elevation_of(sun));
            if (i > 0) {
                const double turn = std::remainder(index - before_index, double(n));
                const auto first = std::lround(before_index + std::min(0.0, turn));
                const auto last = std::lround(before_index + std::max(0.0, turn));
                for (long k = first; k <= last; ++k)
                    visit(static_cast<std::size_t>((k % long(n) + long(n)) % long(n)),
                          std::min(elevation_rad, before_rad));
            }
            before_index = index;
            before_rad = elevation_rad;
        }
    };
    for (std::size_t i = 0; i < days.size(); ++i) {
        const LightDay& day = days[i];
        doubt.not_known_s += day.not_known_s;
        for (const LitInterval& lit : day.lit) {
            for (const LightEdge& edge : {lit.begin, lit.end})
                if (edge.elevation_rad < (doubt.lowest_sun ? doubt.lowest_sun->elevation_rad : 0))
                    doubt.lowest_sun = edge;
            walk(tables.of(i), lit.begin.utc, lit.end.utc,
                 [&](std::size_t k, double elevation_rad) {
                     lowest_rad[k] = std::min(lowest_rad[k], elevation_rad);
                 });
            for (const sun::TimeSpan& span : lit.not_known)
                walk(tables.of(i), span.begin, span.end,
                     [&](std::size_t k, double) { holes[k] = true; });
        }
    }
    settle_open(doubt, light.horizon().posts(), highest_m, [&](double bound_m) {
        return open_sectors(light.horizon(), profile, bound_m, lowest_rad);
    });
    doubt.holes = sectors_of(holes);
    return doubt;
}

Doubt doubt_of(const TerrainHorizon& horizon, const Alignments& found,
               const std::optional<double>& highest_m) {
    Doubt doubt;
    doubt.matters = Matters::Alignment;
    settle_open(doubt, horizon.posts(), highest_m,
                [&](double bound_m) { return open_for(horizon, found, bound_m); });
    return doubt;
}

}  // namespace relevo::light
