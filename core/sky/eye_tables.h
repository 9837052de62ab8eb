#pragma once

#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "sky/atmosphere.h"

/// What an eye at a height sees of the air under a sun, as tables of colours that shaders read
/// (shaders/lib/air.glsl has the same coordinates). Linear sRGB; radiance 1 is that of a white
/// diffuse surface which faces the sun outside the atmosphere.
namespace relevo::sky {

/// Coordinates of the tables, all from 0 to 1, 0 and 1 at the centres of the outer texels.
struct EyeLayout {
    // Of the sky: rows above the horizon, then rows below it.
    static constexpr int kAzimuths = 40, kAbove = 72, kBelow = 32;
    static constexpr double kEven = 0.2;  ///< share of the rows that are even in the sine
    static constexpr int kLayers = 3;     ///< air, aerosol, ground: EyeTables::sky
    // Of the air between.
    static constexpr int kBetweenAzimuths = 24, kBetweenElevations = 48, kDistances = 28;

    double height_m = 0;
    double horizon = 0;  ///< sine of its elevation
    /// Share of the sines above the horizon, from it on, that about half of the rows have.
    double above_band = 1;
    double below_band = 1;  ///< the same below
    /// Distance at the last slice of level rays, and of the horizon, from where rays enter the air.
    double farthest_m = 1, horizon_m = 1;

    explicit EyeLayout(double height_m);

    /// Cosine of the angle from the sun's azimuth.
    static double azimuth_cos(double u) { return 1 - 2 * u * u; }
    /// Place of an elevation above or below the horizon: dense at the horizon.
    /// @param away  0 on the horizon, 1 in the zenith or nadir: linear in the sine
    static double place_of(double away, double band);
    double sine_above(double v) const;
    double sine_below(double v) const;
    /// For the air between: 0 at the nadir, 0.5 at the horizon, 1 at the zenith.
    double sine_between(double v) const;
    /// Distance of a slice, from where the ray enters the air: those of an eye above kHigh_m are
    /// dense at the ground, where most air is, those of others at the eye.
    double distance_m(double w, double sine) const;
    static constexpr double kHigh_m = 10e3;

  private:
    double reach_m(double sine) const;
};

/// Which tables are made: the other ones are empty.
struct EyeParts {
    bool sky = true, between = true;
    bool operator==(const EyeParts&) const = default;
};

struct EyeTables {
    EyeLayout layout;
    /// By layer, elevation, azimuth; rgb. Layers:
    /// - light that the air scatters towards the eye, without that of the next layer;
    /// - sunlight that the aerosol scatters once, over aerosol_phase(): the aureole is too sharp
    ///   for the table;
    /// - light of white ground at the end of the rays below the horizon.
    std::vector<glm::vec4> sky;
    /// By order, distance, elevation, azimuth. rgb: light scattered towards the eye over what the
    /// air between takes away, 1 - exp(-a distance colour), first that of light scattered more than
    /// once, then that of sunlight scattered once; a: mean extinction of green light on the way
    /// [1/m].
    std::vector<glm::vec4> between;
    static constexpr int kOrders = 2;
    /// Extinction in red, green and blue, relative to that of green light.
    glm::vec3 colour;
};

/// @param sun_sine  of the sun's geometric elevation at the eye: most light of dusk comes from air
///                  so high that it hardly bends light
EyeTables eye_tables(const Atmosphere& air, double height_m, double sun_sine,
                     const EyeParts& parts = {});

/// The eye's height [m] and the sine of the sun's elevation that tables are made for instead of
/// others near them, so that a camera on its way needs new ones a few times a second only. They
/// change luminance by at most 1.5 % (EyeTables.AreMadeForHeightsAndSunsNearby).
double nearest_eye_height_m(double height_m);
double nearest_sun_sine(double sine);

}  // namespace relevo::sky
