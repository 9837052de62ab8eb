#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/percent.h"
#include "base/text.h"
#include "base/units.h"
#include "dem/interpret.h"
#include "dem/remote.h"
#include "dem/tile_index_parts.h"
#include "dem/tile_reach.h"

namespace relevo::dem {
namespace {

/// Whether a name begins with a driver of GDAL's: "NETCDF:a.nc:z", "vrt://a.tif".
bool has_scheme(std::string_view name) {
    const std::size_t colon = name.find(':');
    if (colon == name.npos || colon < 2) return false;
    return std::ranges::all_of(name.substr(0, colon), [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '+' || c == '-' || c == '.';
    });
}

/// The file of a location without folder, query and ending, with what no file name has replaced.
std::string stem_of(std::string_view location) {
    if (is_remote(location)) location = location.substr(0, location.find('?'));
    while (location.ends_with('/'))
        location.remove_suffix(1);
    location = location.substr(location.find_last_of("/\\") + 1);
    if (const std::size_t dot = location.rfind('.'); dot != location.npos && dot > 0)
        location = location.substr(0, dot);
    std::string name(location);
    for (char& c : name)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == ':') c = '_';
    return name.empty() || name == ".." ? "tile" : name;
}

bool is_finite(const Extent& e) {
    return std::isfinite(e.west) && std::isfinite(e.south) && std::isfinite(e.east) &&
           std::isfinite(e.north);
}

/// Around points; NaN where one is not a number.
Extent extent_around(const std::vector<glm::dvec2>& points) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Extent extent{kInfinity, kInfinity, -kInfinity, -kInfinity};
    for (const glm::dvec2& point : points) {
        if (!std::isfinite(point.x) || !std::isfinite(point.y)) {
            constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
            return {kNone, kNone, kNone, kNone};
        }
        extent = {std::min(extent.west, point.x), std::min(extent.south, point.y),
                  std::max(extent.east, point.x), std::max(extent.north, point.y)};
    }
    return extent;
}

/// All vertices of an outline. RFC 7946, section 3.1.9: one that crosses the antimeridian is cut
/// there. Its western parts are moved a turn on where that makes one box of all parts that is much
/// narrower.
/// @param turn  in units of its CRS; 0: projected
std::vector<glm::dvec2> vertices_of(const Outline& outline, double turn) {
    std::vector<glm::dvec2> as_given, moved;
    for (const std::vector<glm::dvec2>& part : outline) {
        const Extent box = extent_around(part);
        const double east = box.west + box.east < 0 ? turn : 0;
        for (const glm::dvec2& vertex : part) {
            as_given.push_back(vertex);
            moved.emplace_back(vertex.x + east, vertex.y);
        }
    }
    const Extent a = extent_around(as_given), b = extent_around(moved);
    // Not by rounding: most outlines are as wide a turn further on.
    return b.east - b.west < a.east - a.west - turn / 4 ? moved : as_given;
}

double turn_of(const std::optional<geo::Crs>& crs) {
    return crs && crs->is_geographic() ? 2 * kPi / crs->unit_si() : 0;
}

/// Whether posts may be those of an extent, which may be rounded, turned in their CRS, or that of a
/// survey within them: their cells leave out nothing of it, and are not more than twice as wide or
/// high.
bool fills(const TilePosts& posts, Extent stated, const geo::Crs& crs) {
    constexpr double kShare = 0.02, kCells = 2;
    const Extent cells = extent_of(posts);
    const double shift =
        whole_turns(crs, (cells.west + cells.east - stated.west - stated.east) / 2);
    stated.west += shift;
    stated.east += shift;
    const glm::dvec2 size(stated.east - stated.west, stated.north - stated.south);
    const glm::dvec2 own(cells.east - cells.west, cells.north - cells.south);
    const glm::dvec2 slack =
        glm::max(kShare * size, kCells * own / glm::dvec2(posts.columns, posts.rows));
    const bool holds = cells.west <= stated.west + slack.x && cells.east >= stated.east - slack.x &&
                       cells.south <= stated.south + slack.y &&
                       cells.north >= stated.north - slack.y;
    return holds && own.x <= 2 * size.x + slack.x && own.y <= 2 * size.y + slack.y;
}

