#include "dem/memory_raster.h"

#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/allowed_name.h"
#include "base/error.h"
#include "dem/gdal.h"
#include "dem/gdal_support.h"
#include "dem/interpret.h"

namespace relevo::dem {
namespace {

std::string next_name() {
    static std::atomic<int> number{0};
    return fmt::format("/vsimem/relevo/{}/heights.tif", ++number);
}

[[noreturn]] void refuse_raster(const GdalMessages& messages, const std::string& name) {
    VSIUnlink(name.c_str());
    failed("heights: GDAL does not take them, " + messages.failure(name));
}

}  // namespace

MemoryRaster::MemoryRaster(const float* numbers, int columns, int rows, const Affine& a,
                           const Stored& stored)
    : name_(next_name()) {
    const double area = a.x_column * a.y_row - a.x_row * a.y_column;
    if (!std::isfinite(area) || area == 0 || !std::isfinite(a.x0 + a.y0))
        bad_input("heights: transform: expected finite numbers and cells with an area");
    if (a.x0 == 0.5 && std::abs(a.y0) == 0.5 && a.x_column == 1 && a.x_row == 0 &&
        a.y_column == 0 && a.y_row == 2 * a.y0)
        bad_input(
            "heights: transform: the identity, which GDAL has where it knows no place; expected "
            "coordinates of the CRS");
    allow_name(name_);  // under it the raster is opened like a file
    prepare_gdal();
    const GdalMessages messages;
    GDALDriverH const driver = GDALGetDriverByName("GTiff");
    if (!driver) refuse_raster(messages, name_);
    const Dataset file(GDALCreate(driver, name_.c_str(), columns, rows, 1, GDT_Float32, nullptr));
    std::array<double, 6> transform = a.geotransform();
    if (!file || GDALSetGeoTransform(file.get(), transform.data()) != CE_None)
        refuse_raster(messages, name_);
    GDALRasterBandH const band = GDALGetRasterBand(file.get(), 1);
    if (stored.voids_declared)
        GDALSetRasterNoDataValue(band, std::numeric_limits<double>::quiet_NaN());
    GDALSetRasterScale(band, stored.scale);
    GDALSetRasterOffset(band, stored.offset);
    GDALSetRasterUnitType(band, stored.unit.c_str());
    // GDAL's interface has no const here; it reads.
    if (GDALRasterIO(band, GF_Write, 0, 0, columns, rows, const_cast<float*>(numbers), columns,
                     rows, GDT_Float32, 0, 0) != CE_None)
        refuse_raster(messages, name_);
}

MemoryRaster::MemoryRaster(MemoryRaster&& other) noexcept
    : name_(std::exchange(other.name_, std::string())) {}

MemoryRaster::~MemoryRaster() {
    if (name_.empty()) return;
    VSIUnlink(name_.c_str());
    forget_name(name_);
}

}  // namespace relevo::dem
