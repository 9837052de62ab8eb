#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "geo/geodetic.h"
#include "viewer/navigation.h"

/// Measuring on the ground: lines with corners, their profile, area and line of sight.
namespace relevo::viewer {

/// Ground on a profile.
struct ProfilePoint {
    double distance_m = 0;  ///< from the beginning, along the ellipsoid
    geo::Geodetic place;    ///< height of the DEM; NaN in voids
};

/// The terrain profile along geodesics from corner to corner.
struct Profile {
    std::vector<ProfilePoint> points;
    double level_m = 0;                  ///< length along the ellipsoid
    double azimuth_rad = 0;              ///< at the beginning, from true north
    double back_rad = 0;                 ///< at the end, looking back along the last leg
    double surface_m = 0;                ///< length along the ground without voids
    double up_m = 0, down_m = 0;         ///< total ascent and descent
    double lowest_m = 0, highest_m = 0;  ///< NaN without heights
    bool has_voids = false;

    /// @param corners    two or more
    /// @param spacing_m  between points, as posts of the DEM; 400 to 4000 points are made
    static Profile along(std::span<const geo::Geodetic> corners, const Land& land,
                         double spacing_m);
};

/// What a person at the beginning of a profile sees of its end.
struct LineOfSight {
    double missing_m = 0;  ///< the end is visible from this much higher; at most 0: it is visible
    ProfilePoint highest;  ///< the ground that stands highest on the line
};

/// Over a round Earth with a terrestrial refraction of 0.13, as `relevo sun horizon`.
/// @param eye_m, target_m  heights above the ground at the beginning and at the end
/// @returns none: an end lies in a void, or nothing is between the ends
std::optional<LineOfSight> line_of_sight(const Profile& profile, double eye_m, double target_m);

/// A line on the ground. Its last corner follows the cursor until the user sets it.
struct Measurement {
    std::vector<glm::dvec3> corners_m;  ///< in the local frame
    std::optional<Profile> profile;     ///< of two or more corners
    std::optional<double> area_m2;      ///< on the ellipsoid; none: no area, or it crosses itself
    bool crosses_itself = false;
    std::vector<glm::dvec3> line_m;  ///< the profile on the drawn ground, in the local frame
    bool follows_cursor = false;
    float eye_m = 1.7f, target_m = 0;   ///< of the line of sight
    std::optional<std::size_t> marked;  ///< of `line_m`: the point under the cursor of the panel

    /// Replaces the line with its first corner.
    void start(glm::dvec3 point_m);
    /// From here on follow() moves a further corner.
    void measure() { follows_cursor = !corners_m.empty(); }
    /// Moves the last corner.
    void follow(const glm::dvec3& point_m, const Land& land, double spacing_m);
    /// Sets the last corner; the next one follows the cursor.
    void set_corner(const glm::dvec3& point_m, const Land& land, double spacing_m);
    /// Removes the last corner that was set.
    void drop_corner(const Land& land, double spacing_m);
    /// The line stays as it is.
    void end();

  private:
    void work_out(const Land& land, double spacing_m);
    std::size_t set_ = 0;  // corners that do not move
};

/// "distance_m,latitude_deg,longitude_deg,height_m" and a row for each point; voids have no height.
std::string csv_text(const Profile& profile);

}  // namespace relevo::viewer
