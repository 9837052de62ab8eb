#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "viewer/navigation.h"
#include "viewer/scene_thread.h"

/// What is drawn over the picture.
namespace relevo::viewer {

/// The ground along a geodesic.
struct Profile {
    std::vector<float> heights_m;  ///< at even steps from end to end, NaN at holes
    double level_m = 0;            ///< along the ellipsoid
    double azimuth_rad = 0;        ///< of the way, where it begins, from true north
    double surface_m = 0;          ///< over the ground, up and down, holes left out
    double up_m = 0, down_m = 0;   ///< together
    bool has_holes = false;

    static Profile between(const geo::Geodetic& from, const geo::Geodetic& to, const Land& land);
};

/// @param points  of the ground, at most two
void draw_measured(const std::vector<glm::dvec3>& points, const std::optional<Profile>& profile,
                   const Picture& picture, glm::vec2 size_px);
void profile_panel(const Profile& profile);

/// "2.9 degrees, facing S".
/// @param slope_deg   NaN: the text is empty
/// @param aspect_deg  downhill, from true north; NaN on level ground
std::string slope_text(double slope_deg, double aspect_deg);

/// What is on which side of a comparison's line.
/// @param line_px  from the left edge
void draw_sides(float line_px, float top_px);

/// @param middle_m  ground in the picture's middle; without it there is no scale
/// @param top_px    that something else has at the upper edge
void draw_scale_and_north(const Picture& picture, const Land& land,
                          const std::optional<glm::dvec3>& middle_m, glm::vec2 size_px,
                          float top_px);

void key_sheet();

}  // namespace relevo::viewer
