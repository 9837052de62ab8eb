#pragma once

#include <array>
#include <cmath>
#include <functional>

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/array2d.h"
#include "light/plane/transposition.h"
#include "light/raster/shadow_heights.h"
#include "light/raster/sun_terrain.h"

namespace relevo::light {

/// How the ground rises [m/m] at the posts of a window: its gradient, a vector of
/// SunTerrain::frame(), so that it is smooth over poles, too. Next to holes and the DEM's edge the
/// ground goes on as it comes. Source: Horn, Proc. IEEE 69 (1981) 14.
struct GroundSlope {
    Array2d<float> x, y, z;

    /// Level ground.
    explicit GroundSlope(const Window& window) : x(window.columns, window.rows, 0), y(x), z(x) {}
    GroundSlope(const SunTerrain& terrain, const WindowHeights& heights, const Window& window);
    /// Planes in one position by true north, at most 89.999 degrees steep.
    GroundSlope(const SunTerrain& terrain, const Window& window, const Plane& plane);

    glm::vec3 at(int column, int row) const {
        return {x.at(column, row), y.at(column, row), z.at(column, row)};
    }

  private:
    /// Sets all gradients. @param rise  what a post rises to the east and to the north [m/m], from
    ///     its column, its row and what makes it of rises a post
    void fill(const SunTerrain& terrain, const Window& window,
              const std::function<glm::dvec2(int, int, const glm::dmat2&)>& rise);
};

/// How the ground rises [m/m] to the east and to the north at a post, whose north it is; by the
/// same posts around it as GroundSlope.
glm::dvec2 rise_at(const dem::Posts& posts, int column, int row);

/// Tangents of the horizon of each_horizon() over planes, which hide what is behind them.
/// @param first    column and row of `planes` at which the run begins
/// @param towards  direction of the horizons
std::array<float, kLongestRun> raised_over_planes(const SweepRun& run, const GroundSlope& planes,
                                                  const glm::ivec2& first,
                                                  const glm::vec3& towards);

/// The cosine of an inclined ground's angle.
inline float cosine_of(const glm::vec3& gradient) {
    return 1 / std::sqrt(1 + gradient.x * gradient.x + gradient.y * gradient.y +
                         gradient.z * gradient.z);
}

}  // namespace relevo::light
