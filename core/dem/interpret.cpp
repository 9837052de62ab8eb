#include "dem/interpret.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include "base/error.h"
#include "dem/gdal_support.h"
#include "dem/whole_file.h"

namespace relevo::dem {
namespace {

/// The picture that a file is, if it is one: "red, green and blue bands of 8 bits", else empty.
std::string picture_in(GDALDatasetH dataset) {
    const int bands = GDALGetRasterCount(dataset);
    bool red = false;
    bool green = false;
    bool blue = false;
    bool bytes = true;
    for (int i = 1; i <= bands; ++i) {
        const GDALRasterBandH band = GDALGetRasterBand(dataset, i);
        const GDALDataType type = GDALGetRasterDataType(band);
        if (type != GDT_Byte && type != GDT_UInt16) return {};
        const GDALColorInterp meaning = GDALGetRasterColorInterpretation(band);
        if (meaning == GCI_PaletteIndex) return "a palette of colours";
        bytes = bytes && type == GDT_Byte;
        red = red || meaning == GCI_RedBand;
        green = green || meaning == GCI_GreenBand;
        blue = blue || meaning == GCI_BlueBand;
    }
    if (red && green && blue)
        return fmt::format("red, green and blue bands of {} bits", bytes ? 8 : 16);
    // Satellite bands whose colours nobody noted. Heights do not come in threes of 256 steps.
    return bytes && bands >= 3 ? fmt::format("{} bands of 8 bits", bands) : "";
}

bool has_colour_bytes(GDALDatasetH dataset) {
    if (GDALGetRasterCount(dataset) < 3) return false;
    for (int i = 1; i <= 3; ++i)
        if (GDALGetRasterDataType(GDALGetRasterBand(dataset, i)) != GDT_Byte) return false;
    return true;
}

/// The encoding that a picture's colours may be in, by its middle.
std::optional<Encoding> encoding_in(GDALDatasetH dataset) {
    if (!has_colour_bytes(dataset)) return std::nullopt;
    const int width = std::min(256, GDALGetRasterXSize(dataset));
    const int height = std::min(256, GDALGetRasterYSize(dataset));
    const int left = (GDALGetRasterXSize(dataset) - width) / 2;
    const int top = (GDALGetRasterYSize(dataset) - height) / 2;
    const std::size_t n = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::array<std::vector<std::uint8_t>, 3> colours;
    for (int i = 0; i < 3; ++i) {
        colours[static_cast<std::size_t>(i)].resize(n);
        GdalMessages messages;
        if (GDALRasterIO(GDALGetRasterBand(dataset, i + 1), GF_Read, left, top, width, height,
                         colours[static_cast<std::size_t>(i)].data(), width, height, GDT_Byte, 0,
                         0) != CE_None)
            return std::nullopt;
    }
    return plausible_encoding(colours[0], colours[1], colours[2], width);
}

[[noreturn]] void refuse_picture(const std::string& path, GDALDatasetH dataset,
                                 const std::string& picture) {
    if (const std::optional<Encoding> encoding = encoding_in(dataset))
        refuse(path,
               fmt::format("a picture ({}) whose colours look like heights in {}; if they "
                           "are, pass --encoding {}",
                           picture, *encoding == Encoding::TerrainRgb ? "Terrain-RGB" : "Terrarium",
                           name_of(*encoding)));
    refuse(path, fmt::format("a picture ({}), expected heights; if its colours encode heights pass "
                             "--encoding terrain-rgb or terrarium, if one band holds them --band N",
                             picture));
}

std::string first_subdataset(GDALDatasetH dataset, int& count) {
    char** list = GDALGetMetadata(dataset, "SUBDATASETS");
    count = CSLCount(list) / 2;  // a name and a description each
    const char* first = CSLFetchNameValue(list, "SUBDATASET_1_NAME");
    return first ? first : "";
}

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
        north = north || std::find(kNorth.begin(), kNorth.end(), unit) != kNorth.end();
        east = east || std::find(kEast.begin(), kEast.end(), unit) != kEast.end();
    }
    return north && east;
}

}  // namespace

void CloseDataset::operator()(void* dataset) const {
    GDALClose(dataset);
}

