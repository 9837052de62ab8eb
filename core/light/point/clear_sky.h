#pragma once

/// What the sun and the sky give through air without clouds.
namespace relevo::light {

/// The clear-sky model of the European Solar Radiation Atlas, as r.sun has it: beam and diffuse
/// irradiance by the Linke turbidity of the air, the air's mass over the height of the ground.
/// Source: Rigollier, Bauer and Wald, Solar Energy 68 (2000) 33; Rayleigh optical thickness of
/// Kasten 1996, air mass of Kasten and Young 1989; Hofierka and Suri, GRASS users conference 2002.
/// Accuracy: tests/light/test_clear_sky.cpp, against what r.sun is expected to give.
class ClearSky {
  public:
    static constexpr double kSolarConstant = 1367;  ///< [W/m2] at the mean distance

    /// @param linke        turbidity: 2 over clean mountains, 3 in the country, 4 to 6 over cities
    /// @param distance_au  to the sun
    ClearSky(double linke, double distance_au);

    /// Irradiance of a surface that faces the sun [W/m2]; 0 under the level horizon.
    /// @param elevation_rad  of the sun's centre, without air
    /// @param height_m       of the ground over the sea
    double beam(double elevation_rad, double height_m) const;

    /// Irradiance of a level surface by an open sky [W/m2].
    double diffuse(double elevation_rad) const;

  private:
    double linke_, outside_;  // the latter [W/m2] over the air
    double transmission_, a1_, a2_, a3_;
};

}  // namespace relevo::light
