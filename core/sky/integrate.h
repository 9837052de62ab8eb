#pragma once

#include <span>

#include <glm/vec4.hpp>

#include "sky/air.h"
#include "sky/moments.h"
#include "sky/path.h"

namespace relevo::sky {

/// Share of the aerosol's scattering that counts as not scattered where light is followed: its
/// narrow forward peak, which harmonics of the fourth degree do not have. Of 0 to g^4, these meet
/// the path integral best, in clean and in turbid air. Light that is scattered once has the whole
/// phase function. Source: W. J. Wiscombe, The Delta-M Method, J. Atmos. Sci. 34, 1977; T. Nakajima
/// and M. Tanaka, Algorithms for Radiative Intensity Calculations in Moderately Thick Atmospheres
/// Using a Truncation Approximation, J. Quant. Spectrosc. Radiat. Transfer 40, 1988 (their TMS).
inline float forward_share(const Air& air) {
    return static_cast<float>(std::clamp(0.16 + 0.5 * (air.angstrom_beta - 0.04), 0.14, 0.4));
}

/// Scattering and absorption of an Air in single precision.
struct Coefficients {
    Values rayleigh, aerosol, ozone;  ///< Extinction
    Values aerosol_taken;             ///< the aerosol's without forward_share() of its scattering
    float forward;                    ///< forward_share()
    float albedo;                     ///< of the ground
};
Coefficients coefficients(const Air& air);

/// Light that the sun sends through the air to a place, as a share of that outside; 0 where the
/// disc is below the horizon of its height.
/// @param aerosol  extinction of the aerosol: one of the two of Coefficients
Values sunlight(const Coefficients& air, const Values& aerosol, double height_m, double sun_sine);

/// What a ray brings to an eye, for a sun of irradiance 1 outside the air: radiance [1/sr].
template <class Light>
struct BroughtAs {
    Light air{};      ///< scattered on the way, but for what the aerosol scatters of sunlight
    Light aerosol{};  ///< that, without its phase function: times aerosol_phase()
    Light ground{};   ///< what white ground at its end sends; 0 without ground
    /// Share of the light from its end that arrives, forward_share() with it.
    Values through{};
};
using Brought = BroughtAs<Values>;
/// The same as linear sRGB: colours are linear in the light, so that scattered light is followed by
/// three numbers instead of kWavelengths. Sunlight differs by up to 0.1 % from Brought's.
using BroughtColour = BroughtAs<glm::vec4>;

/// colour_of() in single precision; the fourth component is 0.
glm::vec4 colour(const Values& light);

/// What to follow: sunlight that is scattered once, light that is scattered further, or both.
struct Sources {
    bool sun = true;
    const DiffuseTable* diffuse = nullptr;
};

/// Where the sun stands at the eye.
struct Sun {
    double sine = 0;         ///< of its elevation
    double azimuth_cos = 1;  ///< of the angle between its azimuth and a ray's
};

/// Rays of one elevation at an eye: they pass the same air, each under another sun.
struct Rays {
    double height_m = 0;        ///< of the eye
    double sine = 0;            ///< of the rays' elevation
    std::span<const Sun> suns;  ///< one for each ray
};

/// Cosine of the angle between a ray and the sun.
double ray_sun_cosine(double ray_sine, const Sun& sun);

/// Integrates along rays. @param ends  of the steps: step_ends(), or a part of them
/// @param onwards  what the rays have brought up to the first of the ends; replaced by what they
///                 have brought up to the last
/// @param ground   adds the ground, which lies at the last end
void integrate(const Coefficients& air, const Sources& sources, const Rays& rays,
               std::span<const double> ends, bool ground, std::span<Brought> onwards);
void integrate(const Coefficients& air, const Sources& sources, const Rays& rays,
               std::span<const double> ends, bool ground, std::span<BroughtColour> onwards);

}  // namespace relevo::sky
