#include "render/climate_volume.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/gtc/packing.hpp>

#include "base/units.h"

namespace relevo::render {
namespace {

/// Margin around the DEM's heights for aspects and shifted limits [m].
constexpr double kAround_m = 3000;
/// Bounds against outliers of a DEM [m].
constexpr double kLowest_m = -600, kHighest_m = 9000;

constexpr double kHalfTurn_deg = 180;

/// Maps a coordinate to texture coordinates, with the centres of the outer texels at `first` and
/// `last`.
/// @returns factor and constant
glm::dvec2 to_texture(double first, double last, int texels) {
    const double scale = (texels - 1.0) / texels / std::max(last - first, 1e-12);
    return {scale, 0.5 / texels - first * scale};
}

}  // namespace

climate::Box box_of(const dem::Grid& grid, const geo::Geodetic& origin) {
    constexpr int kSamples = 64;
    constexpr double kPole_deg = 89, kWide_deg = 300;
    const double origin_deg = degrees(origin.lon_rad);
    climate::Box box{
        .west_deg = kHalfTurn_deg, .east_deg = -kHalfTurn_deg, .south_deg = 90, .north_deg = -90};
    for (int j = 0; j <= kSamples; ++j) {
        for (int i = 0; i <= kSamples; ++i) {
            const geo::Geodetic place = grid.place((grid.columns() - 1.0) * i / kSamples,
                                                   (grid.rows() - 1.0) * j / kSamples);
            if (!std::isfinite(place.lat_rad)) continue;
            const double lon_deg = geo::normalized_lon_deg(degrees(place.lon_rad) - origin_deg);
            box.west_deg = std::min(box.west_deg, lon_deg);
            box.east_deg = std::max(box.east_deg, lon_deg);
            box.south_deg = std::min(box.south_deg, degrees(place.lat_rad));
            box.north_deg = std::max(box.north_deg, degrees(place.lat_rad));
        }
    }
    const bool polar = box.north_deg > kPole_deg || box.south_deg < -kPole_deg;
    if (polar || box.east_deg - box.west_deg > kWide_deg) {
        box.west_deg = -kHalfTurn_deg;
        box.east_deg = kHalfTurn_deg;
    }
    if (box.north_deg > kPole_deg) box.north_deg = 90;
    if (box.south_deg < -kPole_deg) box.south_deg = -90;
    box.west_deg += origin_deg;
    box.east_deg += origin_deg;
    return box;
}

glm::vec4 place_of(const climate::Box& box, const geo::Geodetic& origin, const glm::ivec2& texels) {
    return {to_texture(radians(box.west_deg) - origin.lon_rad,
                       radians(box.east_deg) - origin.lon_rad, texels.x),
            to_texture(radians(box.south_deg), radians(box.north_deg), texels.y)};
}

ClimateVolume::ClimateVolume(const climate::ClimateMap& map, const dem::Grid& grid,
                             const geo::LocalFrame& frame, double lowest_m, double highest_m,
                             const climate::FineCover::Heights& height_m)
    : table_(map, box_of(grid, frame.origin()),
             std::clamp(lowest_m - kAround_m, kLowest_m, kHighest_m - kAround_m),
             std::clamp(highest_m + kAround_m, kLowest_m + kAround_m, kHighest_m)),
      cover_(map, box_of(grid, frame.origin()), table_, height_m),
      texture_(gl::TextureKind::D3, gl::Format::RGBA16F,
               {cover_.columns(), cover_.rows(), 2 * table_.heights()}, 1, kClimateTexture),
      origin_rad_(frame.origin().lon_rad) {
    texture_.set_sampling(gl::Filter::Linear, gl::Wrap::Clamp);
    // Cover is in the lower half of the texture, snow in the upper half.
    const glm::dvec2 level =
        0.5 * to_texture(table_.lowest_m(), table_.highest_m(), table_.heights());
    place_ =
        place_of(box_of(grid, frame.origin()), frame.origin(), {cover_.columns(), cover_.rows()});
    height_ = glm::vec4(level, 0.25 / table_.heights(), 0.5 - 0.25 / table_.heights());
}

void ClimateVolume::set_day(int day) {
    if (day_ == day) return;
    values_ = cover_.texels(day);
    std::vector<std::uint16_t> texels(values_.size());
    std::transform(values_.begin(), values_.end(), texels.begin(),
                   [](float value) { return glm::packHalf1x16(value); });
    texture_.write(0, {0, 0, 0}, texture_.extent(), std::as_bytes(std::span(texels)));
    day_ = day;
}

climate::Growing ClimateVolume::growing(const geo::Geodetic& place, float height_m) const {
    const int columns = cover_.columns(), rows = cover_.rows(), heights = table_.heights();
    const double lon_rad = radians(geo::normalized_lon_deg(degrees(place.lon_rad - origin_rad_)));
    const glm::dvec3 at =
        glm::clamp(glm::dvec3((lon_rad * double{place_.x} + double{place_.y}) * columns - 0.5,
                              (place.lat_rad * double{place_.z} + double{place_.w}) * rows - 0.5,
                              (double{height_m} - table_.lowest_m()) / table_.step_m()),
                   glm::dvec3(0), glm::dvec3(columns - 1, rows - 1, heights - 1));
    const glm::ivec3 first = glm::min(glm::ivec3(at), glm::ivec3(columns, rows, heights) - 2);
    const glm::dvec3 share = at - glm::dvec3(first);
    climate::Growing growing;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 parts = glm::mix(1.0 - share, share, glm::dvec3(step));
        const auto weight = static_cast<float>(parts.x * parts.y * parts.z);
        const glm::ivec3 node = first + step;
        const auto texel = [&](int level) {
            return &values_[4 *
                            static_cast<std::size_t>((level * rows + node.y) * columns + node.x)];
        };
        const float* const ground = texel(node.z);
        growing.dryness += weight * ground[0];
        growing.growth += weight * ground[1];
        growing.temperature_c += weight * ground[3];
        growing.ice_m += weight * texel(heights + node.z)[0];
    }
    return growing;
}

void ClimateVolume::write(GroundBlock& block) const {
    block.climate_place = place_;
    block.climate_height = height_;
}

}  // namespace relevo::render