void refuse(const std::string& path, const std::string& what) {
    bad_input(fmt::format("dem::load: {}: {}", path, what));
}

void guess(Description& about, const std::string& sentence) {
    about.assumptions.push_back(sentence);
    about.guesses.push_back(sentence);
}

namespace {

/// What GDAL calls the inside of an archive; empty where the name is not that of one.
std::string inside_of(const std::string& path) {
    const auto ends = [&](std::string_view ending) {
        return path.size() > ending.size() &&
               std::equal(ending.rbegin(), ending.rend(), path.rbegin(),
                          [](char a, unsigned char b) { return a == std::tolower(b); });
    };
    if (ends(".zip")) return "/vsizip/" + path;
    if (ends(".tar") || ends(".tgz") || ends(".tar.gz")) return "/vsitar/" + path;
    return ends(".gz") ? "/vsigzip/" + path : "";
}

Dataset gdal_open(const std::string& path) {
    return Dataset(GDALOpenEx(path.c_str(),
                              GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr,
                              nullptr, nullptr));
}

/// Opens the one raster of an archive; nothing where it is no archive.
Dataset open_archive(std::string& path) {
    const std::string inside = inside_of(path);
    if (inside.empty()) return nullptr;
    if (inside.starts_with("/vsigzip/")) {
        Dataset dataset = gdal_open(inside);
        if (dataset) path = inside;
        return dataset;
    }
    char** entries = VSIReadDirRecursive(inside.c_str());
    std::vector<std::string> rasters;
    Dataset found;
    for (char** entry = entries; entry && *entry; ++entry) {
        const std::string name = fmt::format("{}/{}", inside, *entry);
        if (name.ends_with('/')) continue;
        if (Dataset dataset = gdal_open(name)) {
            rasters.push_back(name);
            found = std::move(dataset);
        }
    }
    CSLDestroy(entries);
    if (rasters.size() > 1)
        refuse(path, fmt::format("an archive of {} rasters, expected one; name those that are "
                                 "meant, as in '{}'",
                                 rasters.size(), rasters.front()));
    if (found) path = rasters.front();
    return found;
}

}  // namespace

Dataset open_dataset(std::string& path) {
    prepare_gdal();
    std::error_code ignored;
    const bool is_folder = std::filesystem::is_directory(path, ignored);
    // Names that are no file may still mean something to GDAL: "/vsizip/...", "NETCDF:a.nc:topo".
    const bool may_be_gdals = path.starts_with("/vsi") || path.find(':') != std::string::npos;
    if (!may_be_gdals && !std::filesystem::exists(path, ignored))
        refuse(path.empty() ? "\"\"" : path, "cannot be read, no such file");
    GdalMessages messages;
    Dataset dataset = gdal_open(path);
    if (dataset) return dataset;
    if (is_folder) refuse(path, "a folder, expected a raster file; name the files in it");
    const std::string reason = messages.failure(path);
    dataset = open_archive(path);
    if (dataset) return dataset;
    if (reason.find("does not exist") != std::string::npos ||
        reason.find("No such file") != std::string::npos)
        refuse(path, "cannot be read, no such file");
    if (reason.empty() || reason.find("not recognized as") != std::string::npos)
        refuse(path, "not a raster in any format that GDAL reads");
    refuse(path, fmt::format("cannot be opened as a raster, {}; the file is damaged or incomplete",
                             reason));
}

void refuse_if_short(const std::string& path, GDALDatasetH dataset, const Description& about) {
    char** files = GDALGetFileList(dataset);
    const std::filesystem::path file = files && *files ? *files : path;
    CSLDestroy(files);
    std::error_code unknown;
    const std::uint64_t size = std::filesystem::file_size(file, unknown);
    if (unknown) return;
    std::uint64_t least = 0;
    if (about.driver == "netCDF") least = classic_netcdf_size(file);
    // Raw cells; a compressed file may be shorter. GDAL takes what is missing for zeros not yet
    // written.
    if (about.driver == "ENVI" && !GDALGetMetadataItem(dataset, "COMPRESSION", "IMAGE_STRUCTURE")) {
        const GDALDataType type = GDALGetRasterDataType(GDALGetRasterBand(dataset, about.band));
        least = static_cast<std::uint64_t>(GDALGetRasterXSize(dataset)) *
                static_cast<std::uint64_t>(GDALGetRasterYSize(dataset)) *
                static_cast<std::uint64_t>(GDALGetRasterCount(dataset)) *
                static_cast<std::uint64_t>(GDALGetDataTypeSizeBytes(type));
    }
    if (size < least)
        refuse(path, fmt::format("cut short, expected {} bytes but got {}; the file is damaged or "
                                 "incomplete",
                                 least, size));
}

