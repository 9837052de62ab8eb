#pragma once

// One relief, sampled on grids of all kinds.
#include <array>
#include <cmath>
#include <string>

#include "base/units.h"
#include "dem/heightfield.h"
#include "geo/local_frame.h"
#include "light/fields.h"
#include "sun/zone.h"
#include "support/support.h"

namespace relevo::light {

inline sun::Instant utc(const std::string& text) {
    return sun::parse_time(text, {}).utc;
}

inline geo::Geodetic place_at(double lat_deg, double lon_deg) {
    return {radians(lat_deg), radians(lon_deg), 0};
}

/// Hills about a place: a sum of Gaussians, the same on whatever grid.
class Hills {
  public:
    /// @param wider, higher  factors of widths and distances, and of heights
    explicit Hills(const geo::Geodetic& middle, double wider = 1, double higher = 1)
        : frame_(middle), wider_(wider), higher_(higher) {}

    double height_m(const geo::Geodetic& place) const {
        const glm::dvec2 at = glm::dvec2(frame_.to_local(place)) / wider_;
        if (glm::length(at) > 20e3) return 400;  // hills are under 1e-14 m there
        double sum = 0;
        for (const auto& [x_m, y_m, up_m, width_m] : kHills) {
            const double dx = at.x - x_m, dy = at.y - y_m;
            sum += up_m * std::exp(-(dx * dx + dy * dy) / (2 * width_m * width_m));
        }
        return 400 + higher_ * sum;
    }

    /// 625 places among them, where hours are compared.
    std::vector<geo::Geodetic> places() const {
        std::vector<geo::Geodetic> places;
        for (int i = -12; i <= 12; ++i)
            for (int k = -12; k <= 12; ++k)
                places.push_back(frame_.to_geodetic({170 * wider_ * i, 170 * wider_ * k, 0}));
        return places;
    }

  private:
    static constexpr std::array<std::array<double, 4>, 8> kHills{{{-3600, 1800, 1400, 1300},
                                                                  {3000, -1400, 1200, 1100},
                                                                  {600, 4200, 1500, 1400},
                                                                  {-1200, -4000, 1300, 1200},
                                                                  {4600, 3000, 900, 1000},
                                                                  {-5000, -1800, 1100, 1200},
                                                                  {400, 400, 500, 900},
                                                                  {1800, -5200, 1300, 1400}}};
    geo::LocalFrame frame_;
    double wider_, higher_;
};

struct NamedGrid {
    std::string name, crs;
    dem::Affine affine;
    int columns, rows;
    bool with_border = false;  // of voids, three posts wide
};

inline dem::Heightfield sampled(const NamedGrid& of, const Hills& hills) {
    const dem::Grid grid(of.columns, of.rows, of.affine, geo::Crs::parse(of.crs, "test"));
    return test::field_of(of.columns, of.rows, of.affine, of.crs, [&](int column, int row) {
        const bool is_border =
            column < 3 || row < 3 || column >= of.columns - 3 || row >= of.rows - 3;
        if (of.with_border && is_border) return std::nan("");
        return hills.height_m(grid.place(column, row));
    });
}

/// Posts `step_m` apart about a point of a CRS, turned clockwise.
inline NamedGrid turned(const std::string& name, const std::string& crs,
                        const geo::Geodetic& middle, double step, double turn_deg, int side = 401) {
    const glm::dvec2 at = geo::Crs::parse(crs, "test").from_geodetic(middle);
    const double c = step * std::cos(radians(turn_deg)), s = step * std::sin(radians(turn_deg));
    const double half = (side - 1) / 2.0;
    return {name,
            crs,
            {at.x - half * c + half * s, c, -s, at.y + half * s + half * c, -s, -c},
            side,
            side};
}

}  // namespace relevo::light
