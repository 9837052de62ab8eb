#include "zones/zone_sums.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "dem/gdal.h"
#include "dem/interpret.h"
#include "overlay/band_over.h"
#include "zones/cell_area.h"
#include "zones/coverage.h"

namespace relevo::zones {
namespace {

constexpr double kLeastShare = 1e-11;  // less is rounding
constexpr int kMostCells = 1 << 20;    // of a window that is read at once
constexpr double kApart = 1e-5;        // cells, of an outline that another CRS bends
constexpr int kMostHalvings = 12;

/// From a CRS to cells of a raster, whose outer corner is (0, 0).
class ToCells {
  public:
    ToCells(const dem::Grid& grid, const std::optional<geo::Crs>& from) : grid_(grid), from_(from) {
        if (from_ && from_->text() == grid.crs().text()) from_.reset();
        if (grid.crs().is_geographic()) turn_ = 2 * kPi / grid.crs().unit_si();
    }

    Ring operator()(const Ring& ring) const {
        Ring cells;
        cells.reserve(ring.size());
        for (std::size_t i = 0; i < ring.size(); ++i) {
            cells.push_back(cell(ring[i]));
            const glm::dvec2& next = ring[i + 1 < ring.size() ? i + 1 : 0];
            if (from_) follow(ring[i], next, cells.back(), cell(next), kMostHalvings, cells);
        }
        return cells;
    }

    /// Turns a ring by whole turns of longitude to where the raster is.
    void turn(std::vector<Ring>& rings) const {
        if (from_ || turn_ == 0 || rings.empty()) return;
        const glm::dvec2 way(grid_.affine().x_column, grid_.affine().x_row);
        if (way.y != 0) return;
        const double apart = rings[0][0].x - 0.5 * grid_.columns(), whole = turn_ / way.x;
        const double turns = std::round(apart / whole);
        if (turns == 0) return;
        for (Ring& ring : rings)
            for (glm::dvec2& at : ring)
                at.x -= turns * whole;
    }

  private:
    glm::dvec2 cell(const glm::dvec2& at) const {
        const glm::dvec2 place =
            (from_ ? grid_.post(from_->to_geodetic(at.x, at.y)) : grid_.affine().inverse(at)) + 0.5;
        return {on_edge(place.x), on_edge(place.y)};
    }
    /// What lies on the edge of cells but for rounding is there: no neighbour counts.
    static double on_edge(double at) {
        const double edge = std::round(at);
        return std::abs(at - edge) < 1e-9 ? edge : at;
    }
    /// Adds corners between two until chords are near enough.
    void follow(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& cell_a,
                const glm::dvec2& cell_b, int halvings, Ring& cells) const {
        const glm::dvec2 middle = 0.5 * (a + b), bent = cell(middle);
        if (halvings == 0 || !(distance(bent, 0.5 * (cell_a + cell_b)) > kApart)) return;
        follow(a, middle, cell_a, bent, halvings - 1, cells);
        cells.push_back(bent);
        follow(middle, b, bent, cell_b, halvings - 1, cells);
    }

    const dem::Grid& grid_;
    std::optional<geo::Crs> from_;
    double turn_ = 0;
};

/// A band as numbers, NaN where it has none.
class Band {
  public:
    Band(const std::string& path, GDALRasterBandH band) : path_(path), band_(band) {
        int has = 0;
        scale_ = GDALGetRasterScale(band, &has);
        if (!has) scale_ = 1;
        offset_ = GDALGetRasterOffset(band, &has);
        if (!has) offset_ = 0;
        if (!(GDALGetMaskFlags(band) & GMF_ALL_VALID)) mask_ = GDALGetMaskBand(band);
    }

    const std::vector<double>& read(const Window& window) {
        const auto cells =
            static_cast<std::size_t>(window.columns) * static_cast<std::size_t>(window.rows);
        values_.resize(cells);
        read(band_, window, values_.data(), GDT_Float64);
        if (mask_) {
            valid_.resize(cells);
            read(mask_, window, valid_.data(), GDT_Byte);
        }
        for (std::size_t i = 0; i < cells; ++i)
            values_[i] = mask_ && valid_[i] == 0 ? std::numeric_limits<double>::quiet_NaN()
                                                 : values_[i] * scale_ + offset_;
        return values_;
    }

  private:
    void read(GDALRasterBandH band, const Window& window, void* to, GDALDataType type) const {
        const dem::GdalMessages messages;
        if (GDALRasterIO(band, GF_Read, window.column, window.row, window.columns, window.rows, to,
                         window.columns, window.rows, type, 0, 0) != CE_None)
            messages.refuse(path_, "cannot be read");
    }

    const std::string& path_;
    GDALRasterBandH band_, mask_ = nullptr;
    double scale_ = 1, offset_ = 0;
    std::vector<double> values_;
    std::vector<std::uint8_t> valid_;
};

/// A zone on its way to a row.
struct Sum {
    double cells = 0, weight = 0, weighted = 0, valid_m2 = 0, above = 0;
    double min = std::numeric_limits<double>::infinity(), max = -min;