/// As many posts, north up over an extent.
TilePosts spread(const TilePosts& posts, const Extent& e) {
    const std::array<double, 6> g = {e.west, (e.east - e.west) / posts.columns, 0, e.north,
                                     0,      (e.south - e.north) / posts.rows};
    return {posts.columns, posts.rows, Affine::of_geotransform(g)};
}

}  // namespace

std::string resolved_location(const std::string& folder, const std::string& location) {
    const auto starts = [&](std::string_view scheme) {
        return location.size() > scheme.size() &&
               equal_ignoring_case(std::string_view(location).substr(0, scheme.size()), scheme);
    };
    if (starts("http://") || starts("https://")) return "/vsicurl/" + location;
    if (starts("s3://")) return "/vsis3/" + location.substr(5);
    if (starts("gs://")) return "/vsigs/" + location.substr(5);
    if (const auto path = path_of_file_uri(location)) return std::string(*path);
    if (location.starts_with('/') || has_scheme(location) || folder.empty()) return location;
    return location.starts_with("./") ? resolved_location(folder, location.substr(2))
                                      : folder + "/" + location;
}

std::string resolved_uri(const std::string& folder, const std::string& uri) {
    if (const auto path = path_of_file_uri(uri)) return percent_decoded(*path);
    if (has_scheme(uri) || uri.starts_with("/vsi") || folder.find("/vsicurl") != folder.npos)
        return resolved_location(folder, uri);
    std::string name = percent_decoded(uri);
    while (name.starts_with("./"))
        name.erase(0, 2);
    return name.starts_with('/') || folder.empty() ? name : folder + "/" + name;
}

Extent extent_of(const TilePosts& posts) {
    const double right = posts.columns - 0.5, bottom = posts.rows - 0.5;
    return extent_around({posts.affine(-0.5, -0.5), posts.affine(right, -0.5),
                          posts.affine(-0.5, bottom), posts.affine(right, bottom)});
}

TileCollector::TileCollector(const std::string& path, const geo::Crs* tiles_crs, Wanted wanted)
    : tiles_crs_(tiles_crs), wanted_(wanted) {
    index_.path = path;
    const std::size_t slash = path.rfind('/');
    folder_ = slash == path.npos ? "" : path.substr(0, std::max<std::size_t>(slash, 1));
}

void TileCollector::fail(const std::string& what) const {
    refuse(printable(index_.path), what);
}

void TileCollector::fail_row(const std::string& location, const std::string& what) const {
    fail(fmt::format("tile {}{}: {}", row_,
                     location.empty() ? "" : fmt::format(" ('{}')", printable(location)), what));
}

const geo::Crs& TileCollector::crs_of(const std::string& text) {
    if (wanted_ == Wanted::Locations) return wgs84_;
    const auto known = known_.find(text);
    if (known != known_.end()) return known->second;
    if (known_.size() == kMostCrs)
        fail(
            fmt::format("an index of tiles in more than {} different coordinate reference "
                        "systems; cut it up, for example with ogr2ogr -where",
                        kMostCrs));
    return known_.emplace(text, geo::Crs::parse(text, printable(index_.path))).first->second;
}

int TileCollector::number_of(const geo::Crs& crs) {
    const auto [number, fresh] =
        number_of_crs_.try_emplace(crs.text(), static_cast<int>(index_.crs.size()));
    if (fresh) index_.crs.push_back(crs);
    return number->second;
}

std::string TileCollector::unique_name(const std::string& location) {
    const std::string stem = stem_of(location);
    std::string name = stem;
    // Of thousands of folders each may have a dem.tif.
    for (std::size_t& next = next_number_.try_emplace(stem, 2).first->second;
         !names_.insert(name).second; ++next)
        name = fmt::format("{}_{}", stem, next);
    return name;
}

void TileCollector::begin_row(const std::string& location) {
    ++row_;
    if (trimmed(location).empty()) fail_row("", "names no file");
}

