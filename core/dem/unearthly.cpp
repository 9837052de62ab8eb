#include "dem/unearthly.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace relevo::dem {
namespace {

constexpr double kManyOfThem = 0.01;   // so many are more than single posts
constexpr double kManySpikes = 0.005;  // of ground: none, of noise in a wrong unit: some percent
constexpr std::int64_t kFewestSpikes = 20;
constexpr double kWidestSpacing_m = 1000;

/// "ft (61 to 8534 m)": units in which heights are smaller, and fit.
/// @param fits  is given the factor from the height now to that in the unit
std::vector<std::string> fitting_units(const Description& about,
                                       const std::function<bool(double per)>& fits) {
    constexpr std::array kUnits = {"ft", "dm", "cm", "mm"};
    const Statistics& s = about.statistics;
    std::vector<std::string> fitting;
    for (const char* name : kUnits) {
        const double per = known_unit(name)->metres / about.unit.metres;
        if (per < 1 && is_of_the_earth(s.min_m * per) && is_of_the_earth(s.max_m * per) &&
            fits(per))
            fitting.push_back(fmt::format("{} ({} to {} m)", name, std::lround(s.min_m * per),
                                          std::lround(s.max_m * per)));
    }
    return fitting;
}

std::string remedies(const Description& about, const std::vector<std::string>& units) {
    if (about.unit_source == UnitSource::Encoding)
        return "; try the other --encoding, or --unit m if they are right";
    std::vector<std::string> ways;
    if (!units.empty()) ways.push_back(fmt::format("--unit {}", fmt::join(units, " or ")));
    ways.emplace_back("--nodata V if the stored value V marks voids");
    // One unit would be that of all files.
    if (!about.has_several_units && known_unit(about.unit.name))
        ways.push_back(fmt::format("--unit {} if they are right", about.unit.name));
    return fmt::format("; add {}", fmt::join(ways, ", or "));
}

/// Whether heights beyond the Earth's speak of a wrong unit, not of single posts or of a value that
/// marks voids, which is mostly far below.
bool outliers_are_of_a_unit(const Statistics& s) {
    return static_cast<double>(s.outliers) >= kManyOfThem * static_cast<double>(s.valid) ||
           (s.outliers >= kFewestSpikes && is_of_the_earth(s.min_m));
}

}  // namespace

bool spikes_matter(const Description& about, const Grid& grid) {
    const glm::dvec2 spacing_m = grid.post_spacing_m();
    return about.unit_source == UnitSource::Assumed &&
           std::max(spacing_m.x, spacing_m.y) <= kWidestSpacing_m;
}

std::string unearthly(const Description& about, const Spikes& spikes) {
    const Statistics& s = about.statistics;
    const auto valid = static_cast<double>(s.valid);
    if (s.outliers > 0)
        return fmt::format("{} of {} heights are outside -11500 to 9000 m ({:.0f} to {:.0f} m)",
                           s.outliers, s.valid, s.min_m, s.max_m) +
               remedies(about, outliers_are_of_a_unit(s)
                                   ? fitting_units(about, [](double) { return true; })
                                   : std::vector<std::string>());
    if (spikes.count < kFewestSpikes || static_cast<double>(spikes.count) < kManySpikes * valid)
        return {};
    const std::vector<std::string> units =
        fitting_units(about, [&](double per) { return spikes.worst_m * per <= spikes.limit_m; });
    if (units.empty()) return {};
    return fmt::format(
               "{} of {} heights differ from all neighbours by {:.0f} m or more ({:.0f} to {:.0f} "
               "m), so the unit may be wrong",
               spikes.count, s.valid, spikes.limit_m, s.min_m, s.max_m) +
           remedies(about, units);
}

}  // namespace relevo::dem