    void add(double value, double share, double weighs, double cell_m2, double limit) {
        ++cells;
        weight += share * weighs;
        weighted += share * weighs * value;
        valid_m2 += share * cell_m2;
        if (value > limit) above += share * weighs;
        min = std::min(min, value);
        max = std::max(max, value);
    }
    void put(ZoneRow& row, bool with_above) const {
        if (!(weight > 0)) {
            row.fault = "no cell with a value";
            return;
        }
        row.cells = cells;
        row.area_valid_m2 = valid_m2;
        row.mean = weighted / weight;
        row.integral = row.mean * valid_m2;
        row.min = min;
        row.max = max;
        if (with_above) row.share_above = above / weight;
    }
};

/// All zones in cells of one raster.
class Zones {
  public:
    Zones(const ZoneFile& file, const dem::Grid& grid, const SumOptions& options)
        : all_{0, 0, grid.columns(), grid.rows()}, limit_(options.above) {
        const bool degrees = grid.crs().is_geographic();
        const Weights weights =
            options.weights.value_or(degrees ? Weights::Ellipsoid : Weights::Crs);
        alike_ = weights == Weights::Crs;
        area_.emplace(grid, degrees || weights == Weights::Ellipsoid);
        const ToCells to_cells(grid, file.crs);
        for (const Zone& zone : file.zones) {
            ZoneRow& row = rows_.emplace_back();
            row.fault = zone.fault;
            edges_.push_back(row.fault.empty() ? edges_of(zone, to_cells, row)
                                               : std::vector<Edge>());
        }
    }

    std::vector<ZoneRow> over(Band& band) const {
        std::vector<ZoneRow> rows = rows_;
        for (const std::size_t i : in_order_of_rows())
            sum(edges_[i], band).put(rows[i], limit_.has_value());
        return rows;
    }

  private:
    std::vector<Edge> edges_of(const Zone& zone, const ToCells& to_cells, ZoneRow& row) const {
        std::vector<Ring> rings;
        for (const Ring& ring : zone.rings)
            rings.push_back(to_cells(ring));
        for (const Ring& ring : rings)
            for (const glm::dvec2& at : ring)
                if (!std::isfinite(at.x) || !std::isfinite(at.y)) {
                    row.fault = "a corner that the raster's CRS cannot express";
                    return {};
                }
        to_cells.turn(rings);
        std::vector<Edge> edges = even_odd_edges(rings);
        row.area_m2 = area_->enclosed(edges);
        if (!(row.area_m2 > 0))
            row.fault = "a polygon without area";
        else if (cells_of(edges, all_).is_empty())
            row.fault = "outside of the raster";
        return edges;
    }

    /// Of zones with an outline: neighbours after each other, so that blocks are decoded once.
    std::vector<std::size_t> in_order_of_rows() const {
        constexpr int kBlock = 256;
        std::vector<std::size_t> order;
        std::vector<std::pair<int, int>> places(rows_.size());
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            if (!rows_[i].fault.empty()) continue;
            const Window window = cells_of(edges_[i], all_);
            places[i] = {window.row / kBlock, window.column};
            order.push_back(i);
        }
        std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(places[i], i); });
        return order;
    }

    Sum sum(const std::vector<Edge>& edges, Band& band) const {
        Sum sum;
        const Window whole = cells_of(edges, all_);
        const double limit = limit_.value_or(std::numeric_limits<double>::infinity());
        const int rows = std::max(kMostCells / whole.columns, 1);
        for (int row = whole.row; row < whole.end_row(); row += rows) {
            const Window part{whole.column, row, whole.columns,
                              std::min(rows, whole.end_row() - row)};
            const std::vector<double> shares = coverage(edges, part);
            const std::vector<double>& values = band.read(part);
            for (std::size_t i = 0; i < shares.size(); ++i) {
                if (shares[i] < kLeastShare || std::isnan(values[i])) continue;
                const auto width = static_cast<std::size_t>(part.columns);
                const double cell_m2 =
                    area_->at({part.column + static_cast<double>(i % width) + 0.5,
                               row + static_cast<double>(i / width) + 0.5});
                sum.add(values[i], shares[i], alike_ ? 1 : cell_m2, cell_m2, limit);
            }
        }
        return sum;
    }

    Window all_;
    std::optional<double> limit_;
    bool alike_ = true;
    std::optional<CellArea> area_;
    std::vector<std::vector<Edge>> edges_;
    std::vector<ZoneRow> rows_;  // areas and faults, the same for all bands
};

}  // namespace

std::vector<std::vector<ZoneRow>> sum_zones(const ZoneFile& file, const std::string& raster,
                                            const SumOptions& options) {
    AllowedName opened(raster);
    const dem::Dataset dataset = dem::open_dataset(opened);
    const dem::Grid grid = overlay::grid_of_raster(raster, opened.text(), dataset.get());
    const Zones zones(file, grid, options);
    std::vector<std::vector<ZoneRow>> bands;
    for (int i = 1; i <= GDALGetRasterCount(dataset.get()); ++i) {
        const GDALRasterBandH handle = GDALGetRasterBand(dataset.get(), i);
        if (GDALDataTypeIsComplex(GDALGetRasterDataType(handle)))
            dem::refuse(raster, fmt::format("band {} has complex numbers", i));
        Band band(raster, handle);
        bands.push_back(zones.over(band));
    }
    return bands;
}

}  // namespace relevo::zones