/// Refuses a place that is none.
void TileCollector::settle_crs(const std::string& location, IndexedTile& tile,
                               const geo::Crs* crs) {
    const Extent& e = tile.extent;
    if (!is_finite(e)) fail_row(location, "an outline with a coordinate that is not a number");
    if (!(e.east > e.west && e.north > e.south)) fail_row(location, "an outline without an area");
    if (!crs) return;
    const glm::dvec2 middle((e.west + e.east) / 2, (e.south + e.north) / 2);
    if (!std::isfinite(crs->to_geodetic(middle.x, middle.y).lat_rad))
        fail_row(location,
                 fmt::format("its middle is at {:.10g}, {:.10g}, which is not on the Earth in "
                             "{}; pass the right one with --crs EPSG:n",
                             middle.x, middle.y, crs->name()));
    tile.crs = number_of(*crs);
}

void TileCollector::keep(const std::string& location, IndexedTile tile) {
    tile.location = uris_ ? resolved_uri(folder_, location) : resolved_location(folder_, location);
    if (!locations_.insert(tile.location).second) {
        ++index_.repeated;
        return;
    }
    if (index_.tiles.size() == kMostTiles)
        fail(
            fmt::format("an index of more than {} tiles; cut it up, for example with ogr2ogr -spat",
                        kMostTiles));
    tile.name = unique_name(tile.location);
    index_.tiles.push_back(std::move(tile));
}

/// The box in a CRS around vertices in another one.
Extent TileCollector::extent_in(const geo::Crs& own, const std::vector<glm::dvec2>& vertices,
                                const geo::Crs& crs, const std::string& location) const {
    std::vector<glm::dvec2> points;
    const double turn = turn_of(crs), own_turn = turn_of(own);
    for (const glm::dvec2& vertex : vertices) {
        points.push_back(own.from_geodetic(crs.to_geodetic(vertex.x, vertex.y)));
        // On the turn that the outline is on.
        if (turn > 0 && own_turn > 0)
            points.back().x += own_turn * std::round(vertex.x / turn - points.back().x / own_turn);
    }
    const Extent extent = extent_around(points);
    if (!is_finite(extent) && is_finite(extent_around(vertices)))
        fail_row(location, fmt::format("its outline in {} has no place in {}; pass the right CRS "
                                       "with --crs EPSG:n",
                                       crs.name(), own.name()));
    return extent;
}

void TileCollector::add(const std::string& location, const Outline& outline,
                        const std::optional<geo::Crs>& outline_crs, const std::string& crs) {
    begin_row(location);
    if (wanted_ == Wanted::Locations) return keep(location, {});
    const std::vector<glm::dvec2> vertices = vertices_of(outline, turn_of(outline_crs));
    if (vertices.empty()) fail_row(location, "no outline, its place is unknown");
    const geo::Crs* own = !crs.empty()  ? &crs_of(crs)
                          : tiles_crs_  ? tiles_crs_
                          : own_crs_    ? &*own_crs_
                          : outline_crs ? &*outline_crs
                                        : nullptr;
    IndexedTile tile;
    if (own && outline_crs && own->text() != outline_crs->text()) {
        tile.extent = extent_in(*own, vertices, *outline_crs, location);
    } else {
        tile.extent = extent_around(vertices);
    }
    settle_crs(location, tile, own);
    keep(location, std::move(tile));
}

void TileCollector::add(const std::string& location, const TilePosts& posts, const std::string& crs,
                        const std::vector<Outline>& outlines) {
    begin_row(location);
    IndexedTile tile;
    tile.extent = extent_of(posts);
    tile.posts = posts;
    if (wanted_ == Wanted::Locations) return keep(location, std::move(tile));
    const geo::Crs& own = crs_of(crs);
    settle_crs(location, tile, &own);
    std::vector<Extent> stated;
    for (const Outline& outline : outlines)
        if (const auto vertices = vertices_of(outline, turn_of(wgs84_)); !vertices.empty())
            stated.push_back(extent_in(own, vertices, wgs84_, location));
    const auto agrees = [&](const Extent& extent) { return fills(posts, extent, own); };
    if (!stated.empty() && std::ranges::none_of(stated, agrees)) {
        constexpr std::size_t kNamed = 3;
        tile.extent = stated.front();
        tile.posts = spread(posts, tile.extent);
        tile.posts_are_near = true;
        settle_crs(location, tile, &own);
        index_.contradicting.add(stem_of(location), kNamed);
    }
    keep(location, std::move(tile));
}

TileIndex TileCollector::take(const std::string& format) {
    if (index_.tiles.empty()) fail("an index without a tile in it");
    index_.format = format;
    return std::move(index_);
}

}  // namespace relevo::dem
