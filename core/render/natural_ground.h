#pragma once

#include <array>
#include <cstdint>
#include <future>
#include <optional>
#include <string_view>
#include <vector>

#include "climate/climate_map.h"
#include "climate/land_classes.h"
#include "climate/land_map.h"
#include "dem/pyramid.h"
#include "geo/local_frame.h"
#include "gl/texture.h"
#include "render/climate_volume.h"
#include "render/frame_block.h"

namespace relevo::render {

/// Samplers in lib/land.glsl.
inline constexpr const char* kLandClassesTexture = "land_classes";
inline constexpr const char* kLandAroundTexture = "land_around";

using LandTexel = std::array<std::uint8_t, 4>;
/// Of the textures, by level.
struct LandTexels {
    std::vector<std::vector<LandTexel>> classes, around;
};

/// What nature and people make of a DEM's ground: tables of the climate, and of what covers land,
/// made when programs first read them.
class NaturalGround {
  public:
    /// @param grid, frame, pyramid  must outlive this
    /// @param climate_alone         land cover is not known
    NaturalGround(const dem::Grid& grid, const geo::LocalFrame& frame, const dem::Pyramid& pyramid,
                  bool climate_alone)
        : grid_(grid), frame_(frame), pyramid_(pyramid), climate_alone_(climate_alone) {}

    /// The climate map, read when first needed.
    /// @throws Error (BadInput) if it is missing or damaged; so do the others
    const climate::ClimateMap& climate_map();

    /// Updates the climate's tables to the snow of a day, 0 to 364, and writes where they are.
    void update_climate(int day, GroundBlock& block);
    /// Begins to make the textures of land cover and rivers, in the background, and writes where
    /// they are.
    void update_land(GroundBlock& block);
    /// By the sampler's name; null for others, and before the updates. Waits for the background.
    const gl::Texture* texture(std::string_view name) const;

  private:
    /// Height of the ground around a place, at the coarsest level [m]; NaN outside of the DEM.
    float mean_height_m(const geo::Geodetic& place) const;
    void make_climate();
    int level_of_sites() const;
    climate::LandSites sites() const;
    std::vector<LandTexel> classes_around(const climate::LandMap& map,
                                          const climate::Box& box) const;
    /// @param map  null: land cover is not known
    LandTexels make_land(const climate::LandMap* map, const climate::Box& box) const;
    void begin_land();
    void finish_land() const;
    /// An array with all of its levels. @param extent  of the first; layers as z
    static gl::Texture texture_of(const std::vector<std::vector<LandTexel>>& levels,
                                  const glm::ivec3& extent, const char* name);

    const dem::Grid& grid_;
    const geo::LocalFrame& frame_;
    const dem::Pyramid& pyramid_;
    bool climate_alone_;
    std::optional<climate::ClimateMap> climate_map_;
    std::optional<ClimateVolume> climate_;
    mutable gl::Texture land_classes_, land_around_;
    glm::vec4 land_place_{0};
    float country_m_ = 0;  // height of the level country around
    bool has_land_ = false, knows_land_ = false;
    // Last member: its thread reads the members above.
    mutable std::future<LandTexels> making_;
};

}  // namespace relevo::render
