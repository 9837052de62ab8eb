#include "geo/crs_search.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "geo/crs.h"
#include "geo/proj.h"

namespace relevo::geo {
namespace {

struct Entry {
    KnownCrs crs;
    std::string words;  // in lower case: code, name, area
};

std::vector<Entry> read_database() {
    const std::unique_ptr<PJ_CONTEXT, PJ_CONTEXT* (*)(PJ_CONTEXT*)> context(
        proj_context_create(), proj_context_destroy.address());
    proj_log_level(context.get(), PJ_LOG_NONE);
    PROJ_CRS_LIST_PARAMETERS* const wanted = proj_get_crs_list_parameters_create();
    const PJ_TYPE types[] = {PJ_TYPE_GEOGRAPHIC_2D_CRS, PJ_TYPE_PROJECTED_CRS};
    wanted->types = types;
    wanted->typesCount = std::size(types);
    int count = 0;
    PROJ_CRS_INFO** const list =
        proj_get_crs_info_list_from_database(context.get(), nullptr, wanted, &count);
    proj_get_crs_list_parameters_destroy(wanted);
    if (!list || count == 0) failed("CRS search: PROJ's database proj.db was not found");
    std::vector<Entry> entries;
    entries.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        const PROJ_CRS_INFO& info = *list[i];
        if (info.celestial_body_name && std::string_view(info.celestial_body_name) != "Earth")
            continue;
        KnownCrs crs;
        crs.code = std::string(info.auth_name) + ":" + info.code;
        crs.name = info.name;
        if (info.area_name) crs.area = info.area_name;
        crs.is_projected = info.type == PJ_TYPE_PROJECTED_CRS;
        if (info.bbox_valid) {
            crs.west_deg = info.west_lon_degree;
            crs.south_deg = info.south_lat_degree;
            crs.east_deg = info.east_lon_degree;
            crs.north_deg = info.north_lat_degree;
        }
        std::string words = lower(crs.code + " " + crs.name + " " + crs.area);
        entries.push_back({std::move(crs), std::move(words)});
    }
    proj_crs_info_list_destroy(list);
    return entries;
}

const std::vector<Entry>& database() {
    static const std::vector<Entry> entries = read_database();
    return entries;
}

double width_deg(const KnownCrs& crs) {
    const double width = crs.east_deg - crs.west_deg;
    return width < 0 ? width + 360 : width;
}

bool covers(const KnownCrs& crs, double lat_deg, double lon_deg) {
    const double east_of_edge = lon_deg - crs.west_deg;
    return lat_deg >= crs.south_deg && lat_deg <= crs.north_deg &&
           east_of_edge - 360 * std::floor(east_of_edge / 360) <= width_deg(crs);
}

/// On the datums of GPS and of Europe, which more DEMs have than others.
bool is_common(const KnownCrs& crs) {
    return crs.name.starts_with("WGS 84") || crs.name.starts_with("ETRS89");
}

/// Latitude and longitude of "47.26,11.39".
std::optional<std::pair<double, double>> place_of(std::string_view text) {
    const std::vector<std::string> parts = split(text, ',');
    if (parts.size() != 2) return std::nullopt;
    const auto lat = parse_number(trimmed(parts[0])), lon = parse_number(trimmed(parts[1]));
    if (!lat || !lon || std::abs(*lat) > 90 || std::abs(*lon) > 180) return std::nullopt;
    return std::pair(*lat, *lon);
}

/// Sorts by `rank` and keeps the first ones.
template <typename Rank>
std::vector<KnownCrs> best(std::vector<const KnownCrs*> found, std::size_t most, const Rank& rank) {
    std::ranges::stable_sort(found,
                             [&](const auto* a, const auto* b) { return rank(*a) < rank(*b); });
    std::vector<KnownCrs> result;
    for (std::size_t i = 0; i < std::min(most, found.size()); ++i)
        result.push_back(*found[i]);
    return result;
}

std::vector<KnownCrs> search_place(double lat_deg, double lon_deg, std::size_t most) {
    std::vector<const KnownCrs*> found;
    for (const Entry& entry : database())
        if (entry.crs.is_projected && covers(entry.crs, lat_deg, lon_deg))
            found.push_back(&entry.crs);
    return best(std::move(found), most, [](const KnownCrs& crs) {
        return std::tuple(width_deg(crs) * (crs.north_deg - crs.south_deg),
                          !crs.code.starts_with("EPSG:"));
    });
}

}  // namespace

std::vector<KnownCrs> search_crs(std::string_view text, std::size_t most) {
    const std::string wanted = lower(trimmed(text));
    if (wanted.empty()) return {};
    if (const auto place = place_of(wanted)) return search_place(place->first, place->second, most);
    const std::vector<std::string> words = split(wanted, ' ');
    std::vector<const KnownCrs*> found;
    for (const Entry& entry : database())
        if (std::ranges::all_of(words, [&](const std::string& word) {
                return entry.words.find(word) != std::string::npos;
            }))
            found.push_back(&entry.crs);
    return best(std::move(found), most, [&](const KnownCrs& crs) {
        const std::string code = lower(crs.code);
        const bool is_code = code == wanted || code.ends_with(":" + wanted);
        return std::tuple(!is_code, !lower(crs.name).starts_with(wanted),
                          !crs.code.starts_with("EPSG:"), !is_common(crs), crs.name.size());
    });
}

bool holds(const KnownCrs& known, std::span<const glm::dvec2> points) {
    const Crs crs = Crs::parse(known.code, known.code);
    return std::ranges::all_of(points, [&](const glm::dvec2& point) {
        // Longitudes may go round once more, latitudes may not.
        if (!known.is_projected && (std::abs(point.x) > 360 || std::abs(point.y) > 90))
            return false;
        const Geodetic place = crs.to_geodetic(point.x, point.y);
        return !std::isnan(place.lat_rad) &&
               covers(known, degrees(place.lat_rad), degrees(place.lon_rad));
    });
}

}  // namespace relevo::geo
