#include "dem/dry_land.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>

#include "base/units.h"

namespace relevo::dem {
namespace {

/// Boxes drawn around the depressions so that no sea lies in them but where `on_coast` says so.
/// Where two overlap the first one holds. Lowest land, rounded down: The World Factbook (CIA),
/// field "Elevation"; of those that are no country's lowest, the Encyclopaedia Britannica; of the
/// Dutch polders, the Fens and the Sacramento's delta, the peat that has sunk since they were
/// drained. The Dead Sea falls by a metre a year; the Caspian's shore lies at -28 m.
constexpr std::array kDepressions{
    Depression{"the Dead Sea and the Jordan's valley", 30.30, 33.00, 35.15, 35.90, -445},
    Depression{"Death Valley", 35.50, 37.20, -117.40, -116.30, -87},
    Depression{"the Salton Trough", 32.10, 34.00, -116.40, -115.00, -86},
    Depression{"the Sacramento's delta", 37.75, 38.35, -121.90, -121.20, -9, true},
    Depression{"the Qattara and Siwa Depressions", 28.40, 30.60, 24.80, 29.50, -135},
    Depression{"the Fayum", 28.95, 29.70, 30.00, 31.10, -55},
    Depression{"Sabkhat Ghuzayyil", 29.40, 30.10, 19.20, 20.30, -48},
    Depression{"Chott Melrhir and Chott el Gharsa", 33.40, 35.00, 5.80, 8.10, -41},
    Depression{"Sebkha Tah", 27.40, 27.90, -12.80, -12.20, -56},
    Depression{"the Danakil Depression, south", 12.90, 14.00, 40.00, 41.30, -126},
    Depression{"the Danakil Depression, north", 14.00, 14.65, 39.90, 40.70, -126},
    Depression{"Lake Assal", 11.58, 11.80, 42.25, 42.47, -156},
    Depression{"the Turpan Depression", 42.20, 43.40, 87.60, 90.60, -155},
    Depression{"Karagiye and Kaundy", 42.50, 44.60, 51.35, 54.20, -133},
    Depression{"the Caspian lowland", 36.40, 50.60, 44.00, 55.00, -29.5},
    Depression{"Akchanaya and Sarygamysh", 39.80, 42.60, 55.50, 58.70, -82},
    Depression{"Lake Enriquillo", 18.25, 18.70, -72.10, -71.15, -47},
    Depression{"Laguna del Carbon", -49.90, -49.20, -68.80, -68.10, -106},
    Depression{"Bajo del Gualicho", -40.70, -40.10, -66.00, -65.10, -74},
    Depression{"the salt pans of Valdes", -42.75, -42.35, -64.20, -63.75, -43},
    Depression{"Kati Thanda-Lake Eyre", -30.00, -26.70, 136.00, 138.60, -17},
    Depression{"the Dutch polders", 51.30, 53.35, 3.90, 7.10, -7.5, true},
    Depression{"the Fens", 52.20, 52.95, -0.40, 0.60, -4.5, true},
    Depression{"the Danish polders", 55.65, 55.90, 11.35, 11.75, -8, true},
    Depression{"the Po's delta", 44.60, 45.35, 11.60, 12.45, -5, true},
    Depression{"New Orleans", 29.75, 30.15, -90.60, -89.75, -5, true},
};

const Depression* depression_at(const geo::Geodetic& place) {
    const double lat_deg = degrees(place.lat_rad);
    const double lon_deg = geo::normalized_lon_deg(degrees(place.lon_rad));
    for (const Depression& box : kDepressions)
        if (lat_deg >= box.south_deg && lat_deg <= box.north_deg && lon_deg >= box.west_deg &&
            lon_deg <= box.east_deg)
            return &box;
    return nullptr;
}

/// Whether a part of a grid comes near a depression, by its corners and its middle.
bool may_have_depression(const Grid& grid, const glm::ivec2& first, const glm::ivec2& last) {
    double south = 90, north = -90, west = 360, east = -360;
    const glm::dvec2 low(first), high(last), middle = 0.5 * (low + high);
    const std::array<glm::dvec2, 5> posts{low, high, glm::dvec2(low.x, high.y),
                                          glm::dvec2(high.x, low.y), middle};
    for (const glm::dvec2& post : posts) {
        const geo::Geodetic place = grid.place(post.x, post.y);
        if (!std::isfinite(place.lat_rad)) return true;
        const double lon_deg = geo::normalized_lon_deg(degrees(place.lon_rad));
        south = std::min(south, degrees(place.lat_rad));
        north = std::max(north, degrees(place.lat_rad));
        west = std::min(west, lon_deg);
        east = std::max(east, lon_deg);
    }
    // Sides bend, and cells at the rim count by their middles.
    const double margin_deg = 0.05 + 0.5 * std::max(north - south, east - west);
    return std::ranges::any_of(kDepressions, [&](const Depression& box) {
        return box.south_deg <= north + margin_deg && box.north_deg >= south - margin_deg &&
               box.west_deg <= east + margin_deg && box.east_deg >= west - margin_deg;
    });
}

}  // namespace

DryLand::DryLand(const Grid& grid) {
    // As fine as the boxes are drawn: within a kilometre.
    constexpr double kCell_m = 1000;
    const glm::dvec2 spacing_m = grid.post_spacing_m();
    stride_ = std::clamp(static_cast<int>(kCell_m / std::max(spacing_m.x, spacing_m.y)), 1, 64);
    Array2d<const Depression*> boxes((grid.columns() - 1) / stride_ + 1,
                                     (grid.rows() - 1) / stride_ + 1, nullptr);
    bool any = false;
    constexpr int kBlock =
        16;  // cells that are left out together where none can be in a depression
    for (int y = 0; y < boxes.height(); y += kBlock) {
        for (int x = 0; x < boxes.width(); x += kBlock) {
            const glm::ivec2 first(x, y);
            const glm::ivec2 last = glm::min(first + kBlock, {boxes.width(), boxes.height()}) - 1;
            if (!may_have_depression(grid, first * stride_, last * stride_)) continue;
            for (int j = first.y; j <= last.y; ++j)
                for (int i = first.x; i <= last.x; ++i) {
                    const glm::dvec2 at = glm::dvec2(i, j) * double(stride_) + 0.5 * (stride_ - 1);
                    boxes.at(i, j) = depression_at(grid.place(at.x, at.y));
                    any = any || boxes.at(i, j);
                }
        }
    }
    if (any) boxes_ = std::move(boxes);
}

}  // namespace relevo::dem
