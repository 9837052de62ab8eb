#include "report/doubts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/log.h"
#include "base/units.h"
#include "geo/format.h"
#include "sun/position.h"

namespace relevo::report {
namespace {

/// Directions that follow each other but for less than five degrees are one for a reader.
template <typename Sector, typename Join>
std::vector<Sector> merged(const std::vector<Sector>& sectors, const Join& join) {
    std::vector<Sector> result;
    for (const Sector& sector : sectors) {
        if (!result.empty() &&
            sector.from_azimuth_rad - result.back().to_azimuth_rad < radians(5)) {
            result.back().to_azimuth_rad = sector.to_azimuth_rad;
            join(result.back(), sector);
        } else {
            result.push_back(sector);
        }
    }
    return result;
}

std::string sector_text(const light::Sector& sector) {
    const double from_deg = degrees(sector.from_azimuth_rad);
    const double to_deg = degrees(sector.to_azimuth_rad);
    if (std::lround(from_deg) == std::lround(to_deg))
        return fmt::format("at azimuth {:.0f} ({})", from_deg, geo::compass_point(from_deg));
    return fmt::format("from azimuth {:.0f} ({}) to {:.0f} ({})", from_deg,
                       geo::compass_point(from_deg), to_deg, geo::compass_point(to_deg));
}

std::string matters_text(const light::Doubt& doubt) {
    switch (doubt.matters) {
        case light::Matters::Sun:
            return fmt::format("hide the {}", name_of(doubt.body));
        case light::Matters::Alignment:
            return "hide the summit or the sun";
        default:
            return "raise the horizon";
    }
}

void warn_of_the_edge(const light::Doubt& doubt) {
    std::vector<std::string> parts;
    for (const light::OpenSector& s :
         merged(doubt.open, [](light::OpenSector&to, const light::OpenSector&of) {
             to.reach_m = std::min(to.reach_m, of.reach_m);
             to.needed_m = std::max(to.needed_m, of.needed_m);
             to.least_m = std::min(to.least_m, of.least_m);
         }))
        parts.push_back(fmt::format(
            "above {:.0f} m {} as far as {:.0f} km away, where the DEM reaches {:.1f} km",
            s.least_m, sector_text(s), s.needed_m / 1000, s.reach_m / 1000));
    if (parts.empty()) return;
    const std::string earths =
        doubt.earths_needed_m
            ? fmt::format("; those of up to {:.0f} m (the Earth's highest) as far as {:.0f} km",
                          light::kHighestTerrain_m, *doubt.earths_needed_m / 1000)
            : "";
    log::warning(
        fmt::format("mountains of up to {:.0f} m{} outside the DEM could {}: {}{}; use a larger "
                    "DEM or --surroundings, or bound them with --highest",
                    doubt.highest_m, doubt.earths_needed_m ? " (the DEM's highest post)" : "",
                    matters_text(doubt), fmt::join(parts, ", and "), earths));
}

void warn_of_holes(const light::Doubt& doubt) {
    if (doubt.holes.empty()) return;
    log::warning(fmt::format(
        "the DEM has voids {}: {}; use a DEM without voids", sectors_text(doubt.holes),
        doubt.matters == light::Matters::Sun
            ? fmt::format("of the direct {} {} is not known, as ground in them could hide it",
                          doubt.body == sun::Body::Sun ? "sun" : "moonlight",
                          hours_text(std::max(1.0, doubt.not_known_s)))
            : "ground in them could raise the horizon"));
}

/// From a summit the sun is seen so much below the level horizon; ground that is not there, too.
void say_that_more_is_lit(const light::Doubt& doubt) {
    constexpr double kUsual_rad = radians(0.5);
    if (!doubt.lowest_sun || doubt.lowest_sun->elevation_rad > -kUsual_rad) return;
    const double azimuth_deg = degrees(doubt.lowest_sun->azimuth_rad);
    log::info(
        fmt::format("more {} than over a level horizon: it shines from {:.1f} degrees below "
                    "at azimuth {:.0f} ({}), over lower ground",
                    name_of(doubt.body), -degrees(doubt.lowest_sun->elevation_rad), azimuth_deg,
                    geo::compass_point(azimuth_deg)));
}

}  // namespace

void warn_of(const light::Doubt& doubt) {
    say_that_more_is_lit(doubt);
    warn_of_the_edge(doubt);
    warn_of_holes(doubt);
}

std::string sectors_text(const std::vector<light::Sector>& sectors) {
    std::vector<std::string> parts;
    for (const light::Sector& sector : merged(sectors, [](light::Sector&, const light::Sector&) {}))
        parts.push_back(sector_text(sector));
    return fmt::format("{}", fmt::join(parts, ", and "));
}

std::string hours_text(double seconds) {
    const long whole = std::lround(seconds);
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace relevo::report
