#pragma once

#include <span>
#include <vector>

#include "sky/air.h"
#include "sky/integrate.h"
#include "sky/moments.h"
#include "sky/sun_rays.h"

namespace relevo::sky {

/// The light of a clear, round atmosphere that the sun alone lights: seen from any height, also
/// from outside, in any direction. Sky, haze, the light of the ground and the ground of the Earth
/// around all come from it.
///
/// Tables for an air: the columns of its constituents towards space (so that any wavelength
/// follows by an exponential), and the diffuse light by height and sun, as spherical harmonics up
/// to the fourth degree. Orders of scattering follow each other until what is left is a geometric
/// series. S. Hillaire's model, which this follows elsewhere, takes all orders from the second on
/// as isotropic and local to a place: at dusk, when light comes from beyond the horizon, it is
/// wrong by factors.
///
/// Units: radiance 1 is that of a white diffuse surface which faces the sun outside the atmosphere;
/// irradiance 1 is that of the sun there. Spectra are shares of the sun's.
/// Accuracy: against an independent path integral, tests/sky/test_atmosphere.cpp.
/// Source: S. Hillaire, A Scalable and Production Ready Sky and Atmosphere Rendering Technique,
/// Computer Graphics Forum 39(4), 2020; E. Bruneton and F. Neyret, Precomputed Atmospheric
/// Scattering, Computer Graphics Forum 27(4), 2008, for its orders of scattering; R. Ramamoorthi
/// and P. Hanrahan, An Efficient Representation for Irradiance Environment Maps, SIGGRAPH 2001, for
/// harmonics of the second degree.
class Atmosphere {
  public:
    /// Distance beyond the end of every ray [m].
    static constexpr double kWhole_m = 1e9;

    /// Computes the tables: 4.3 s of processor time, 2.2 s on two processors.
    explicit Atmosphere(const Air& air = {});
    /// Takes the diffuse light of that air as it was computed before.
    Atmosphere(const Air& air, DiffuseTable diffuse);

    const Coefficients& coefficients() const { return coefficients_; }
    const DiffuseTable& diffuse() const { return diffuse_; }

    /// Where one looks from, and where to.
    struct View {
        double height_m = 0;     ///< of the eye above sea level; below 0 counts as 0
        double sine = 0;         ///< of the direction's elevation
        double sun_sine = 0;     ///< of the sun's elevation at the eye
        double azimuth_cos = 1;  ///< cosine of the horizontal angle between the two
    };
    /// Radiance without the sun's disc, up to the top of the air or to the ground, which is seen.
    Spectrum radiance(const View& view) const;
    /// The same for air up to a distance: the light that it adds to that of an object there.
    Spectrum scattered_in(const View& view, double distance_m) const;
    /// What rays of one elevation bring up to a distance, each under another sun.
    std::vector<Brought> brought(double height_m, double sine, std::span<const Sun> suns,
                                 double distance_m = kWhole_m) const;
    /// Share of light that passes along a ray up to a distance, or to the ray's end.
    Spectrum transmittance(double height_m, double sine, double distance_m) const;

    /// Sunlight on a surface that faces the sun: the mean over its disc, of which what is below the
    /// horizon of the sea sends nothing. @param elevation_rad  of its centre, geometric
    Spectrum sunlight(const SunRays& rays, double elevation_rad) const;
    /// Light of the sky on level ground, without the sun's disc.
    Spectrum sky_irradiance(double height_m, double sun_sine) const;

  private:
    Coefficients coefficients_;
    DiffuseTable diffuse_;
};

}  // namespace relevo::sky