int chosen_band(const std::string& path, GDALDatasetH dataset, const LoadOptions& options,
                Description& about) {
    const int wanted = options.band;
    const int bands = GDALGetRasterCount(dataset);
    if (bands == 0) {
        int count = 0;
        const std::string first = first_subdataset(dataset, count);
        if (count == 0) refuse(path, "has no raster band");
        refuse(path,
               fmt::format("holds {} rasters, expected one; name the one that is meant, as in "
                           "'{}'",
                           count, first));
    }
    if (wanted < 0 || wanted > bands)
        refuse(path, fmt::format("band, expected 1 to {} but got {}; --band counts from 1", bands,
                                 wanted));
    if (options.encoding != Encoding::None) {
        const GDALRasterBandH first = GDALGetRasterBand(dataset, 1);
        if (!has_colour_bytes(dataset))
            refuse(path, fmt::format("--encoding {}, expected red, green and blue bands of 8 bits "
                                     "but got {} of {}",
                                     name_of(options.encoding),
                                     bands == 1 ? "one band" : fmt::format("{} bands", bands),
                                     GDALGetDataTypeName(GDALGetRasterDataType(first))));
        about.assumptions.push_back(
            fmt::format("colours are heights in {}, as given",
                        options.encoding == Encoding::TerrainRgb ? "Terrain-RGB" : "Terrarium"));
    } else if (wanted == 0) {
        if (const std::string picture = picture_in(dataset); !picture.empty())
            refuse_picture(path, dataset, picture);
        const bool alpha = bands == 2 && GDALGetRasterColorInterpretation(
                                             GDALGetRasterBand(dataset, 2)) == GCI_AlphaBand;
        if (bands > 1 && !alpha)
            about.assumptions.push_back(
                fmt::format("band 1 of {} holds the heights; --band N takes another", bands));
    }
    int pages = 0;
    first_subdataset(dataset, pages);
    if (pages > 1)
        about.assumptions.push_back(
            fmt::format("the first of {} rasters in the file is taken", pages));
    about.bands = bands;
    return wanted == 0 ? 1 : wanted;
}

namespace {

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
    return Affine{g[0] + (g[1] + g[2]) / 2, g[1], g[2], g[3] + (g[4] + g[5]) / 2, g[4], g[5]};
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
        char* wkt = nullptr;
        constexpr std::array<const char*, 2> kForm = {"FORMAT=WKT2_2019", nullptr};
        if (OSRExportToWktEx(srs, &wkt, kForm.data()) == OGRERR_NONE && wkt) found.wkt = wkt;
        CPLFree(wkt);
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

}  // namespace

