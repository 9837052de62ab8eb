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

void describe(GDALDataset& dataset, const dem::Grid& grid, const RasterText& text, double hole) {
    std::array<double, 6> transform = geotransform(grid.affine());
    dataset.SetGeoTransform(transform.data());
    OGRSpatialReference crs;
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (crs.SetFromUserInput(grid.crs().text().c_str()) == OGRERR_NONE) dataset.SetSpatialRef(&crs);
    for (const auto& [key, value] : text.metadata)
        dataset.SetMetadataItem(key.c_str(), value.c_str());
    GDALRasterBand& band = *dataset.GetRasterBand(1);
    band.SetDescription(text.name.c_str());
    band.SetUnitType(text.unit.c_str());
    band.SetNoDataValue(hole);
}

void write_as(OutputFile& file, const dem::Grid& grid, const void* values, GDALDataType type,
              double hole, const char* resampling, const RasterText& text) {
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
        CPLStringList options;
        options.SetNameValue("COMPRESS", "LZW");
        options.SetNameValue("TILED", "YES");
        options.SetNameValue("BIGTIFF", "IF_SAFER");
        const Dataset source(driver("GTiff")->Create(plain.c_str(), grid.columns(), grid.rows(), 1,
                                                     type, options.List()));
        if (!source) refuse();
        describe(*source, grid, text, hole);
        if (source->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, grid.columns(), grid.rows(),
                                               const_cast<void*>(values), grid.columns(),
                                               grid.rows(), type, 0, 0, nullptr) != CE_None)
            refuse();
        CPLStringList cog;
        cog.SetNameValue("COMPRESS", "DEFLATE");
        cog.SetNameValue("OVERVIEW_RESAMPLING", resampling);
        cog.SetNameValue("BIGTIFF", "IF_SAFER");
        source->FlushCache();
        const Dataset copy(driver("COG")->CreateCopy(whole.c_str(), source.get(), FALSE, cog.List(),
                                                     nullptr, nullptr));
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

}  // namespace

void write_raster(OutputFile& file, const dem::Grid& grid, const Array2d<std::uint8_t>& values,
                  const RasterText& text) {
    write_as(file, grid, values.data(), GDT_Byte, 255, "NEAREST", text);
}

void write_raster(OutputFile& file, const dem::Grid& grid, const Array2d<float>& values,
                  const RasterText& text) {
    write_as(file, grid, values.data(), GDT_Float32, std::numeric_limits<double>::quiet_NaN(),
             "AVERAGE", text);
}

}  // namespace relevo::light
