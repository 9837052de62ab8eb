#pragma once

#include <string>
#include <vector>

#include "geo/geodetic.h"

namespace relevo::sun {

/// The air at a place.
struct Air {
    double pressure_hpa = 1013.25;  ///< at the place, not reduced to sea level
    double temperature_c = 15;
};

/// The ICAO standard atmosphere.
/// @param height_m  above sea level, -5000 to 32000; beyond that the nearest of the two is taken
/// Source: ICAO Doc 7488, 1993.
Air standard_air(double height_m);

/// The atmosphere over a place, for numerical integration.
struct Atmosphere {
    Air air;
    double height_m = 0;  ///< of the place above sea level
    double latitude_rad = 0.7853981633974483;
    double lapse_k_per_m = 0.0065;   ///< how fast it grows colder, up to 11 km
    double relative_humidity = 0.5;  ///< at the place, 0 to 1
    double wavelength_um = 0.574;    ///< of the light; the eye's
};

/// How the air lifts the sun: elevations "true" (without air, as sun::position gives them) to
/// "apparent" (as seen) and back. Rays from the zenith down to the dip of the sea horizon and a
/// little lower (0.7 degrees from sea level, 0.15 from 2500 m); below that, refraction is held at
/// its value there, so that both directions stay defined.
///
/// Real air: seconds of arc above 10 degrees, 10 at 5 degrees; near the horizon it varies by
/// minutes of arc from day to day, whatever the model.
class Refraction {
  public:
    /// No air: apparent is true.
    static Refraction none();

    /// Saemundsson's formula for the true elevation, as JPL Horizons uses it: by default for 1010
    /// hPa and 10 degrees C, frozen at its value of one degree below the horizon.
    /// @throws Error (BadInput) for air that is none
    /// Accuracy: against integration 5 arcsec above 10 degrees, 36 at 2-10, 400 below 2. JPL
    /// Horizons' own refraction to 0.003 arcsec (tests/sun/test_position.cpp).
    /// Source: Saemundsson, Sky & Telescope 72 (1986) 70; Meeus, Astronomical Algorithms, 16.4.
    static Refraction saemundsson(const Air& air = {1010, 10});

    /// Numerical integration through a troposphere of constant lapse, with water vapour, and an
    /// isothermal stratosphere, once, into a table of 512 entries.
    /// @throws Error (BadInput) for air or a height that is none
    /// Accuracy: 0.1 arcsec against Starlink's palRefro in six atmospheres, -430 m to 5364 m, from
    /// half a degree below the horizon up (tests/sun/test_refraction.cpp).
    /// Source: Hohenkerk and Sinclair, NAO Technical Note 63 (1985); Explanatory Supplement to the
    /// Astronomical Almanac (1992), 3.281; Auer and Standish, Astron. J. 119 (2000) 2472.
    static Refraction integrated(const Atmosphere& atmosphere);

    /// Integrated, for the ICAO standard atmosphere at the place's height. Above 31 km, over all
    /// but a hundredth of the air, none: a level ray bends by 27 arcsec there
    /// (tests/sun/test_refraction.cpp). Lower than -1400 m there is no land but a sea's floor, over
    /// which the air of sea level is taken.
    static Refraction standard(const geo::Geodetic& place);

    double apparent_rad(double true_rad) const;
    double true_rad(double apparent_rad) const;

    bool bends() const { return model_ != Model::None; }

    /// For results: "integrated atmosphere, 899 hPa, 8.5 C, 1000 m".
    const std::string& description() const { return description_; }

  private:
    enum class Model { None, Saemundsson, Table };

    /// Refraction over elevation; nodes lie the denser the lower.
    struct Table {
        double lowest_rad = 0;
        std::vector<double> refraction_rad;
        double node_rad(int node) const;
        double at(double elevation_rad) const;
    };

    Model model_ = Model::None;
    std::string description_ = "no refraction";
    double strength_ = 1;  // Saemundsson: of the air, 1 at 1010 hPa and 10 C
    Table of_true_, of_apparent_;
};

}  // namespace relevo::sun