Georeference georeference(const std::string& path, GDALDatasetH dataset, const LoadOptions& options,
                          Description& about) {
    const int columns = GDALGetRasterXSize(dataset);
    const int rows = GDALGetRasterYSize(dataset);
    const std::string who = fmt::format("dem::load: {}", path);
    std::optional<Affine> affine;
    if (!options.bounds) affine = affine_in(path, dataset);
    if (!affine && !options.bounds) {
        if (GDALGetGCPCount(dataset) > 0)
            refuse(path,
                   "georeferenced by control points only, expected a grid; make one with "
                   "gdalwarp");
        const std::optional<WebTile> tile = web_tile(path);
        if (tile && options.crs.empty() && options.encoding != Encoding::None) {
            guess(about,
                  "the place is that of the web map tile that the path names, zoom/x/y with y from "
                  "the north");
            return {affine_of(*tile, columns, rows), geo::Crs::parse("EPSG:3857", who)};
        }
        refuse(path,
               "no georeference, it does not say where its posts are; give its edges in degrees "
               "with --bounds W,S,E,N");
    }

    const FileCrs in_file = crs_in(path, dataset);
    geo::Crs crs;
    if (!options.crs.empty()) {
        crs = geo::Crs::parse(options.crs, who);
        about.assumptions.push_back(fmt::format("the CRS is {}, as given{}", crs.name(),
                                                in_file.wkt.empty() ? "" : ", not the file's own"));
    } else if (!in_file.wkt.empty()) {
        crs = defined_crs(in_file, who, about);
    } else if (has_cf_lat_lon(dataset)) {
        about.assumptions.push_back(
            "the CRS is WGS 84: the file has latitude and longitude but names no datum; --crs sets "
            "another");
    } else if (!options.bounds) {
        if (!like_degrees(*affine, columns, rows))
            refuse(path,
                   fmt::format("no coordinate reference system{}; pass --crs EPSG:n",
                               in_file.reason.empty() ? "" : fmt::format(" ({})", in_file.reason)));
        guess(about,
              "the CRS is WGS 84: the file names none, and its coordinates are like degrees; --crs "
              "sets another");
    }
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
        refuse(path, fmt::format("its coordinates are like degrees, but {} counts in {}; pass the "
                                 "right CRS with --crs, perhaps EPSG:4326",
                                 crs.name(), crs.unit_name()));
    }
    return {*affine, std::move(crs)};
}

void settle_unit(const std::string& path, GDALRasterBandH band, const geo::Crs& crs,
                 const LoadOptions& options, Description& about) {
    if (options.encoding != Encoding::None && options.unit.empty()) {
        about.unit_source = UnitSource::Encoding;
        return;
    }
    const std::string& given = options.unit;
    std::string word = GDALGetRasterUnitType(band);
    if (means_no_unit(word)) word.clear();
    if (!given.empty()) {
        about.unit = parse_unit(given, "--unit");
        about.unit_source = UnitSource::Option;
        about.assumptions.push_back(fmt::format("heights are in {}, as given", about.unit.name));
    } else if (!word.empty()) {
        const std::optional<Unit> unit = known_unit(word);
        if (!unit)
            refuse(path,
                   fmt::format("band {} is in \"{}\", expected a unit of height; if these are "
                               "heights, pass --unit m, ft, us-ft, cm or km",
                               about.band, word));
        about.unit = *unit;
        about.unit_source = UnitSource::Band;
    } else if (crs.vertical()) {
        about.unit = unit_of(crs.vertical()->unit_m, crs.vertical()->unit_name);
        about.unit_source = UnitSource::VerticalCrs;
    } else {
        const bool feet = !crs.is_geographic() && crs.unit_si() < 0.5;
        about.assumptions.push_back(
            fmt::format("heights are in metres, as neither the band nor a vertical CRS says{}; "
                        "--unit sets another unit",
                        feet ? fmt::format(" (distances are in {})", crs.unit_name()) : ""));
    }
}

void settle_vertical_datum(GDALDatasetH dataset, const geo::Crs& crs, Description& about) {
    if (crs.vertical()) {
        about.vertical_datum =
            crs.vertical()->code.empty()
                ? crs.vertical()->name
                : fmt::format("{} ({})", crs.vertical()->name, crs.vertical()->code);
        if (crs.vertical()->name == "ellipsoidal height") return;
    } else if (const char* dted = GDALGetMetadataItem(dataset, "DTED_VerticalDatum", nullptr)) {
        // MIL-PRF-89020B, data set identification record, "Vertical Datum".
        const std::string code = dted;
        about.vertical_datum = code == "E96" ? "EGM96" : code == "MSL" ? "mean sea level" : code;
    }
    about.assumptions.push_back(
        about.vertical_datum.empty()
            ? std::string("heights are placed as ellipsoidal ones: the file does not say what they "
                          "are above")
            : fmt::format("heights are above {} and are placed as ellipsoidal ones: the geoid is "
                          "not added",
                          about.vertical_datum));
}

}  // namespace relevo::dem
