#include "dem/interpret.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include "base/error.h"
#include "dem/gdal_support.h"
#include "dem/whole_file.h"

namespace relevo::dem {
namespace {

/// The picture that a file is, if it is one: "red, green and blue bands", else empty.
std::string picture_in(GDALDatasetH dataset) {
    const int bands = GDALGetRasterCount(dataset);
    bool red = false;
    bool green = false;
    bool blue = false;
    for (int i = 1; i <= bands; ++i) {
        const GDALRasterBandH band = GDALGetRasterBand(dataset, i);
        if (GDALGetRasterDataType(band) != GDT_Byte) return {};
        const GDALColorInterp meaning = GDALGetRasterColorInterpretation(band);
        if (meaning == GCI_PaletteIndex) return "a palette of colours";
        red = red || meaning == GCI_RedBand;
        green = green || meaning == GCI_GreenBand;
        blue = blue || meaning == GCI_BlueBand;
    }
    return red && green && blue ? "red, green and blue bands of 8 bits" : "";
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

Dataset open_dataset(const std::string& path) {
    prepare_gdal();
    std::error_code ignored;
    const bool is_folder = std::filesystem::is_directory(path, ignored);
    // Names that are no file may still mean something to GDAL: "/vsizip/...", "NETCDF:a.nc:topo".
    const bool may_be_gdals = path.starts_with("/vsi") || path.find(':') != std::string::npos;
    if (!may_be_gdals && !std::filesystem::exists(path, ignored))
        refuse(path.empty() ? "\"\"" : path, "cannot be read, no such file");
    GdalMessages messages;
    Dataset dataset(GDALOpenEx(path.c_str(),
                               GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr,
                               nullptr, nullptr));
    if (dataset) return dataset;
    if (is_folder) refuse(path, "a folder, expected a raster file; name the files in it");
    const std::string reason = messages.failure(path);
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

int chosen_band(const std::string& path, GDALDatasetH dataset, int wanted, Description& about) {
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
    if (wanted == 0) {
        if (const std::string picture = picture_in(dataset); !picture.empty())
            refuse(path, fmt::format("a picture ({}), expected heights; --band N takes band N as "
                                     "heights all the same",
                                     picture));
        if (bands > 1)
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

Affine georeference(const std::string& path, GDALDatasetH dataset) {
    std::array<double, 6> g{};
    const bool found = GDALGetGeoTransform(dataset, g.data()) == CE_None;
    // What drivers give back for want of anything better.
    const bool identity =
        g[0] == 0 && g[1] == 1 && g[2] == 0 && g[3] == 0 && g[4] == 0 && std::abs(g[5]) == 1;
    if (!found || identity) {
        if (GDALGetGCPCount(dataset) > 0)
            refuse(path,
                   "georeferenced by control points only, expected a grid; make one with "
                   "gdalwarp");
        refuse(path,
               "no georeference, it does not say where its posts are; give it one with "
               "gdal_translate -a_ullr W N E S -a_srs EPSG:n, or a world file beside it");
    }
    const double area = g[1] * g[5] - g[2] * g[4];
    if (!std::isfinite(area) || area == 0 || !std::isfinite(g[0] + g[3]))
        refuse(path, "a georeference in which the cells have no area; the file is damaged");
    // GDAL's coordinates are those of cell corners, whatever AREA_OR_POINT says.
    return {g[0] + (g[1] + g[2]) / 2, g[1], g[2], g[3] + (g[4] + g[5]) / 2, g[4], g[5]};
}

geo::Crs crs_of(const std::string& path, GDALDatasetH dataset, const std::string& given,
                Description& about) {
    std::string in_file;
    {
        GdalMessages messages;  // of keys that make no CRS; what counts is whether one comes out
        if (OGRSpatialReferenceH srs = GDALGetSpatialRef(dataset)) {
            char* wkt = nullptr;
            constexpr std::array<const char*, 2> kForm = {"FORMAT=WKT2_2019", nullptr};
            if (OSRExportToWktEx(srs, &wkt, kForm.data()) == OGRERR_NONE && wkt) in_file = wkt;
            CPLFree(wkt);
        }
    }
    const std::string who = fmt::format("dem::load: {}", path);
    if (!given.empty()) {
        const geo::Crs crs = geo::Crs::parse(given, who);
        about.assumptions.push_back(fmt::format("the CRS is {}, as given{}", crs.name(),
                                                in_file.empty() ? "" : ", not the file's own"));
        return crs;
    }
    if (in_file.empty() && has_cf_lat_lon(dataset)) {
        about.assumptions.push_back(
            "the CRS is WGS 84: the file has latitude and longitude but names no datum; --crs sets "
            "another");
        return geo::Crs();
    }
    if (in_file.empty()) refuse(path, "no coordinate reference system; pass --crs EPSG:n");
    return geo::Crs::parse(in_file, who);
}

void settle_unit(const std::string& path, GDALRasterBandH band, const geo::Crs& crs,
                 const std::string& given, Description& about) {
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
