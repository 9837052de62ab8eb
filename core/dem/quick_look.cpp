#include "dem/quick_look.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/text.h"
#include "base/units.h"
#include "dem/gdal.h"
#include "dem/gdal_support.h"
#include "dem/interpret.h"

namespace relevo::dem {
namespace {

/// Voids of a quick look: what is declared, and what is no height on Earth.
void mark_voids(Array2d<float>& heights_m, std::optional<double> nodata) {
    for (float& height : heights_m) {
        const bool is_void = (nodata && height == static_cast<float>(*nodata)) ||
                             std::abs(height) > 12'000 || height == -9999;
        if (is_void || !std::isfinite(height)) height = std::numeric_limits<float>::quiet_NaN();
    }
}

/// How many posts of a side are kept of `columns` by `rows`.
int step_for(int columns, int rows, int longest) {
    return std::max(1, (std::max(columns, rows) - 1) / longest + 1);
}

constexpr double kMostPostsRead = 4e8;  // that are read for a look without overviews: some seconds

/// The side of an SRTM tile with so many bytes; 0 if there is none.
int srtm_side(std::uintmax_t bytes) {
    for (const int side : {1201, 3601})
        if (bytes == 2 * static_cast<std::uintmax_t>(side) * static_cast<std::uintmax_t>(side))
            return side;
    return 0;
}

/// An SRTM tile under any name: 16-bit numbers, the most significant byte first.
std::optional<QuickLook> read_srtm(const std::string& path, int longest) {
    std::error_code unknown;
    const int side = srtm_side(std::filesystem::file_size(path, unknown));
    if (unknown || side == 0) return std::nullopt;
    InputStream file = input_stream(AllowedName(path));
    const int step = step_for(side, side, longest), kept = (side - 1) / step + 1;
    QuickLook look{Array2d<float>(kept, kept), step * kDegree_m / (side - 1),
                   step * kDegree_m / (side - 1)};
    std::vector<unsigned char> row(2 * static_cast<std::size_t>(side));
    const auto bytes = static_cast<std::streamsize>(row.size());
    for (int r = 0; r < kept; ++r) {
        file.seekg(std::streamoff{r} * step * bytes);
        if (!file.read(reinterpret_cast<char*>(row.data()), bytes))
            bad_input(fmt::format("{}: cannot be read", printable(path)));
        for (int c = 0; c < kept; ++c) {
            const unsigned char* post = &row[2 * static_cast<std::size_t>(c * step)];
            look.heights_m.at(c, r) = static_cast<std::int16_t>(post[0] << 8 | post[1]);
        }
    }
    mark_voids(look.heights_m, -32768);
    return look;
}

/// Ground between posts of the whole raster.
void set_spacing(GDALDatasetH file, QuickLook& look) {
    double t[6] = {0, 1, 0, 0, 0, -1};
    if (GDALGetGeoTransform(file, t) != CE_None) return;
    look.column_m = std::hypot(t[1], t[4]);
    look.row_m = std::hypot(t[2], t[5]);
    OGRSpatialReferenceH const crs = GDALGetSpatialRef(file);
    const double width = t[1] * GDALGetRasterXSize(file), height = t[5] * GDALGetRasterYSize(file);
    // No DEM has cells of more than a degree, and few have cells of less than a metre.
    const bool may_be_degrees = std::max(std::abs(t[0]), std::abs(t[0] + width)) <= 360 &&
                                std::max(std::abs(t[3]), std::abs(t[3] + height)) <= 90.001 &&
                                std::max(look.column_m, look.row_m) < 1;
    if (crs ? OSRIsGeographic(crs) != 0 : may_be_degrees) {
        const double middle_deg = std::clamp(t[3] + 0.5 * height, -89.0, 89.0);
        look.column_m *= kDegree_m * std::cos(radians(middle_deg));
        look.row_m *= kDegree_m;
    } else if (crs) {
        const double unit_m = OSRGetLinearUnits(crs, nullptr);
        look.column_m *= unit_m;
        look.row_m *= unit_m;
    }
}

/// Rows from the south become rows from the north.
void turn_over(Array2d<float>& heights_m) {
    for (int r = 0; r < heights_m.height() / 2; ++r)
        std::ranges::swap_ranges(heights_m.row(r), heights_m.row(heights_m.height() - 1 - r));
}

QuickLook read(GDALDatasetH file, const std::string& path, int longest,
               const GdalMessages& messages) {
    GDALRasterBandH const band = GDALGetRasterBand(file, 1);
    if (!band) bad_input(fmt::format("{}: no band of heights", printable(path)));
    const int columns = GDALGetRasterXSize(file), rows = GDALGetRasterYSize(file);
    const int step = step_for(columns, rows, longest);
    if (GDALGetOverviewCount(band) == 0 && double{1} * columns * rows > kMostPostsRead)
        bad_input(
            fmt::format("{}: {} x {} posts, expected at most {:.0f} million without overviews; "
                        "add them with gdaladdo",
                        printable(path), columns, rows, kMostPostsRead / 1e6));
    QuickLook look;
    set_spacing(file, look);
    look.column_m *= step;
    look.row_m *= step;
    look.heights_m = Array2d<float>(std::max(1, columns / step), std::max(1, rows / step));
    if (GDALRasterIO(band, GF_Read, 0, 0, columns, rows, look.heights_m.data(),
                     look.heights_m.width(), look.heights_m.height(), GDT_Float32, 0, 0) != CE_None)
        bad_input(fmt::format("{}: cannot be read, {}", printable(path), messages.failure(path)));
    int has_nodata = 0;
    const double nodata = GDALGetRasterNoDataValue(band, &has_nodata);
    mark_voids(look.heights_m, has_nodata ? std::optional(nodata) : std::nullopt);
    double t[6] = {};
    if (GDALGetGeoTransform(file, t) == CE_None && t[5] > 0) turn_over(look.heights_m);
    return look;
}

}  // namespace

QuickLook quick_look(const std::string& path, int longest) {
    if (std::optional<QuickLook> tile = read_srtm(path, longest)) return *std::move(tile);
    const GdalMessages messages;
    AllowedName opened(path);
    const Dataset dataset = open_dataset(opened);
    return read(dataset.get(), path, longest, messages);
}

}  // namespace relevo::dem
