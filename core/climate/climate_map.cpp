#include "climate/climate_map.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <span>

#include "base/paths.h"
#include "base/units.h"
#include "climate/earth_grids.h"

namespace relevo::climate {
namespace {

/// The grids in the file's order.
enum Layer { kTemperature, kRelief, kRain, kShare, kIce, kLayers };
constexpr std::array<EarthGrids::Layer, kLayers> kGrids{
    {{"temperature", 12, 16}, {"relief", 1, 16}, {"rain", 1, 8}, {"share", 12, 8}, {"ice", 1, 1}}};

}  // namespace

struct ClimateMap::Impl {
    EarthGrids grids;
    std::mutex unpacking;

    double cell(Layer layer, int plane, int column, int row) {
        return grids.cell(layer, plane, column, row);
    }

    /// Of all cells of a row.
    double mean(Layer layer, int plane, int row, double (*value_of)(double)) {
        double sum = 0;
        for (int column = 0; column < grids.columns(layer); ++column)
            sum += value_of(cell(layer, plane, column, row));
        return sum / grids.columns(layer);
    }

    /// Bilinear between the middles of cells, round the Earth. Beyond the last row it goes to that
    /// row's mean at the pole, where all longitudes are one place.
    void bilinear(Layer layer, const geo::Geodetic& place, std::span<double> planes,
                  double (*value_of)(double)) {
        const int rows = grids.rows(layer), columns = grids.columns(layer);
        const double from_north = (90 - degrees(place.lat_rad)) * rows / 180 - 0.5;
        const double y = std::clamp(from_north, 0.0, rows - 1.0);
        const double polar = std::min(2 * std::abs(from_north - y), 1.0);
        double x = (degrees(place.lon_rad) + 180) * columns / 360 - 0.5;
        x -= std::floor(x / columns) * columns;
        const int row = std::min(static_cast<int>(y), rows - 2);
        const int column = std::min(static_cast<int>(x), columns - 1);
        const int next = (column + 1) % columns;
        const double u = x - column, v = y - row;
        for (std::size_t i = 0; i < planes.size(); ++i) {
            const int plane = static_cast<int>(i);
            const auto at = [&](int c, int r) { return value_of(cell(layer, plane, c, r)); };
            planes[i] = (1 - v) * ((1 - u) * at(column, row) + u * at(next, row)) +
                        v * ((1 - u) * at(column, row + 1) + u * at(next, row + 1));
            if (polar > 0)
                planes[i] +=
                    polar * (mean(layer, plane, v > 0.5 ? row + 1 : row, value_of) - planes[i]);
        }
    }

    Normals normals(const geo::Geodetic& place) {
        Normals normals{.lat_deg = degrees(place.lat_rad)};
        bilinear(kTemperature, place, normals.sea_level_c, [](double v) { return v / 10; });
        bilinear(kRelief, place, std::span(&normals.relief_m, 1), [](double v) { return v; });
        double year_mm = 0, sum = 0;
        bilinear(kRain, place, std::span(&year_mm, 1),
                 [](double v) { return 8 * (std::exp2(v / 20) - 1); });
        bilinear(kShare, place, normals.rain_mm, [](double v) { return v; });
        for (const double share : normals.rain_mm)
            sum += share;
        for (double& month : normals.rain_mm)
            month *= sum > 0 ? year_mm / sum : 0;
        return normals;
    }

    double ice_share(const geo::Geodetic& place, double half_deg) {
        const int rows = grids.rows(kIce), columns = grids.columns(kIce);
        const double cells_a_degree = rows / 180.0;
        const double x = (degrees(place.lon_rad) + 180) * cells_a_degree;
        const double y = (90 - degrees(place.lat_rad)) * cells_a_degree;
        const int reach = static_cast<int>(half_deg * cells_a_degree);
        // A few cells of a large box say enough.
        const int step = std::max(1, reach / 8);
        int count = 0;
        double sum = 0;
        for (int j = -reach; j <= reach; j += step) {
            const int row = std::clamp(static_cast<int>(y) + j, 0, rows - 1);
            for (int i = -reach; i <= reach; i += step) {
                const int column = (static_cast<int>(std::floor(x)) + i) % columns;
                sum += cell(kIce, 0, column < 0 ? column + columns : column, row);
                ++count;
            }
        }
        return sum / count;
    }
};

ClimateMap::ClimateMap(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ClimateMap::ClimateMap(ClimateMap&&) noexcept = default;
ClimateMap& ClimateMap::operator=(ClimateMap&&) noexcept = default;
ClimateMap::~ClimateMap() = default;

ClimateMap ClimateMap::read(const std::filesystem::path& path) {
    return ClimateMap(
        std::unique_ptr<Impl>(new Impl{.grids{path, "climate 1", kGrids}, .unpacking{}}));
}

ClimateMap ClimateMap::shipped() {
    return read(share_dir() / "data/climate/climate.bin");
}

Normals ClimateMap::at(const geo::Geodetic& place) const {
    return around(place, 0);
}

Normals ClimateMap::around(const geo::Geodetic& place, double half_deg) const {
    const std::lock_guard lock(impl_->unpacking);
    Normals normals = impl_->normals(place);
    normals.mapped_ice = impl_->ice_share(place, half_deg);
    return normals;
}

}  // namespace relevo::climate
