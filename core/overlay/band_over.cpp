#include "overlay/band_over.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/text.h"
#include "base/units.h"
#include "dem/gdal.h"
#include "dem/gdal_support.h"
#include "dem/interpret.h"
#include "dem/places_over.h"

namespace relevo::overlay {
namespace {

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
    const dem::GdalMessages messages;
    if (GDALRasterIO(band, GF_Read, 0, 0, columns, rows, cells.values.data(), cells.values.width(),
                     cells.values.height(), GDT_Float32, 0, 0) != CE_None)
        messages.refuse(path, "cannot be read");
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

/// Whether the last cells of a row lie beside its first ones, around the Earth.
bool goes_round(const dem::Grid& raster) {
    const dem::Affine& affine = raster.affine();
    const double turn = 2 * kPi / raster.crs().unit_si();
    return raster.crs().is_geographic() && affine.x_row == 0 && affine.y_column == 0 &&
           std::abs(std::abs(affine.x_column) * raster.columns() - turn) <
               0.01 * std::abs(affine.x_column);
}

/// Between four cells, those without a value left out; none where the nearest has none.
/// @param round  the last column lies beside the first
float between(const Array2d<float>& cells, const glm::dvec2& at, bool round) {
    const int width = cells.width(), height = cells.height();
    if (!(at.x >= -0.5 && at.y >= -0.5 && at.x <= width - 0.5 && at.y <= height - 0.5)) return kNaN;
    const auto value = [&](int column, int row) {
        column = round ? (column + width) % width : std::clamp(column, 0, width - 1);
        return cells.at(column, std::clamp(row, 0, height - 1));
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

float nearest_cell(const Array2d<float>& cells, const glm::dvec2& at) {
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

dem::Georeference placed(const std::string& path, const std::string& opened, GDALDatasetH dataset) {
    std::array<double, 6> transform{};
    if (GDALGetGeoTransform(dataset, transform.data()) != CE_None && GDALGetGCPCount(dataset) == 0)
        dem::refuse(
            path,
            "the raster has no georeference, its place on the ground is unknown; add one with "
            "gdal_translate -a_srs EPSG:n -a_ullr W N E S");
    dem::Description unused;
    if (GDALGetSpatialRef(dataset)) return dem::georeference(opened, dataset, {}, unused);
    try {
        return dem::georeference(opened, dataset, {}, unused);
    } catch (const Error&) {
        if (GDALGetGCPCount(dataset) > 0) throw;
        dem::refuse(path,
                    "the raster names no coordinate system and is not in degrees; add one with "
                    "gdal_translate -a_srs EPSG:n");
    }
}

GDALRasterBandH band_of(const dem::Dataset& dataset, const std::string& path, int number) {
    const int bands = GDALGetRasterCount(dataset.get());
    if (number < 1 || number > bands)
        dem::refuse(path, fmt::format("band {}: expected 1 to {}", number, bands));
    return GDALGetRasterBand(dataset.get(), number);
}

std::map<std::string, std::string> metadata_of(const dem::Dataset& dataset, GDALRasterBandH band) {
    std::map<std::string, std::string> result;
    for (const GDALMajorObjectH object :
         {GDALMajorObjectH{dataset.get()}, GDALMajorObjectH{band}}) {
        char** const items = GDALGetMetadata(object, nullptr);
        for (char** item = items; item && *item; ++item) {
            const std::string_view text = *item;
            const std::size_t equals = text.find('=');
            if (equals != std::string_view::npos)
                result[std::string(text.substr(0, equals))] = text.substr(equals + 1);
        }
    }
    return result;
}

}  // namespace

std::map<std::string, std::string> band_metadata(const std::string& path, int number) {
    AllowedName opened(path);
    const dem::Dataset dataset = dem::open_dataset(opened);
    return metadata_of(dataset, band_of(dataset, path, number));
}

namespace {

void add_bands(const dem::Dataset& dataset, const std::string& path, std::vector<BandInFile>& to) {
    for (int number = 1; number <= GDALGetRasterCount(dataset.get()); ++number) {
        const GDALRasterBandH band = GDALGetRasterBand(dataset.get(), number);
        to.push_back({path, number, GDALGetRasterUnitType(band), metadata_of(dataset, band)});
    }
}

}  // namespace

std::vector<BandInFile> bands_of(const std::string& path) {
    AllowedName opened(path);
    const dem::Dataset dataset = dem::open_dataset(opened);
    std::vector<BandInFile> bands;
    add_bands(dataset, path, bands);
    if (!bands.empty()) return bands;
    char** const parts = GDALGetMetadata(dataset.get(), "SUBDATASETS");
    for (int part = 1;; ++part) {
        const std::string key = fmt::format("SUBDATASET_{}_NAME", part);
        const char* const name = CSLFetchNameValue(parts, key.c_str());
        if (!name) return bands;
        AllowedName of_part = opened.derived(name);
        add_bands(dem::open_dataset(of_part), name, bands);
    }
}

dem::Grid grid_of_raster(const std::string& path) {
    AllowedName opened(path);
    const dem::Dataset dataset = dem::open_dataset(opened);
    return grid_of_raster(path, opened.text(), dataset.get());
}

dem::Grid grid_of_raster(const std::string& path, const std::string& opened, void* dataset) {
    const dem::Georeference where = placed(path, opened, dataset);
    return {GDALGetRasterXSize(dataset), GDALGetRasterYSize(dataset), where.affine, where.crs};
}

BandOver read_band_over(const dem::Grid& grid, const std::string& path, int number) {
    AllowedName opened(path);
    const dem::Dataset dataset = dem::open_dataset(opened);
    const GDALRasterBandH band = band_of(dataset, path, number);
    const dem::Grid raster = grid_of_raster(path, opened.text(), dataset.get());
    const Cells cells = read_cells(band, path);
    BandOver over;
    over.name = GDALGetDescription(band);
    over.unit = GDALGetRasterUnitType(band);
    over.about = metadata_of(dataset, band);
    over.whole = GDALGetRasterDataType(band) == GDT_Byte;
    over.colors = colors_of(band);
    const double share = std::sqrt(
        std::min(1.0, static_cast<double>(kMostOver) / (double{1} * grid.columns() * grid.rows())));
    over.values = Array2d<float>(std::max(1, static_cast<int>(grid.columns() * share)),
                                 std::max(1, static_cast<int>(grid.rows() * share)));
    const glm::ivec2 count(over.values.width(), over.values.height());
    const dem::PlacesOver places(grid, raster,
                                 {.step = glm::dvec2(grid.columns() - 1, grid.rows() - 1) /
                                          glm::dvec2(glm::max(count - 1, glm::ivec2(1))),
                                  .count = count});
    const bool round = goes_round(raster);
    std::atomic<bool> covers = false;
    parallel_for(0, over.values.height(), 16, [&](int first, int end) {
        for (int row = first; row < end; ++row)
            for (int column = 0; column < over.values.width(); ++column) {
                const glm::dvec2 place = places(column, row);
                const glm::dvec2 at = (place + 0.5) / cells.shrunk - 0.5;
                over.values.at(column, row) =
                    over.whole ? nearest_cell(cells.values, at) : between(cells.values, at, round);
                if (place.x >= -0.5 && place.y >= -0.5 && place.x <= raster.columns() - 0.5 &&
                    place.y <= raster.rows() - 0.5)
                    covers = true;
            }
    });
    if (!covers)
        dem::refuse(path,
                    fmt::format("the raster does not cover this DEM; it is at {}, the DEM at {}",
                                extent_text(raster), extent_text(grid)));
    if (std::ranges::all_of(over.values, [](float v) { return std::isnan(v); }))
        dem::refuse(path, "the raster has no value anywhere on this DEM");
    return over;
}

}  // namespace relevo::overlay
