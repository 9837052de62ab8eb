#include "dem/band_over.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gdal.h>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/text.h"
#include "dem/gdal_support.h"
#include "dem/interpret.h"

namespace relevo::dem {
namespace {

constexpr int kNet = 16;  // posts between places that are computed
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Cells of a band, all of them or picks of overviews.
struct Cells {
    Array2d<float> values;
    glm::dvec2 shrunk{1};  // cells of the file to one here
};

Cells read_cells(GDALRasterBandH band, const std::string& path) {
    const int columns = GDALGetRasterBandXSize(band), rows = GDALGetRasterBandYSize(band);
    const double all = double{1} * columns * rows;
    const double share = std::sqrt(std::min(1.0, static_cast<double>(kMostOver) / all));
    Cells cells;
    cells.values = Array2d<float>(std::max(1, static_cast<int>(columns * share)),
                                  std::max(1, static_cast<int>(rows * share)));
    cells.shrunk = {double{1} * columns / cells.values.width(),
                    double{1} * rows / cells.values.height()};
    const GdalMessages messages;
    if (GDALRasterIO(band, GF_Read, 0, 0, columns, rows, cells.values.data(), cells.values.width(),
                     cells.values.height(), GDT_Float32, 0, 0) != CE_None) {
        const std::string reason = messages.failure(path);
        refuse(path, fmt::format("cannot be read, {}{}", reason, remedy_for(reason)));
    }
    int has_nodata = 0;
    const auto nodata = static_cast<float>(GDALGetRasterNoDataValue(band, &has_nodata));
    int has_scale = 0, has_offset = 0;
    const double scale = GDALGetRasterScale(band, &has_scale),
                 offset = GDALGetRasterOffset(band, &has_offset);
    const bool scaled = (has_scale && scale != 1) || (has_offset && offset != 0);
    for (float& value : cells.values) {
        if (has_nodata && value == nodata) value = kNaN;
        if (scaled)
            value = static_cast<float>(value * (has_scale ? scale : 1) + (has_offset ? offset : 0));
    }
    return cells;
}

/// Where posts of the DEM lie among the cells of the raster.
class Places {
  public:
    Places(const Grid& dem, const Grid& raster)
        : dem_(dem), raster_(raster), same_(dem.crs().text() == raster.crs().text()) {
        if (same_) return;
        net_ = Array2d<glm::dvec2>((dem.columns() - 1) / kNet + 2, (dem.rows() - 1) / kNet + 2);
        parallel_for(0, net_.height(), 1, [&](int first, int last) {
            for (int row = first; row < last; ++row)
                for (int column = 0; column < net_.width(); ++column)
                    net_.at(column, row) = raster.post(dem.place(column * kNet, row * kNet));
        });
    }

    glm::dvec2 operator()(double column, double row) const {
        if (same_) return raster_.affine().inverse(dem_.affine()(column, row));
        const double x = column / kNet, y = row / kNet;
        const int left = std::min(static_cast<int>(x), net_.width() - 2),
                  above = std::min(static_cast<int>(y), net_.height() - 2);
        const double u = x - left, v = y - above;
        const auto at = [&](int i, int j) { return net_.at(left + i, above + j); };
        return (1 - v) * ((1 - u) * at(0, 0) + u * at(1, 0)) +
               v * ((1 - u) * at(0, 1) + u * at(1, 1));
    }

