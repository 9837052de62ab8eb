#include "dem/summary.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/contains.h"
#include "base/log.h"
#include "base/units.h"
#include "dem/interpret.h"
#include "dem/load.h"
#include "dem/survey.h"
#include "dem/unearthly.h"
#include "geo/format.h"

namespace relevo::dem {
namespace {

const char* name_of(UnitSource source) {
    switch (source) {
        case UnitSource::Option:
            return "option";
        case UnitSource::Band:
            return "band";
        case UnitSource::VerticalCrs:
            return "vertical crs";
        case UnitSource::Encoding:
            return "encoding";
        default:
            return "assumed";
    }
}

/// To so many decimals, so that JSON does not show the noise of the last bits.
double rounded(double value, int decimals) {
    const double scale = std::pow(10.0, decimals);
    return std::round(value * scale) / scale;
}

std::string distance_text(double metres) {
    if (metres >= 10'000) return fmt::format("{:.1f} km", metres / 1000);
    if (metres >= 100) return fmt::format("{:.0f} m", metres);
    return fmt::format("{:.2f} m", metres);
}

}  // namespace

namespace {

Summary summary_of(const Description& about, const Grid& grid, const Spikes& spikes) {
    Summary s;
    s.path = about.path;
    s.files = about.files;
    s.tiles = about.tiles;
    s.driver = about.driver;
    s.data_type = about.data_type;
    s.columns = grid.columns();
    s.rows = grid.rows();
    s.crs = grid.crs().text();
    s.crs_name = grid.crs().name();
    s.center = grid.center();
    s.utm = geo::utm_text(s.center);
    s.mgrs = geo::mgrs_text(s.center);
    s.extent_m = grid.extent_m();
    s.sides_m = grid.sides_m();
    s.row_azimuth_rad = grid.row_azimuth_rad();
    s.post_spacing_m = grid.post_spacing_m();
    s.min_m = about.statistics.min_m;
    s.max_m = about.statistics.max_m;
    s.nodata_share = about.statistics.nodata_share();
    s.nodata = about.nodata;
    s.nodata_text = about.nodata_text();
    s.holes_by = about.holes_by;
    s.alpha_band = about.alpha_band;
    s.outliers = about.statistics.outliers;
    s.spikes = spikes;
    s.unit = about.unit.name;
    s.unit_source = name_of(about.unit_source);
    s.vertical_datum = about.vertical_datum;
    s.band = about.band;
    s.bands = about.bands;
    s.assumptions = about.assumptions;
    return s;
}

/// How holes were told from heights, in brackets; empty where nothing but NaN says so and there is
/// none.
std::string holes_text(const Summary& s) {
    std::vector<std::string> ways;
    for (const std::string& by : s.holes_by)
        if (by == "mask")
            ways.emplace_back("mask");
        else if (by == "alpha")
            ways.push_back(fmt::format("alpha band {}", s.alpha_band));
        else if (by == "earth")
            ways.emplace_back("not on the Earth");
        else if (by == "found" && !s.nodata)
            ways.emplace_back("too large for heights, not declared");
    if (s.nodata) {
        const bool found = contains(s.holes_by, "found");
        ways.push_back(fmt::format("nodata {}{}", s.nodata_text, found ? ", not declared" : ""));
    }
    if (ways.empty() && s.nodata_share > 0 && s.files.size() == 1) ways.emplace_back("NaN");
    return ways.empty() ? "" : fmt::format(" ({})", fmt::join(ways, "; "));
}

/// Whether rows run so far from east and from north that sides are shorter than the extent.
bool is_turned(const Summary& s) {
    constexpr double kTurned = 0.09;  // sine of 5 degrees: no UTM zone turns its rows that far
    return std::abs(std::sin(2 * s.row_azimuth_rad)) > 2 * kTurned;
}

/// Says of heights that every command but this one refuses them.
void report_unearthly(Description& about, const Grid& grid, const Spikes& spikes) {
    const std::string what = unearthly(about, spikes_matter(about, grid) ? spikes : Spikes{});
    if (what.empty()) return;
    guess(about, what);
    log::info(fmt::format("{}: {}", about.path, what));
}

/// Null for a DEM without an index.
nlohmann::ordered_json tiles_json(const TileReport& tiles) {
    if (tiles.tiles == 0) return nullptr;
    return {{"count", tiles.tiles},
            {"missing", tiles.missing.count},
            {"missing_names", tiles.missing.first},
            {"broken", tiles.broken.count},
            {"broken_names", tiles.broken.first},
            {"differing", tiles.differing.count},
            {"differing_names", tiles.differing.first},
            {"stepped", tiles.stepped.count},
            {"stepped_names", tiles.stepped.first}};
}

/// "509, 3 missing, 1 broken"
std::string tiles_text(const TileReport& tiles) {
    std::string text = fmt::format("{}", tiles.tiles);
    const auto add = [&](const NamedTiles& some, const char* what) {
        if (some.count > 0) text += fmt::format(", {} {}", some.count, what);
    };
    add(tiles.missing, "missing");
    add(tiles.broken, "broken");
    add(tiles.differing, "unlike the first");
    return text;
}

}  // namespace

Summary summarize(const Source& source, std::int64_t max_posts) {
    Description about = source.description();
    const Survey found = survey(source, max_posts);
    about.statistics = found.statistics;
    report_heights(source, about, found.collar);
    report_unearthly(about, source.grid(), found.spikes);
    Summary s = summary_of(about, source.grid(), found.spikes);
    if (found.spikes.count > 0) {
        const int column = found.spikes.worst_column, row = found.spikes.worst_row;
        s.worst_spike = source.grid().place(column, row);
        s.worst_spike->height_m = source.read({column, row, 1, 1}, 1, 1).at(0, 0);
    }
    return s;
}

Summary summarize(const Heightfield& field) {
    const Spikes spikes = find_spikes(field.height_m, field.grid.post_spacing_m());
    Description about = field.about;
    report_unearthly(about, field.grid, spikes);
    Summary s = summary_of(about, field.grid, spikes);
    if (spikes.count > 0) s.worst_spike = field.place(spikes.worst_column, spikes.worst_row);
    return s;
}

std::string to_json(const Summary& s) {
    using Json = nlohmann::ordered_json;
    Json json;
    json["path"] = s.path;
    constexpr std::size_t kMostNames = 100;
    json["files"] = std::vector<std::string>(
        s.files.begin(),
        s.files.begin() + static_cast<std::ptrdiff_t>(std::min(s.files.size(), kMostNames)));
    json["file_count"] = s.files.size();
    json["tiles"] = tiles_json(s.tiles);
    json["driver"] = s.driver;
    json["data_type"] = s.data_type;
    json["size"] = {s.columns, s.rows};
    json["crs"] = s.crs;
    json["crs_name"] = s.crs_name;
    json["center"] = {{"lat_deg", rounded(degrees(s.center.lat_rad), 9)},
                      {"lon_deg", rounded(degrees(s.center.lon_rad), 9)}};
    json["utm"] = s.utm;
    json["mgrs"] = s.mgrs;
    json["extent_m"] = {rounded(s.extent_m.x, 3), rounded(s.extent_m.y, 3)};
    json["side_m"] = {rounded(s.sides_m.x, 3), rounded(s.sides_m.y, 3)};
    json["row_azimuth_deg"] = rounded(degrees(s.row_azimuth_rad), 6);
    json["post_spacing_m"] = {rounded(s.post_spacing_m.x, 6), rounded(s.post_spacing_m.y, 6)};
    json["elevation_m"] = {{"min", rounded(s.min_m, 3)}, {"max", rounded(s.max_m, 3)}};
    json["nodata_share"] = s.nodata_share;
    // JSON has no number for a nodata value that is NaN or infinite; the text says those too.
    json["nodata"] = s.nodata && std::isfinite(*s.nodata) ? Json(*s.nodata) : Json();
    json["nodata_text"] = s.nodata ? Json(s.nodata_text) : Json();
    json["holes_by"] = s.holes_by;
    json["outliers"] = s.outliers;
    Json& spikes = json["spikes"] = {
        {"count", s.spikes.count}, {"limit_m", rounded(s.spikes.limit_m, 3)}, {"worst", Json()}};
    if (s.worst_spike)
        spikes["worst"] = {{"lat_deg", rounded(degrees(s.worst_spike->lat_rad), 9)},
                           {"lon_deg", rounded(degrees(s.worst_spike->lon_rad), 9)},
                           {"height_m", rounded(s.worst_spike->height_m, 3)},
                           {"off_m", rounded(s.spikes.worst_m, 3)}};
    json["unit"] = s.unit;
    json["unit_source"] = s.unit_source;
    json["vertical_datum"] = s.vertical_datum.empty() ? Json() : Json(s.vertical_datum);
    json["band"] = s.band;
    json["bands"] = s.bands;
    json["assumptions"] = s.assumptions;
    // A path need not be UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string to_text(const Summary& s) {
    std::string text;
    const auto line = [&text](std::string_view name, const std::string& value) {
        text += fmt::format("{:<10} {}\n", name, value);
    };
    line("file", s.path);
    line("format", fmt::format("{}, {}{}", s.driver, s.data_type,
                               s.bands > 1 ? fmt::format(", band {} of {}", s.band, s.bands) : ""));
    if (s.tiles.tiles > 0) line("tiles", tiles_text(s.tiles));
    line("posts", fmt::format("{} x {}", s.columns, s.rows));
    line("crs", s.crs.size() < 40 && s.crs != s.crs_name ? fmt::format("{} ({})", s.crs, s.crs_name)
                                                         : s.crs_name);
    line("center", fmt::format("{} ({}{}, MGRS {})", geo::degrees_text(s.center),
                               s.utm.starts_with("UPS") ? "" : "UTM ", s.utm, s.mgrs));
    line("extent",
         fmt::format(
             "{} east, {} north{}", distance_text(s.extent_m.x), distance_text(s.extent_m.y),
             is_turned(s) ? fmt::format("; sides {} x {}, rows run towards {:.1f} degrees",
                                        distance_text(s.sides_m.x), distance_text(s.sides_m.y),
                                        degrees(s.row_azimuth_rad))
                          : ""));
    line("spacing", fmt::format("{} x {}", distance_text(s.post_spacing_m.x),
                                distance_text(s.post_spacing_m.y)));
    line("heights", fmt::format("{:.1f} to {:.1f} m", s.min_m, s.max_m));
    line("voids", fmt::format("{:.4g} %{}", 100 * s.nodata_share, holes_text(s)));
    if (s.outliers > 0) line("outliers", fmt::format("{} heights impossible on Earth", s.outliers));
    if (s.worst_spike)
        line("spikes", fmt::format("{} {} more than {:.0f} m above or below all {} "
                                   "neighbours, the worst by {:.0f} m at {}",
                                   s.spikes.count, s.spikes.count == 1 ? "post" : "posts",
                                   s.spikes.limit_m, s.spikes.count == 1 ? "its" : "their",
                                   s.spikes.worst_m, geo::degrees_text(*s.worst_spike)));
    line("unit", fmt::format("{} ({})", s.unit, s.unit_source));
    line("above", s.vertical_datum.empty() ? "unknown" : s.vertical_datum);
    for (const std::string& assumption : s.assumptions)
        line("assumed", assumption);
    return text;
}

}  // namespace relevo::dem
