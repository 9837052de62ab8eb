#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "chord.h"
#include "sky/air.h"

/// Radiance of a clear sky by Monte Carlo integration of the radiative transfer equation: the
/// reference that faster models are judged by.
///
/// Paths are followed from the eye back to the sun, over a spherical Earth with air up to
/// sky::kTopOfAir_m. All wavelengths share a path. At each scattering, and where a path meets the
/// ground (Lambertian), the light that comes straight from the sun is added (next-event
/// estimation), from a random point of its disc of 0.53 degrees. Scattering is forced: no path
/// leaves the atmosphere before its end. All orders are followed; Russian roulette ends the paths
/// without bias. Free paths are drawn where several wavelengths scatter and sunlight reaches;
/// directions by the phase functions and, with a low sun, also towards the bright horizon.
///
/// Not modelled: polarisation, which changes the radiance of Rayleigh skies by up to 10 % (M. I.
/// Mishchenko, A. A. Lacis, L. D. Travis, J. Quant. Spectrosc. Radiat. Transfer 51, 1994);
/// refraction, which lifts the sun by half a degree at the horizon; limb darkening.
///
/// Sources: D. G. Collins, W. G. Blattner, M. B. Wells, H. G. Horak, Backward Monte Carlo
/// Calculations of the Polarization Characteristics of the Radiation Emerging from
/// Spherical-Shell Atmospheres, Applied Optics 11, 1972; E. Veach, Robust Monte Carlo Methods for
/// Light Transport Simulation, 1997 (next-event estimation, multiple importance sampling).
namespace relevo::skymaker {

using sky::Spectrum;

/// What scatters and absorbs, at sky::kWavelengths wavelengths of the caller's choice.
struct Medium {
    sky::Extinction extinction{};
    double aerosol_albedo = sky::kAerosolAlbedo;
    double aerosol_asymmetry = sky::kAerosolAsymmetry;
    double ground_albedo = 0;
};
/// At sky::wavelength_um.
Medium medium_of(const sky::Air& air);

/// An eye and where it looks.
struct Sight {
    double height_m = 0;       ///< above sea level; may be above the air
    double elevation_rad = 0;  ///< of the direction, over the horizontal plane of the eye
    double azimuth_rad = 0;    ///< of the direction, from the sun's
};

/// Independent estimates of one quantity.
using Batches = std::vector<Spectrum>;
Spectrum mean(const Batches& batches);

/// A figure of the mean spectrum, and its standard error by how it differs between the batches.
struct Figure {
    double value = 0, standard_error = 0;
};
Figure figure(const Batches& batches, const std::function<double(const Spectrum&)>& of);

class PathIntegral {
  public:
    struct Effort {
        int batches = 32;
        int paths = 256;  ///< of each batch
        std::uint64_t seed = 1;
        int orders = 1000;  ///< highest order of scattering; the ground counts as one
    };

    /// @param sun_radius_rad  of the sun's disc; pi makes it the whole sphere
    PathIntegral(const Medium& medium, double sun_elevation_rad,
                 double sun_radius_rad = radians(0.2666));

    /// Radiance without the sun's disc, in the unit where a white diffuse surface that faces the
    /// sun outside the atmosphere has radiance 1.
    Batches radiance(const Sight& sight, const Effort& effort) const;

    /// Irradiance of a surface by sky and ground, without the sun's disc, as a share of the sun's
    /// outside the atmosphere.
    /// @param tilt_rad  of the surface, towards the sun's azimuth; level if 0
    Batches irradiance(double height_m, const Effort& effort, double tilt_rad = 0) const;

    /// Share of light that passes from the eye along a direction to space; 0 if the ground is
    /// there.
    Spectrum transmittance(const Sight& sight) const;

  private:
    struct Path;
    using Start = std::function<glm::dvec3(std::uint64_t&)>;
    struct Expected {
        std::array<double, Chord::kCells> cells{};
        std::array<Columns, Chord::kCells> before{};  // from the vertex to each cell
        Columns columns;                              // of the whole line
        double total = 0, ground_chance = 0;
    };
    struct Scattering {
        Spectrum rayleigh{}, aerosol{};  // [1/m]
    };

    Batches run(double height_m, const Start& direction, const Effort& effort) const;
    Spectrum follow(Path& path, int orders) const;
    Expected expect(const Path& path, const Chord& chord) const;
    void step(Path& path) const;
    void add_sunlight(const Path& path, Spectrum& sum) const;
    void scatter_in_air(Path& path) const;
    Scattering scattering(const glm::dvec3& at) const;
    double brightness(double height_m, double sun_sine) const;
    void tabulate_brightness();

    Medium medium_;
    glm::dvec3 sun_{};
    double sun_cap_ = 0;              // 1 - cosine of the sun's radius
    double lobe_ = 0;                 // share of directions drawn towards the bright horizon
    std::vector<double> brightness_;  // by height and sine of the sun
};

}  // namespace relevo::skymaker