  private:
    const Grid& dem_;
    const Grid& raster_;
    bool same_;
    Array2d<glm::dvec2> net_;
};

/// Between four cells, those without a value left out; none where the nearest has none.
float between(const Array2d<float>& cells, const glm::dvec2& at) {
    const int width = cells.width(), height = cells.height();
    if (!(at.x >= -0.5 && at.y >= -0.5 && at.x <= width - 0.5 && at.y <= height - 0.5)) return kNaN;
    const auto value = [&](int column, int row) {
        return cells.at(std::clamp(column, 0, width - 1), std::clamp(row, 0, height - 1));
    };
    if (std::isnan(value(static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y)))))
        return kNaN;
    const int left = static_cast<int>(std::floor(at.x)), above = static_cast<int>(std::floor(at.y));
    const double u = at.x - left, v = at.y - above;
    double sum = 0, weights = 0;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const float cell = value(left + i, above + j);
            if (std::isnan(cell)) continue;
            const double weight = (i ? u : 1 - u) * (j ? v : 1 - v);
            sum += weight * double{cell};
            weights += weight;
        }
    return weights > 0 ? static_cast<float>(sum / weights) : kNaN;
}

float nearest(const Array2d<float>& cells, const glm::dvec2& at) {
    const double column = std::floor(at.x + 0.5), row = std::floor(at.y + 0.5);
    if (!(column >= 0 && row >= 0 && column < cells.width() && row < cells.height())) return kNaN;
    return cells.at(static_cast<int>(column), static_cast<int>(row));
}

std::vector<std::array<std::uint8_t, 4>> colors_of(GDALRasterBandH band) {
    std::vector<std::array<std::uint8_t, 4>> colors;
    const GDALColorTableH table = GDALGetRasterColorTable(band);
    for (int k = 0; table && k < std::min(GDALGetColorEntryCount(table), 256); ++k) {
        GDALColorEntry entry{};
        GDALGetColorEntryAsRGB(table, k, &entry);
        colors.push_back({static_cast<std::uint8_t>(entry.c1), static_cast<std::uint8_t>(entry.c2),
                          static_cast<std::uint8_t>(entry.c3),
                          static_cast<std::uint8_t>(entry.c4)});
    }
    return colors;
}

}  // namespace

BandOver read_band_over(const Grid& grid, const std::string& path, int number) {
    std::string opened = path;
    const Dataset dataset = open_dataset(opened);
    const int bands = GDALGetRasterCount(dataset.get());
    if (number < 1 || number > bands)
        refuse(path, fmt::format("band {}: expected 1 to {}", number, bands));
    Description unused;
    const Georeference where = georeference(opened, dataset.get(), {}, unused);
    const GDALRasterBandH band = GDALGetRasterBand(dataset.get(), number);
    const Cells cells = read_cells(band, path);
    const Grid raster(GDALGetRasterXSize(dataset.get()), GDALGetRasterYSize(dataset.get()),
                      where.affine, where.crs);
    const Places places(grid, raster);

    BandOver over;
    over.name = GDALGetDescription(band);
    over.unit = GDALGetRasterUnitType(band);
    over.whole = GDALGetRasterDataType(band) == GDT_Byte;
    over.colors = colors_of(band);
    const double share = std::sqrt(
        std::min(1.0, static_cast<double>(kMostOver) / (double{1} * grid.columns() * grid.rows())));
    over.values = Array2d<float>(std::max(1, static_cast<int>(grid.columns() * share)),
                                 std::max(1, static_cast<int>(grid.rows() * share)));
    const glm::dvec2 last(grid.columns() - 1, grid.rows() - 1),
        to_last(std::max(1, over.values.width() - 1), std::max(1, over.values.height() - 1));
    parallel_for(0, over.values.height(), 16, [&](int first, int end) {
        for (int row = first; row < end; ++row)
            for (int column = 0; column < over.values.width(); ++column) {
                const glm::dvec2 post = last * glm::dvec2(column, row) / to_last;
                const glm::dvec2 at = (places(post.x, post.y) + 0.5) / cells.shrunk - 0.5;
                over.values.at(column, row) =
                    over.whole ? nearest(cells.values, at) : between(cells.values, at);
            }
    });
    if (std::all_of(over.values.begin(), over.values.end(), [](float v) { return std::isnan(v); }))
        refuse(path, "has no value over the DEM, expected a raster that lies there");
    return over;
}

}  // namespace relevo::dem
