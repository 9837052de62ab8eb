#include "output/stac.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/percent.h"
#include "base/text.h"
#include "base/units.h"
#include "dem/gdal.h"
#include "dem/gdal_open.h"
#include "dem/gdal_support.h"
#include "output/tile_mosaic.h"
#include "sun/zone.h"

namespace relevo::output {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

using dem::Dataset;

struct Outline {
    std::vector<glm::dvec2> ring;  ///< longitude and latitude [deg], counterclockwise, closed
    double west = 0, south = 0, east = 0, north = 0;
};

/// Seven decimals are a centimetre.
double rounded(double degrees) {
    return std::round(degrees * 1e7) / 1e7;
}

/// The edge of a tile's cells; longitudes go on past 180 degrees.
Outline outline_of(const dem::Grid& grid, const dem::Window& tile) {
    constexpr int kPointsASide = 8;
    const double left = tile.column - 0.5, top = tile.row - 0.5, right = left + tile.columns,
                 bottom = top + tile.rows;
    const std::array<glm::dvec2, 5> corners{
        {{left, top}, {left, bottom}, {right, bottom}, {right, top}, {left, top}}};
    Outline outline;
    double area = 0;
    for (std::size_t side = 0; side < 4; ++side)
        for (int i = 0; i < kPointsASide; ++i) {
            const glm::dvec2 post =
                glm::mix(corners[side], corners[side + 1], double(i) / kPointsASide);
            const geo::Geodetic place = grid.place(post.x, post.y);
            glm::dvec2 point(degrees(place.lon_rad), degrees(place.lat_rad));
            if (!std::isfinite(point.x + point.y)) continue;
            if (!outline.ring.empty())
                point.x -= 360 * std::round((point.x - outline.ring.back().x) / 360);
            outline.ring.emplace_back(rounded(point.x), rounded(point.y));
        }
    if (outline.ring.empty()) return outline;
    outline.ring.push_back(outline.ring.front());
    outline.west = outline.east = outline.ring.front().x;
    outline.south = outline.north = outline.ring.front().y;
    for (std::size_t i = 0; i + 1 < outline.ring.size(); ++i) {
        const glm::dvec2 &a = outline.ring[i], &b = outline.ring[i + 1];
        area += a.x * b.y - b.x * a.y;
        outline.west = std::min(outline.west, b.x), outline.east = std::max(outline.east, b.x);
        outline.south = std::min(outline.south, b.y), outline.north = std::max(outline.north, b.y);
    }
    if (area < 0) std::ranges::reverse(outline.ring);
    return outline;
}

Json box(double west, double south, double east, double north) {
    return {{{west, south}, {east, south}, {east, north}, {west, north}, {west, south}}};
}

/// Geometry and bounding box, RFC 7946 sections 3.1.9 and 5.2.
void add_outline(Json& item, const Outline& outline) {
    if (outline.ring.empty()) {
        item["geometry"] = nullptr;
        return;
    }
    const double turns = 360 * std::floor((outline.west + 180) / 360);
    const double west = rounded(outline.west - turns), east = rounded(outline.east - turns);
    if (east <= 180) {
        Json ring = Json::array();
        for (const glm::dvec2& point : outline.ring)
            ring.push_back({rounded(point.x - turns), point.y});
        item["geometry"] = {{"type", "Polygon"}, {"coordinates", Json::array({ring})}};
        item["bbox"] = {west, outline.south, east, outline.north};
        return;
    }
    item["geometry"] = {
        {"type", "MultiPolygon"},
        {"coordinates",
         Json::array({box(west, outline.south, 180, outline.north),
                      box(-180, outline.south, rounded(east - 360), outline.north)})}};
    item["bbox"] = {west, outline.south, rounded(east - 360), outline.north};
}

/// Metadata of a file, or of a band of it.
std::map<std::string, std::string> metadata_of(GDALMajorObjectH object) {
    std::map<std::string, std::string> found;
    for (char** item = GDALGetMetadata(object, nullptr); item && *item; ++item) {
        const std::string text = *item;
        const std::size_t equals = text.find('=');
        if (equals != std::string::npos) found[text.substr(0, equals)] = text.substr(equals + 1);
    }
    return found;
}

std::optional<std::string> utc(const std::map<std::string, std::string>& metadata,
                               const char* key) {
    const auto found = metadata.find(key);
    if (found == metadata.end()) return std::nullopt;
    return sun::to_iso(sun::parse_time(found->second).utc);
}

/// The time of the file's last change.
std::string time_of_file(const fs::path& path) {
    VSIStatBufL found{};
    if (VSIStatL(path.c_str(), &found) != 0) return sun::to_iso(sun::Instant{});
    return sun::to_iso(sun::Instant::from_unix_us(found.st_mtime * std::int64_t{1'000'000}));
}

void add_times(Json& properties, GDALDatasetH dataset, const fs::path& path) {
    const auto whole = metadata_of(dataset);
    std::vector<std::string> times;
    if (const auto from = utc(whole, "TIME_FROM")) times = {*from, *utc(whole, "TIME_TO")};
    if (const auto at = utc(whole, "TIME_UTC")) times = {*at};
    for (int band = 1; times.empty() && band <= GDALGetRasterCount(dataset); ++band)
        if (const auto at = utc(metadata_of(GDALGetRasterBand(dataset, band)), "TIME_UTC"))
            times.push_back(*at);
    if (times.empty()) times = {time_of_file(path)};
    std::ranges::sort(times);
    if (times.front() == times.back()) {
        properties["datetime"] = times.front();
        return;
    }
    properties["datetime"] = nullptr;
    properties["start_datetime"] = times.front();
    properties["end_datetime"] = times.back();
}

void add_grid(Json& to, const TilePlan& plan, const dem::Window& tile) {
    const geo::Crs& crs = plan.grid.crs();
    constexpr std::string_view kEpsg = "EPSG:";
    const bool has_code = crs.code().starts_with(kEpsg);
    to["proj:code"] = has_code ? Json(crs.code()) : Json(nullptr);
    to["proj:epsg"] = has_code ? Json(std::stoi(crs.code().substr(kEpsg.size()))) : Json(nullptr);
    if (!has_code) to["proj:wkt2"] = crs.wkt();
    const auto t = plan.grid.part(tile, tile.columns, tile.rows).affine().geotransform();
    to["proj:shape"] = {tile.rows, tile.columns};
    to["proj:transform"] = {t[1], t[2], t[0], t[4], t[5], t[3]};
}

Json bands_of(GDALDatasetH dataset) {
    Json bands = Json::array();
    for (int band = 1; band <= GDALGetRasterCount(dataset); ++band) {
        GDALRasterBandH const from = GDALGetRasterBand(dataset, band);
        const bool is_byte = GDALGetRasterDataType(from) == GDT_Byte;
        bands.push_back({{"name", GDALGetDescription(from)},
                         {"data_type", is_byte ? "uint8" : "float32"},
                         {"unit", GDALGetRasterUnitType(from)},
                         {"nodata", is_byte ? Json(255) : Json("nan")}});
    }
    return bands;
}

/// How a collection names a file: as a URI. What is not one stays: buckets' keys, GDAL's names.
/// @param base  as stac_text() takes it
std::string href_of(const fs::path& collection, const fs::path& tile, const std::string& base) {
    if (base.empty()) return percent_encoded(name_from(collection, tile));
    const auto starts = [&](const char* scheme) { return base.starts_with(scheme); };
    const std::string name = tile.filename().string(), slash = base.ends_with('/') ? "" : "/";
    if (starts("s3://") || starts("gs://") || starts("/vsi")) return base + slash + name;
    const bool is_url = base.find("://") != std::string::npos || starts("file:");
    return (is_url ? percent_encoded_url(base) : percent_encoded(base)) + slash +
           percent_encoded(name);
}

/// @param href  of the tile's file
Json item_of(const std::string& href, const fs::path& folder, const TilePlan& plan,
             const PlannedTile& tile) {
    const fs::path file = folder / tile.name;
    const dem::GdalMessages messages;
    const Dataset dataset = dem::open_by_gdal(AllowedName(file.string()), GDAL_OF_RASTER);
    if (!dataset)
        failed(fmt::format("merge: {}: cannot be read, {}", printable(file.string()),
                           messages.failure(file.string())));
    Json item{
        {"type", "Feature"},
        {"stac_version", "1.1.0"},
        // The version that has both proj:code and proj:epsg: 2.0.0 forbids the latter.
        {"stac_extensions", {"https://stac-extensions.github.io/projection/v1.2.0/schema.json"}},
        {"id", fs::path(tile.name).stem().string()}};
    add_outline(item, outline_of(plan.grid, tile.window));
    Json properties = Json::object();
    add_times(properties, dataset.get(), file);
    properties["description"] = plan.command;
    add_grid(properties, plan, tile.window);
    item["properties"] = properties;
    item["links"] = Json::array();
    item["assets"] = {{"data",
                       {{"href", href},
                        {"type", "image/tiff; application=geotiff; profile=cloud-optimized"},
                        {"roles", {"data"}},
                        {"bands", bands_of(dataset.get())}}}};
    return item;
}

}  // namespace

std::string stac_text(const fs::path& path, const fs::path& folder, const std::string& base,
                      const TilePlan& plan, const std::vector<PlannedTile>& tiles) {
    dem::prepare_gdal();
    Json items = Json::array();
    for (const PlannedTile& tile : tiles)
        items.push_back(item_of(href_of(path, folder / tile.name, base), folder, plan, tile));
    const Json collection{{"type", "FeatureCollection"},
                          {"stac_version", "1.1.0"},
                          {"features", items},
                          {"links", Json::array()}};
    return collection.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace relevo::output
