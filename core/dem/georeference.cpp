#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/error.h"
#include "dem/gdal.h"
#include "dem/gdal_support.h"
#include "dem/interpret.h"

namespace relevo::dem {
namespace {

/// Whether a netCDF file has axes of latitude and longitude by CF's own words, whatever their names
/// (CF conventions 1.10, sections 4.1 and 4.2). COARDS and GMT files say no more than that.
bool has_cf_lat_lon(GDALDatasetH dataset) {
    constexpr std::array kNorth = {"degrees_north", "degree_north", "degree_N",
                                   "degrees_N",     "degreeN",      "degreesN"};
    constexpr std::array kEast = {"degrees_east", "degree_east", "degree_E",
                                  "degrees_E",    "degreeE",     "degreesE"};
    bool north = false;
    bool east = false;
    for (char** item = GDALGetMetadata(dataset, nullptr); item && *item; ++item) {
        const std::string_view text = *item;
        const std::size_t at = text.find("#units=");
        if (at == std::string_view::npos) continue;
        const std::string_view unit = text.substr(at + 7);
        north = north || contains(kNorth, unit);
        east = east || contains(kEast, unit);
    }
    return north && east;
}

/// The file's own cells, if it says where they are.
std::optional<Affine> affine_in(const std::string& path, GDALDatasetH dataset) {
    std::array<double, 6> g{};
    const bool found = GDALGetGeoTransform(dataset, g.data()) == CE_None;
    // What drivers give back for want of anything better.
    const bool identity =
        g[0] == 0 && g[1] == 1 && g[2] == 0 && g[3] == 0 && g[4] == 0 && std::abs(g[5]) == 1;
    if (!found || identity) return std::nullopt;
    const double area = g[1] * g[5] - g[2] * g[4];
    if (!std::isfinite(area) || area == 0 || !std::isfinite(g[0] + g[3]))
        refuse(path, "a georeference in which the cells have no area; the file is damaged");
    // GDAL's coordinates are those of cell corners, whatever AREA_OR_POINT says.
    return Affine::of_geotransform(g);
}

/// What a file says of its CRS.
struct FileCrs {
    std::string wkt;     // empty: nothing
    std::string reason;  // why GDAL could make nothing of it, where it says so
    std::string name;    // of one that is not bound to the Earth
};

FileCrs crs_in(const std::string& path, GDALDatasetH dataset) {
    FileCrs found;
    GdalMessages messages;  // of keys that make no CRS; what counts is whether one comes out
    if (OGRSpatialReferenceH srs = GDALGetSpatialRef(dataset)) {
        found.wkt = wkt_of(srs);
        const char* name = OSRIsLocal(srs) ? OSRGetName(srs) : nullptr;
        found.name = name ? name : "";
    }
    found.reason = messages.failure(path);
    return found;
}

/// The CRS that a file defines. GeoTIFF keys that GDAL cannot resolve leave only their name, which
/// often is that of a known CRS.
geo::Crs defined_crs(const FileCrs& in_file, const std::string& who, Description& about) {
    try {
        return geo::Crs::parse(in_file.wkt, who);
    } catch (const Error&) {
        if (in_file.name.empty()) throw;
        try {
            geo::Crs crs = geo::Crs::parse(in_file.name, who);
            guess(about, fmt::format("the CRS is {}, by its name: the file does not define it; "
                                     "--crs sets another",
                                     crs.name()));
            return crs;
        } catch (const Error&) {
        }
        throw;
    }
}

/// Whether cells like these are counted in degrees and not in metres: small, and all on the globe.
bool like_degrees(const Affine& cells, int columns, int rows) {
    const glm::dvec2 first = cells(-0.5, -0.5);
    const glm::dvec2 last = cells(columns - 0.5, rows - 0.5);
    const auto globe = [](const glm::dvec2& point) {
        return point.x >= -180.5 && point.x <= 360.5 && std::abs(point.y) <= 90.001;
    };
    return std::max(std::abs(cells.x_column), std::abs(cells.y_row)) <= 0.25 && globe(first) &&
           globe(last);
}

/// The CRS that a file says, or that is taken for what it leaves out; WGS 84 where nothing tells.
/// @param affine  the file's; none where --bounds replaces it
geo::Crs crs_of(const std::string& path, GDALDatasetH dataset, const std::optional<Affine>& affine,
                const LoadOptions& options, Description& about) {
    const std::string& who = path;
    const FileCrs in_file = crs_in(path, dataset);
    if (!options.crs.empty()) {
        geo::Crs crs = geo::Crs::parse(options.crs, who);
        about.assumptions.push_back(fmt::format("the CRS is {}, as given{}", crs.name(),
                                                in_file.wkt.empty() ? "" : ", not the file's own"));
        return crs;
    }
    if (!in_file.wkt.empty()) return defined_crs(in_file, who, about);
    if (has_cf_lat_lon(dataset)) {
        about.assumptions.push_back(
            "the CRS is WGS 84: the file has latitude and longitude but names no datum; --crs sets "
            "another");
    } else if (affine) {
        if (!like_degrees(*affine, GDALGetRasterXSize(dataset), GDALGetRasterYSize(dataset)))
            refuse(path,
                   fmt::format("does not say its coordinate system{}; add --crs, for example "
                               "EPSG:32632 (UTM 32 N)",
                               in_file.reason.empty() ? "" : fmt::format(" ({})", in_file.reason)));
        guess(about,
              "the CRS is WGS 84: the file names none, and its coordinates look like degrees; "
              "--crs sets another");
    }
    return {};
}

/// The place of a file without a grid of its own: of a web map tile, by its path.
Georeference place_by_name(const std::string& path, GDALDatasetH dataset,
                           const LoadOptions& options, Description& about) {
    if (GDALGetGCPCount(dataset) > 0)
        refuse(path,
               "georeferenced by control points only, expected a grid; make one with "
               "gdalwarp");
    const std::optional<WebTile> tile = web_tile(path);
    if (!tile || !options.crs.empty() || options.encoding == Encoding::None)
        refuse(path,
               "no georeference, it does not say where its posts are; give its edges in degrees "
               "with --bounds W,S,E,N");
    guess(about,
          "the place is that of the web map tile that the path names, zoom/x/y with y from "
          "the north");
    return {affine_of(*tile, GDALGetRasterXSize(dataset), GDALGetRasterYSize(dataset)),
            geo::Crs::parse("EPSG:3857", path)};
}

}  // namespace

Georeference georeference(const std::string& path, GDALDatasetH dataset, const LoadOptions& options,
                          Description& about) {
    const int columns = GDALGetRasterXSize(dataset);
    const int rows = GDALGetRasterYSize(dataset);
    std::optional<Affine> affine;
    if (!options.bounds) affine = affine_in(path, dataset);
    if (!affine && !options.bounds) return place_by_name(path, dataset, options, about);

    geo::Crs crs = crs_of(path, dataset, affine, options, about);
    if (options.bounds) {
        const Bounds& b = *options.bounds;
        affine = affine_of(b, crs, columns, rows);
        if (!std::isfinite(affine->x0 + affine->y0 + affine->x_column + affine->y_row))
            refuse(path, fmt::format("--bounds {:g},{:g},{:g},{:g} are not within {}; pass the "
                                     "right CRS with --crs EPSG:n",
                                     b.west_deg, b.south_deg, b.east_deg, b.north_deg, crs.name()));
        about.assumptions.push_back(
            fmt::format("its edges are {:g} and {:g} degrees east, {:g} and {:g} north, as given",
                        b.west_deg, b.east_deg, b.south_deg, b.north_deg));
    } else if (!crs.is_geographic() && like_degrees(*affine, columns, rows) &&
               std::abs(affine->x_column) < 0.05) {
        refuse(path, fmt::format("its coordinates look like degrees, but the unit of {} is {}; "
                                 "pass the right CRS with --crs, perhaps EPSG:4326",
                                 crs.name(), crs.unit_name()));
    }
    return {*affine, std::move(crs)};
}

}  // namespace relevo::dem
