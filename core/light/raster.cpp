#include "light/raster.h"

#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <span>

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include "base/error.h"
#include "base/text.h"
#include "dem/gdal_support.h"

namespace relevo::light {
namespace {

/// A folder in memory, gone with all that is in it.
class MemoryFolder {
  public:
    MemoryFolder() {
        static std::atomic<int> count = 0;
        path_ = fmt::format("/vsimem/relevo-raster-{}", count++);
        VSIMkdir(path_.c_str(), 0700);
    }
    ~MemoryFolder() { VSIRmdirRecursive(path_.c_str()); }
    MemoryFolder(const MemoryFolder&) = delete;
    MemoryFolder& operator=(const MemoryFolder&) = delete;
    std::string file(const char* name) const { return path_ + "/" + name; }

  private:
    std::string path_;
};

struct Close {
    void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, Close>;

GDALDriver* driver(const char* name) {
    GDALDriver* const found = GetGDALDriverManager()->GetDriverByName(name);
    if (!found) failed(fmt::format("light::raster: GDAL has no driver {}", name));
    return found;
}

/// From cell corners.
std::array<double, 6> geotransform(const dem::Affine& a) {
    return {a.x0 - (a.x_column + a.x_row) / 2, a.x_column, a.x_row,
            a.y0 - (a.y_column + a.y_row) / 2, a.y_column, a.y_row};
}

GDALDataType type_of(const RasterBand& band) {
    return std::holds_alternative<Array2d<float>>(band.values) ? GDT_Float32 : GDT_Byte;
}

void describe(GDALDataset& dataset, const dem::Grid& grid, const RasterFile& about) {
    std::array<double, 6> transform = geotransform(grid.affine());
    dataset.SetGeoTransform(transform.data());
    OGRSpatialReference crs;
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (crs.SetFromUserInput(grid.crs().text().c_str()) == OGRERR_NONE) dataset.SetSpatialRef(&crs);
    for (const auto& [key, value] : about.metadata)
        dataset.SetMetadataItem(key.c_str(), value.c_str());
}

/// @return whether GDAL took it
bool put(GDALRasterBand& to, const dem::Grid& grid, const RasterBand& band) {
    to.SetDescription(band.name.c_str());
    to.SetUnitType(band.unit.c_str());
    to.SetNoDataValue(type_of(band) == GDT_Byte ? 255 : std::numeric_limits<double>::quiet_NaN());
    for (const auto& [key, value] : band.metadata)
        to.SetMetadataItem(key.c_str(), value.c_str());
    return std::visit(
        [&](const auto& values) {
            const void* const first = values.data();
            return to.RasterIO(GF_Write, 0, 0, grid.columns(), grid.rows(),
                               const_cast<void*>(first), grid.columns(), grid.rows(), type_of(band),
                               0, 0, nullptr) == CE_None;
        },
        band.values);
}

/// The driver's options: ours, and over them the user's.
CPLStringList creation_options(const std::vector<std::string>& given, GDALDataType type) {
    CPLStringList options;
    options.SetNameValue("COMPRESS", "DEFLATE");
    options.SetNameValue("OVERVIEW_RESAMPLING", type == GDT_Byte ? "NEAREST" : "AVERAGE");
    options.SetNameValue("BIGTIFF", "IF_SAFER");
    for (const std::string& option : given) {
        const std::size_t equals = option.find('=');
        if (equals == std::string::npos || equals == 0)
            bad_usage(fmt::format("--co: {}: expected NAME=VALUE, such as COMPRESS=ZSTD",
                                  printable(option)));
        options.SetNameValue(option.substr(0, equals).c_str(), option.substr(equals + 1).c_str());
    }
    return options;
}

}  // namespace

void check_creation_options(const std::vector<std::string>& given) {
    dem::prepare_gdal();
    const dem::GdalMessages messages;
    if (!GDALValidateCreationOptions(driver("COG"), creation_options(given, GDT_Byte).List()))
        bad_usage(fmt::format("--co: GDAL's COG driver says: {}", messages.failure("--co")));
}

void write_raster(OutputFile& file, const dem::Grid& grid, const std::vector<RasterBand>& bands,
                  const RasterFile& about) {
    dem::prepare_gdal();
    const dem::GdalMessages messages;
    const auto refuse = [&]() {
        failed(fmt::format("{}: {}: cannot be written, {}", file.who(),
                           printable(file.path().string()),
                           messages.failure(file.path().string())));
    };
    const MemoryFolder folder;
    const std::string plain = folder.file("plain.tif"), whole = folder.file("whole.tif");
    {
        const GDALDataType type = type_of(bands.front());
        GDALDriver& cog = *driver("COG");
        const CPLStringList wanted = creation_options(about.creation_options, type);
        CPLStringList options;
        options.SetNameValue("TILED", "YES");
        options.SetNameValue("INTERLEAVE", "BAND");
        options.SetNameValue("BIGTIFF", "IF_SAFER");
        const Dataset source(driver("GTiff")->Create(plain.c_str(), grid.columns(), grid.rows(),
                                                     static_cast<int>(bands.size()), type,
                                                     options.List()));
        if (!source) refuse();
        describe(*source, grid, about);
        for (std::size_t k = 0; k < bands.size(); ++k)
            if (!put(*source->GetRasterBand(static_cast<int>(k) + 1), grid, bands[k])) refuse();
        source->FlushCache();
        const Dataset copy(
            cog.CreateCopy(whole.c_str(), source.get(), FALSE, wanted.List(), nullptr, nullptr));
        if (!copy) refuse();
    }
    // What is written when it is closed may fail, too.
    if (messages.any_failure()) refuse();
    vsi_l_offset size = 0;
    const GByte* const bytes = VSIGetMemFileBuffer(whole.c_str(), &size, FALSE);
    if (!bytes) refuse();
    file.write(std::as_bytes(std::span(bytes, static_cast<std::size_t>(size))));
    file.finish();
}

}  // namespace relevo::light
