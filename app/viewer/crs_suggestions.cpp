#include "viewer/crs_suggestions.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "dem/source.h"
#include "names/gazetteer.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

constexpr std::size_t kMost = 8;
/// Those used where the other DEM is; each is tried, which takes PROJ some 10 ms.
constexpr std::size_t kMostTried = 30;

/// Corners of the raster as its file has them; empty: it has no coordinates.
std::vector<glm::dvec2> corners_of(const RecentDem& dem) {
    try {
        dem::LoadOptions options = dem.options;
        options.crs = "EPSG:3857";  // any: the coordinates stay
        const dem::Grid grid = dem::Source::open(dem.files, options).grid();
        const double right = grid.columns() - 0.5, below = grid.rows() - 0.5;
        return {grid.affine()(-0.5, -0.5), grid.affine()(right, -0.5), grid.affine()(-0.5, below),
                grid.affine()(right, below)};
    } catch (const Error&) {
        return {};
    }
}

/// Of files on this machine alone: nothing is fetched for a suggestion.
std::optional<dem::Grid> grid_of(const RecentDem& dem) {
    std::error_code unknown;
    const auto is_here = [&](const std::string& file) {
        return std::filesystem::exists(file, unknown);
    };
    if (dem.files.empty() || !std::ranges::all_of(dem.files, is_here)) return std::nullopt;
    try {
        return dem::Source::open(dem.files, dem.options).grid();
    } catch (const Error&) {
        return std::nullopt;
    }
}

/// Numbers of four to six digits in a name.
std::vector<std::string> codes_in(const std::string& name) {
    std::vector<std::string> codes;
    std::string digits;
    for (const char c : name + " ") {
        if (std::isdigit(static_cast<unsigned char>(c)) != 0) {
            digits += c;
            continue;
        }
        if (digits.size() >= 4 && digits.size() <= 6) codes.push_back(digits);
        digits.clear();
    }
    return codes;
}

/// In the order in which they are suggested.
std::vector<geo::KnownCrs> candidates(const RecentDem& dem, const RecentDem& other) {
    std::vector<geo::KnownCrs> all;
    const auto add_code = [&](const std::string& code) {
        const std::vector<geo::KnownCrs> found = geo::search_crs(code, 1);
        if (!found.empty() && found.front().code == code) all.push_back(found.front());
    };
    for (const std::string& code : codes_in(std::filesystem::path(dem.files.front()).stem()))
        add_code("EPSG:" + code);
    const std::optional<dem::Grid> grid = grid_of(other);
    if (grid) add_code(grid->crs().code());
    add_code("EPSG:4326");
    if (!grid) return all;
    const geo::Geodetic middle = grid->center();
    const std::vector<geo::KnownCrs> used_there = geo::search_crs(
        fmt::format("{},{}", degrees(middle.lat_rad), degrees(middle.lon_rad)), kMostTried);
    all.insert(all.end(), used_there.begin(), used_there.end());
    return all;
}

}  // namespace

std::string where_text(const geo::Geodetic& place) {
    constexpr double kNear_m = 50'000;
    const std::string degrees = coordinates_text(place, Coordinates::Degrees);
    try {
        if (const names::Entry* const named =
                names::Gazetteer::shipped().nearest_place({place, kNear_m}))
            return tr_format("near {} ({}), {}", named->name, named->country, degrees);
    } catch (const Error&) {
        // The sheet that finds names says that their lists cannot be read.
    }
    return degrees;
}

std::vector<CrsSuggestion> suggest_crs(const RecentDem& dem, const RecentDem& other) {
    const std::vector<glm::dvec2> corners = corners_of(dem);
    std::vector<CrsSuggestion> suggestions;
    if (corners.empty()) return suggestions;
    for (const geo::KnownCrs& crs : candidates(dem, other)) {
        if (suggestions.size() == kMost) break;
        const auto is_it = [&](const CrsSuggestion& each) { return each.crs.code == crs.code; };
        if (std::ranges::any_of(suggestions, is_it) || !geo::holds(crs, corners)) continue;
        const glm::dvec2 middle = (corners[0] + corners[3]) / 2.0;
        suggestions.push_back(
            {crs, where_text(geo::Crs::parse(crs.code, crs.code).to_geodetic(middle.x, middle.y))});
    }
    return suggestions;
}

}  // namespace relevo::viewer
