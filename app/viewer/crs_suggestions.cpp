#include "viewer/crs_suggestions.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <limits>
#include <optional>

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
constexpr std::size_t kMostTried = 40, kMostUsed = 400;
/// World maps hold everything: the raster has to be somewhere around the other DEM.
constexpr double kAround_m = 1'000'000;

/// Corners of the raster as its file has them; empty: it has no coordinates.
std::vector<glm::dvec2> corners_of(const RecentDem& dem) {
    for (const char* any : {"EPSG:3857", "EPSG:4326"}) {  // of metres, of degrees
        try {
            dem::LoadOptions options = dem.options;
            options.crs = any;
            const dem::Grid grid = dem::Source::open(dem.files, options).grid();
            const double right = grid.columns() - 0.5, below = grid.rows() - 0.5;
            return {grid.affine()(-0.5, -0.5), grid.affine()(right, -0.5),
                    grid.affine()(-0.5, below), grid.affine()(right, below)};
        } catch (const Error&) {
            // Not a file that any CRS would help.
        }
    }
    return {};
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

/// Projected CRSs whose area has a place: UTM on WGS 84 and ETRS89, then the smallest areas.
/// Rasters have eastings first: variants with another order of axes are the same and are skipped.
std::vector<geo::KnownCrs> used_at(const geo::Geodetic& place) {
    std::vector<geo::KnownCrs> used = geo::search_crs(
        fmt::format("{},{}", degrees(place.lat_rad), degrees(place.lon_rad)), kMostUsed);
    std::erase_if(used, [](const geo::KnownCrs& crs) { return crs.name.ends_with("(N-E)"); });
    std::ranges::stable_partition(used, [](const geo::KnownCrs& crs) {
        return crs.name.starts_with("WGS 84 / UTM") || crs.name.starts_with("ETRS89 / UTM");
    });
    if (used.size() > kMostTried) used.resize(kMostTried);
    return used;
}

/// Those that are suggested wherever they are.
std::vector<geo::KnownCrs> named_and_usual(const RecentDem& dem,
                                           const std::optional<dem::Grid>& other) {
    std::vector<geo::KnownCrs> all;
    const auto add_code = [&](const std::string& code) {
        const std::vector<geo::KnownCrs> found = geo::search_crs(code, 1);
        if (!found.empty() && found.front().code == code) all.push_back(found.front());
    };
    for (const std::string& code : codes_in(std::filesystem::path(dem.files.front()).stem()))
        add_code("EPSG:" + code);
    if (other) add_code(other->crs().code());
    add_code("EPSG:4326");
    return all;
}

}  // namespace

std::string near_text(const geo::Geodetic& place) {
    constexpr double kNear_m = 50'000;
    try {
        if (const names::Entry* const named =
                names::Gazetteer::shipped().nearest_place({place, kNear_m}))
            return tr_format("near {} ({})", named->name, named->country);
    } catch (const Error&) {
        // The sheet that finds names says that their lists cannot be read.
    }
    return {};
}

std::string where_text(const geo::Geodetic& place) {
    const std::string name = near_text(place);
    return (name.empty() ? "" : name + ", ") + coordinates_text(place, Coordinates::Degrees);
}

std::vector<CrsSuggestion> suggest_crs(const RecentDem& dem, const RecentDem& other) {
    const std::vector<glm::dvec2> corners = corners_of(dem);
    std::vector<CrsSuggestion> suggestions;
    if (corners.empty()) return suggestions;
    const std::optional<dem::Grid> last = grid_of(other);
    const auto add = [&](const geo::KnownCrs& crs, double most_m) {
        const auto is_it = [&](const CrsSuggestion& each) { return each.crs.code == crs.code; };
        if (suggestions.size() == kMost || std::ranges::any_of(suggestions, is_it)) return;
        if (!geo::holds(crs, corners)) return;
        const glm::dvec2 middle = (corners[0] + corners[3]) / 2.0;
        const geo::Geodetic place =
            geo::Crs::parse(crs.code, crs.code).to_geodetic(middle.x, middle.y);
        if (last && geo::geodesic(last->center(), place).distance_m > most_m) return;
        suggestions.push_back({crs, where_text(place)});
    };
    for (const geo::KnownCrs& crs : named_and_usual(dem, last))
        add(crs, std::numeric_limits<double>::infinity());
    if (last)
        for (const geo::KnownCrs& crs : used_at(last->center()))
            add(crs, kAround_m);
    return suggestions;
}

}  // namespace relevo::viewer
