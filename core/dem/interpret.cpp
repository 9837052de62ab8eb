#include "dem/interpret.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "dem/gdal.h"
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

}  // namespace

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
               fmt::format("holds {} rasters, expected one; name one, as in '{}'", count, first));
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
                fmt::format("band 1 of {} holds the heights; --band N selects another", bands));
    }
    int pages = 0;
    first_subdataset(dataset, pages);
    if (pages > 1)
        about.assumptions.push_back(
            fmt::format("the first of {} rasters in the file is used", pages));
    about.bands = bands;
    return wanted == 0 ? 1 : wanted;
}

namespace {

/// The file's word for the unit of a band: GDAL's, else that of the metadata in which GDAL leaves
/// it. Empty where there is none.
std::string unit_word(GDALRasterBandH band) {
    const auto has = [](const char* word) { return word && !means_no_unit(word); };
    if (const char* const word = GDALGetRasterUnitType(band); has(word)) return word;
    for (const char* key : {"GRIB_UNIT", "units", "unit"})
        if (const char* const word = GDALGetMetadataItem(band, key, nullptr); has(word))
            return word;
    // FITS Standard 4.0, section 4.4.2.5: of the values.
    const char* const word = GDALGetMetadataItem(GDALGetBandDataset(band), "BUNIT", nullptr);
    return has(word) ? word : "";
}

}  // namespace

void settle_unit(const std::string& path, GDALRasterBandH band, const geo::Crs& crs,
                 const LoadOptions& options, Description& about) {
    constexpr std::size_t kLongestUnit = 40;  // of a damaged file it may be anything
    if (options.encoding != Encoding::None && options.unit.empty()) {
        about.unit_source = UnitSource::Encoding;
        return;
    }
    const std::string& given = options.unit;
    const std::string word = unit_word(band);
    if (!given.empty()) {
        about.unit = parse_unit(given, "--unit");
        about.unit_source = UnitSource::Option;
        about.assumptions.push_back(fmt::format("heights are in {}, as given", about.unit.name));
    } else if (!word.empty()) {
        const std::optional<Unit> unit = known_unit(word);
        if (!unit)
            refuse(path,
                   fmt::format("band {} is in \"{}\", expected a unit of height; if these are "
                               "heights, pass --unit m, ft, us-ft, cm, mm, dm or km",
                               about.band, word.substr(0, kLongestUnit)));
        about.unit = *unit;
        about.unit_source = UnitSource::Band;
    } else if (crs.vertical()) {
        about.unit = unit_of(crs.vertical()->unit_m, crs.vertical()->unit_name);
        about.unit_source = UnitSource::VerticalCrs;
    } else {
        const bool feet = !crs.is_geographic() && crs.unit_si() < 0.5;
        about.assumptions.push_back(fmt::format(
            "heights are taken as metres: the file names no unit{}; --unit sets another",
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
    } else if (about.driver == "SRTMHGT") {
        // SRTM Collection User Guide, USGS 2015, "Vertical datum"; others keep to it.
        about.vertical_datum = "EGM96";
        about.assumptions.emplace_back(
            "heights are above mean sea level (EGM96, as in all .hgt files) and are taken as "
            "ellipsoidal: the geoid is not added");
        return;
    }
    about.assumptions.push_back(
        about.vertical_datum.empty()
            ? std::string("heights are taken as ellipsoidal: the file names no vertical datum")
            : fmt::format(
                  "heights are above {} and are taken as ellipsoidal: the geoid is not added",
                  about.vertical_datum));
}

}  // namespace relevo::dem
