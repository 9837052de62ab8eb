#include "dem/band_over.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gdal.h>

#include "base/parallel_for.h"
#include "base/text.h"
#include "base/units.h"
#include "dem/gdal_support.h"
#include "dem/interpret.h"

namespace relevo::dem {
namespace {

constexpr int kNet = 16;  // values between places that are computed
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

/// Where places of the overlay's values lie among the cells of the raster.
class Places {
  public:
    /// @param values  of the result along both sides, the first and the last on the DEM's posts
    Places(const Grid& dem, const Grid& raster, const glm::ivec2& values)
        : dem_(dem),
          raster_(raster),
          step_(glm::dvec2(dem.columns() - 1, dem.rows() - 1) /
                glm::dvec2(glm::max(values - 1, glm::ivec2(1)))),
          same_crs_(dem.crs().text() == raster.crs().text()),
          linear_(is_linear()) {
        if (linear_) return;
        net_ = Array2d<glm::dvec2>((values.x - 1) / kNet + 2, (values.y - 1) / kNet + 2);
        parallel_for(0, net_.height(), 1, [&](int first, int last) {
            for (int row = first; row < last; ++row)
                for (int column = 0; column < net_.width(); ++column)
                    net_.at(column, row) = exact({column * kNet, row * kNet});
        });
        uneven_ = Array2d<std::uint8_t>(net_.width() - 1, net_.height() - 1);
        parallel_for(0, uneven_.height(), 1, [&](int first, int last) {
            for (int row = first; row < last; ++row)
                for (int column = 0; column < uneven_.width(); ++column)
                    uneven_.at(column, row) = is_uneven(column, row);
        });
    }

    glm::dvec2 operator()(int column, int row) const {
        if (linear_) return linear(glm::dvec2(column, row) * step_);
        if (uneven_.at(column / kNet, row / kNet)) return exact({column, row});
        return interpolated(glm::dvec2(column, row) / double{kNet});
    }

  private:
    glm::dvec2 linear(const glm::dvec2& post) const {
        return raster_.affine().inverse(dem_.affine()(post.x, post.y));
    }

    glm::dvec2 exact(const glm::dvec2& value) const {
        const glm::dvec2 post = value * step_;
        if (same_crs_) {
            // Coordinates beyond 180 degrees east are counted on in one of them alone.
            const glm::dvec2 at = linear(post);
            if (at.x >= -0.5 && at.y >= -0.5 && at.x <= raster_.columns() - 0.5 &&
                at.y <= raster_.rows() - 0.5)
                return at;
        }
        return raster_.post(dem_.place(post.x, post.y));
    }

    /// Whether both have one CRS and count its longitudes alike: 190 degrees may be -170 there.
    bool is_linear() const {
        constexpr int kSamples = 32;
        if (!same_crs_) return false;
        const glm::dvec2 last(dem_.columns() - 1, dem_.rows() - 1);
        for (int j = 0; j <= kSamples; ++j)
            for (int i = 0; i <= kSamples; ++i) {
                const glm::dvec2 post = last * glm::dvec2(i, j) / double{kSamples};
                if (distance(raster_.post(dem_.place(post.x, post.y)), linear(post)) > 0.5)
                    return false;
            }
        return true;
    }

    /// @param at  in steps of the net
    glm::dvec2 interpolated(const glm::dvec2& at) const {
        const int left = std::min(static_cast<int>(at.x), net_.width() - 2),
                  above = std::min(static_cast<int>(at.y), net_.height() - 2);
        const double u = at.x - left, v = at.y - above;
        const auto node = [&](int i, int j) { return net_.at(left + i, above + j); };
        return (1 - v) * ((1 - u) * node(0, 0) + u * node(1, 0)) +
               v * ((1 - u) * node(0, 1) + u * node(1, 1));
    }

    /// Whether places in a part of the net cannot be interpolated: near a pole, where longitudes
    /// begin anew, and where the net is too wide for how the two CRSs differ.
    bool is_uneven(int column, int row) const {
        const glm::dvec2 corner = net_.at(column, row), across = net_.at(column + 1, row),
                         down = net_.at(column, row + 1);
        const double value_cells =
            std::min(distance(corner, across), distance(corner, down)) / kNet;
        const double most_off = kMostOff * std::max(1.0, value_cells);
        for (const glm::dvec2& in : {glm::dvec2(0.5, 0.5), glm::dvec2(0.5, 0), glm::dvec2(0.5, 1),
                                     glm::dvec2(0, 0.5), glm::dvec2(1, 0.5)}) {
            const glm::dvec2 at = glm::dvec2(column, row) + in;
            if (!(distance(interpolated(at), exact(at * double{kNet})) <= most_off)) return true;
        }
        return false;
    }

