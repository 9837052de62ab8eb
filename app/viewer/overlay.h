#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "chart/drawing.h"
#include "viewer/navigation.h"
#include "viewer/scene_thread.h"

/// Drawings over the image: measured line, scale, north arrow, sheet of keys.
namespace relevo::viewer {

/// The terrain profile along a geodesic.
struct Profile {
    std::vector<float> heights_m;  ///< at equal steps from end to end; NaN in voids
    double level_m = 0;            ///< length along the ellipsoid
    double azimuth_rad = 0;        ///< at the start, from true north
    double surface_m = 0;          ///< length along the ground without voids
    double up_m = 0, down_m = 0;   ///< total ascent and descent
    bool has_holes = false;

    static Profile between(const geo::Geodetic& from, const geo::Geodetic& to, const Land& land);
};

/// A measured line on the ground. Its second end follows the cursor until the user sets it.
struct Measurement {
    std::vector<glm::dvec3> ends_m;  ///< in the local frame, at most two
    std::optional<Profile> profile;  ///< of a line with two ends
    bool follows_cursor = false;

    /// Replaces the line with its first end.
    void start(const glm::dvec3& point_m);
    /// Moves the second end.
    void follow(const glm::dvec3& point_m, const Land& land);
};

void draw_measurement(const Measurement& measurement, const Picture& picture, glm::vec2 size_px);
void profile_panel(const Profile& profile);

/// "2.9 degrees, facing S".
/// @param slope_deg   NaN: the text is empty
/// @param aspect_deg  downhill, from true north; NaN on level ground
std::string slope_text(double slope_deg, double aspect_deg);

/// Labels for both sides of a comparison's dividing line.
/// @param line_px  from the left edge
void draw_sides(float line_px, float top_px);

/// Where the north arrow is in the window.
chart::Rect north_place(glm::vec2 size_px, float top_px);

/// @param middle_m  ground at the centre of the image; none: no scale bar
/// @param top_px    height of the menu
void draw_scale_and_north(const Picture& picture, const Land& land,
                          const std::optional<glm::dvec3>& middle_m, glm::vec2 size_px,
                          float top_px);

void key_sheet();

}  // namespace relevo::viewer
