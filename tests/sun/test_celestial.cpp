#include <cmath>

#include <erfa.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/units.h"
#include "sun/celestial.h"
#include "sun/earth_rotation.h"
#include "support/support.h"

namespace relevo::sun::test_celestial {
namespace {

struct Star {
    const char* name;
    double ra_deg, dec_deg;  // ICRS
};
// ESA, The Hipparcos and Tycho Catalogues (1997), epoch J2000.
constexpr Star kStars[] = {{"Sirius", 101.28716, -16.71612},  {"Vega", 279.23473, 38.78369},
                           {"Polaris", 37.95456, 89.26411},   {"Betelgeuse", 88.79294, 7.40706},
                           {"Alnilam", 84.05339, -1.20192},   {"Acrux", 186.64956, -63.09909},
                           {"Aldebaran", 68.98016, 16.50930}, {"sigma Oct", 317.19, -88.9565}};

struct Place {
    double lat_deg, lon_deg, height_m;
};
constexpr Place kPlaces[] = {
    {46.6, 8.0, 2000}, {-34.0, 20.4, 100}, {0, -78.5, 2800}, {89.9, 0, 0}, {-77.8, 166.7, 10}};

glm::dvec3 spherical(double longitude_rad, double latitude_rad) {
    return {std::cos(latitude_rad) * std::cos(longitude_rad),
            std::cos(latitude_rad) * std::sin(longitude_rad), std::sin(latitude_rad)};
}

TEST(CelestialFrame, StarsStandWhereErfaSeesThem) {
    double worst_arcsec = 0;
    for (const CivilTime& when :
         {CivilTime{{1973, 5, 4}, 3, 2, 1}, CivilTime{{2000, 1, 1}, 12, 0, 0},
          CivilTime{{2026, 1, 15}, 22, 0, 0}, CivilTime{{2026, 7, 30}, 1, 30, 0}}) {
        const Instant utc = Instant::from_utc(when);
        const EarthOrientation earth = EarthRotation::built_in().at(utc);
        double day1 = 0, day2 = 0;
        ASSERT_EQ(eraDtf2d("UTC", when.date.year, when.date.month, when.date.day, when.hour,
                           when.minute, when.second, &day1, &day2),
                  0);
        for (const Place& at : kPlaces) {
            const geo::Geodetic place = geo::geodetic_deg(at.lat_deg, at.lon_deg, at.height_m);
            const CelestialFrame frame = celestial_frame(Epoch::at(utc), place);
            for (const Star& star : kStars) {
                double azimuth = 0, zenith = 0, hour_angle, dec, ra, origins;
                ASSERT_EQ(eraAtco13(radians(star.ra_deg), radians(star.dec_deg), 0, 0, 0, 0, day1,
                                    day2, earth.ut1_minus_utc_s, place.lon_rad, place.lat_rad,
                                    place.height_m, earth.pole_x_rad, earth.pole_y_rad, 0, 0, 0,
                                    0.55, &azimuth, &zenith, &hour_angle, &dec, &ra, &origins),
                          0);
                const glm::dvec3 seen{std::sin(zenith) * std::sin(azimuth),
                                      std::sin(zenith) * std::cos(azimuth), std::cos(zenith)};
                const glm::dvec3 found = normalize(frame.axes * seen - frame.velocity);
                const double apart_arcsec =
                    degrees(
                        distance(found, spherical(radians(star.ra_deg), radians(star.dec_deg)))) *
                    3600;
                EXPECT_LT(apart_arcsec, 0.05)
                    << star.name << " " << at.lat_deg << " " << when.date.year;
                worst_arcsec = std::max(worst_arcsec, apart_arcsec);
            }
        }
    }
    fmt::print("[ accuracy ] stars against eraAtco13: worst {:.4f} arcsec\n", worst_arcsec);
}

TEST(CelestialFrame, IsARotationAndTheEarthsSpeed) {
    const CelestialFrame frame = celestial_frame(Epoch::at(Instant::from_utc({{2026, 1, 15}, 22})),
                                                 geo::geodetic_deg(46.6, 8, 0));
    const glm::dmat3 product = frame.axes * transpose(frame.axes);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            EXPECT_NEAR(product[i][j], i == j, 1e-12);
    EXPECT_NEAR(determinant(frame.axes), 1, 1e-12) << "not mirrored";
    // 30.3 km/s soon after the perihelion: 20.8 arcsec of aberration.
    EXPECT_NEAR(degrees(length(frame.velocity)) * 3600, 20.8, 0.3);
}

TEST(CelestialFrame, RejectsWhatIsNoPlace) {
    const Epoch epoch = Epoch::at(Instant::from_utc({{2026, 1, 15}, 22}));
    EXPECT_EQ(test::error_of([&] {
                  celestial_frame(epoch, {.lat_rad = radians(91), .lon_rad = 0, .height_m = 0});
              }),
              "exit 3: sun: latitude 91: no such place, expected -90 to 90 degrees; "
              "latitude comes before longitude");
}

}  // namespace
}  // namespace relevo::sun::test_celestial