    static constexpr double kMostOff = 0.05;  // cells of the raster, or values where they are wider

    const Grid& dem_;
    const Grid& raster_;
    glm::dvec2 step_;  ///< posts of the DEM from value to value
    bool same_crs_;
    bool linear_;
    Array2d<glm::dvec2> net_;
    Array2d<std::uint8_t> uneven_;
};

/// Whether the last cells of a row lie beside its first ones, around the Earth.
bool goes_round(const Grid& raster) {
    const Affine& affine = raster.affine();
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

float nearest(const Array2d<float>& cells, const glm::dvec2& at) {
    const double column = std::floor(at.x + 0.5), row = std::floor(at.y + 0.5);
    if (!(column >= 0 && row >= 0 && column < cells.width() && row < cells.height())) return kNaN;
    return cells.at(static_cast<int>(column), static_cast<int>(row));
}

/// "46.90 to 47.10 N, 8.95 to 9.20 E": a box around what is sampled of a raster's edges.
std::string extent_text(const Grid& grid) {
    constexpr int kSamples = 16;
    const double centre_rad = grid.center().lon_rad;
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
    const glm::dvec2 last(grid.columns() - 0.5, grid.rows() - 0.5);
    for (int i = 0; i <= kSamples; ++i)
        for (int j = 0; j <= kSamples; ++j) {
            const glm::dvec2 post =
                glm::mix(glm::dvec2(-0.5), last, glm::dvec2(i, j) / double{kSamples});
            const geo::Geodetic at = grid.place(post.x, post.y);
            const double lon_rad = centre_rad + std::remainder(at.lon_rad - centre_rad, 2 * kPi);
            if (!std::isfinite(at.lat_rad) || !std::isfinite(lon_rad)) continue;
            low = glm::min(low, glm::dvec2(degrees(at.lat_rad), degrees(lon_rad)));
            high = glm::max(high, glm::dvec2(degrees(at.lat_rad), degrees(lon_rad)));
        }
    constexpr double kAllRound_deg = 350;  // about a pole
    const auto from_west = [](double lon_deg) { return std::remainder(lon_deg, 360.0); };
    return fmt::format(
        "latitude {:.3f} to {:.3f}, {}", low.x, high.x,
        high.y - low.y > kAllRound_deg
            ? "all longitudes"
            : fmt::format("longitude {:.3f} to {:.3f}", from_west(low.y), from_west(high.y)));
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

GDALRasterBandH band_of(const Dataset& dataset, const std::string& path, int number) {
    const int bands = GDALGetRasterCount(dataset.get());
    if (number < 1 || number > bands)
        refuse(path, fmt::format("band {}: expected 1 to {}", number, bands));
    return GDALGetRasterBand(dataset.get(), number);
}

std::map<std::string, std::string> metadata_of(const Dataset& dataset, GDALRasterBandH band) {
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
    std::string opened = path;
    const Dataset dataset = open_dataset(opened);
    return metadata_of(dataset, band_of(dataset, path, number));
}

BandOver read_band_over(const Grid& grid, const std::string& path, int number) {
    std::string opened = path;
    const Dataset dataset = open_dataset(opened);
    const GDALRasterBandH band = band_of(dataset, path, number);
    Description unused;
    const Georeference where = georeference(opened, dataset.get(), {}, unused);
    const Cells cells = read_cells(band, path);
    const Grid raster(GDALGetRasterXSize(dataset.get()), GDALGetRasterYSize(dataset.get()),
                      where.affine, where.crs);
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
    const Places places(grid, raster, {over.values.width(), over.values.height()});
    const bool round = goes_round(raster);
    std::atomic<bool> covers = false;
    parallel_for(0, over.values.height(), 16, [&](int first, int end) {
        for (int row = first; row < end; ++row)
            for (int column = 0; column < over.values.width(); ++column) {
                const glm::dvec2 place = places(column, row);
                const glm::dvec2 at = (place + 0.5) / cells.shrunk - 0.5;
                over.values.at(column, row) =
                    over.whole ? nearest(cells.values, at) : between(cells.values, at, round);
                if (place.x >= -0.5 && place.y >= -0.5 && place.x <= raster.columns() - 0.5 &&
                    place.y <= raster.rows() - 0.5)
                    covers = true;
            }
    });
    if (!covers)
        refuse(path, fmt::format("the overlay does not cover this DEM; it is at {}, the DEM at {}",
                                 extent_text(raster), extent_text(grid)));
    if (std::ranges::all_of(over.values, [](float v) { return std::isnan(v); }))
        refuse(path, "the overlay has no value anywhere on this DEM");
    return over;
}

}  // namespace relevo::dem
