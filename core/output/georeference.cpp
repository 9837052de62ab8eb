#include "output/georeference.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "dem/gdal.h"
#include "dem/gdal_open.h"
#include "dem/gdal_support.h"
#include "output/scratch_files.h"

namespace relevo::output {
namespace {

struct Free {
    void operator()(char* text) const { VSIFree(text); }
};
using Text = std::unique_ptr<char, Free>;

dem::GdalCrs crs_of(const Georeference& where) {
    dem::GdalCrs crs(where.crs);
    if (!crs.known())
        failed(fmt::format("georeference: {}: GDAL does not know this CRS", printable(where.crs)));
    return crs;
}

/// Six lines: the pixel's sides and turns, and the centre of the first pixel.
std::string world_text(const std::array<double, 6>& g) {
    const double x = g[0] + (g[1] + g[2]) / 2, y = g[3] + (g[4] + g[5]) / 2;
    std::string text;
    for (const double value : {g[1], g[4], g[2], g[5], x, y})
        text += fmt::format("{:.15g}\n", value);
    return text;
}

std::string escaped(const std::string& text) {
    const Text result(CPLEscapeString(text.c_str(), static_cast<int>(text.size()), CPLES_XML));
    return result.get();
}

/// As GDAL's "persistent auxiliary metadata".
std::string aux_text(const Georeference& where) {
    const dem::GdalCrs crs = crs_of(where);
    char* exported = nullptr;
    const char* const options[] = {"FORMAT=WKT2_2018", nullptr};
    const OGRErr error = OSRExportToWktEx(crs.handle(), &exported, options);
    const Text wkt(exported);
    if (error != OGRERR_NONE)
        failed(fmt::format("georeference: {}: GDAL has no WKT of this CRS", printable(where.crs)));
    int count = 0;
    const int* const axes = OSRGetDataAxisToSRSAxisMapping(crs.handle(), &count);
    std::string mapping;
    for (const int axis : std::span(axes, static_cast<std::size_t>(count)))
        mapping += fmt::format("{}{}", mapping.empty() ? "" : ",", axis);
    const auto& g = where.geotransform;
    return fmt::format(
        "<PAMDataset>\n  <SRS dataAxisToSRSAxisMapping=\"{}\">{}</SRS>\n"
        "  <GeoTransform>{:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}</GeoTransform>\n"
        "</PAMDataset>\n",
        mapping, escaped(wkt.get()), g[0], g[1], g[2], g[3], g[4], g[5]);
}

}  // namespace

bool holds_georeference(const std::filesystem::path& picture) {
    const std::string ending = lower(picture.extension().string());
    return ending == ".tif" || ending == ".tiff";
}

std::vector<std::filesystem::path> georeference_files(const std::filesystem::path& picture) {
    const std::string ending = picture.extension().string();
    if (holds_georeference(picture) || ending.size() < 3) return {};
    std::filesystem::path world = picture, aux = picture;
    // On file systems that distinguish them, GDAL looks for .pgw and .PGW.
    const char last = std::isupper(static_cast<unsigned char>(ending.back())) ? 'W' : 'w';
    world.replace_extension(std::string{ending[1], ending.back(), last});
    aux += ".aux.xml";
    return {world, aux};
}

std::vector<std::string> georeference_texts(const Georeference& where) {
    dem::prepare_gdal();
    const dem::GdalMessages messages;
    return {world_text(where.geotransform), aux_text(where)};
}

void write_geotiff(OutputFile& file, std::span<const std::byte> tiff, const Georeference& where) {
    dem::prepare_gdal();
    const dem::GdalMessages messages;
    const dem::GdalCrs crs = crs_of(where);
    const ScratchFiles scratch([&] { return file.open_scratch(); });
    const std::string path = scratch.path("picture.tif");
    const auto refuse = [&] {
        failed(fmt::format(
            "{}: {}: cannot be written, {}", file.who(), printable(file.path().string()),
            scratch.error() != 0 ? std::strerror(scratch.error()) : messages.failure(path)));
    };
    VSILFILE* const plain = dem::create_by_vsi(AllowedName::of_program(path));
    if (!plain) refuse();
    const bool written = VSIFWriteL(tiff.data(), 1, tiff.size(), plain) == tiff.size();
    if (VSIFCloseL(plain) != 0 || !written) refuse();
    {
        const char* const drivers[] = {"GTiff", nullptr};
        const dem::Dataset dataset = dem::open_by_gdal(AllowedName::of_program(path),
                                                       GDAL_OF_RASTER | GDAL_OF_UPDATE, drivers);
        std::array<double, 6> transform = where.geotransform;
        if (!dataset || GDALSetGeoTransform(dataset.get(), transform.data()) != CE_None ||
            GDALSetSpatialRef(dataset.get(), crs.handle()) != CE_None)
            refuse();
    }
    // What is written when it is closed may fail, too.
    if (messages.any_failure() || scratch.error() != 0 ||
        !scratch.read("picture.tif", [&](std::span<const std::byte> bytes) { file.write(bytes); }))
        refuse();
}

}  // namespace relevo::output
