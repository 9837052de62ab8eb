#include <algorithm>
#include <cmath>
#include <random>

#include "base/units.h"
#include "geo/local_frame.h"
#include "support/support.h"

namespace relevo::geo {
namespace {

// NIMA TR8350.2 (3rd edition, amendment 1), table 3.1.
constexpr double kA_m = 6378137.0;
constexpr double kF = 1 / 298.257223563;
constexpr double kE2 = kF * (2 - kF);

/// Earth-centred coordinates from the closed formula, IOGP guidance note 7-2, section
/// "Geographic/Geocentric conversions" (EPSG method 9602).
glm::dvec3 geocentric(const Geodetic& p) {
    const double nu = kA_m / std::sqrt(1 - kE2 * std::pow(std::sin(p.lat_rad), 2));
    return {(nu + p.height_m) * std::cos(p.lat_rad) * std::cos(p.lon_rad),
            (nu + p.height_m) * std::cos(p.lat_rad) * std::sin(p.lon_rad),
            ((1 - kE2) * nu + p.height_m) * std::sin(p.lat_rad)};
}

glm::dvec3 east_of(const Geodetic& p) {
    return {-std::sin(p.lon_rad), std::cos(p.lon_rad), 0};
}

glm::dvec3 north_of(const Geodetic& p) {
    return {-std::sin(p.lat_rad) * std::cos(p.lon_rad), -std::sin(p.lat_rad) * std::sin(p.lon_rad),
            std::cos(p.lat_rad)};
}

glm::dvec3 up_of(const Geodetic& p) {
    return {std::cos(p.lat_rad) * std::cos(p.lon_rad), std::cos(p.lat_rad) * std::sin(p.lon_rad),
            std::sin(p.lat_rad)};
}

/// A geocentric vector seen in the frame of `origin`.
glm::dvec3 rotated(const Geodetic& origin, const glm::dvec3& v) {
    return {glm::dot(v, east_of(origin)), glm::dot(v, north_of(origin)),
            glm::dot(v, up_of(origin))};
}

double worst(const std::vector<double>& errors) {
    return *std::max_element(errors.begin(), errors.end());
}

TEST(LocalFrame, GeographicLibsOwnExample) {
    // CartConvert(1), EXAMPLES: cut, not rounded, after 1 cm.
    const glm::dvec3 local =
        LocalFrame(geodetic_deg(33, 44, 20)).to_local(geodetic_deg(33.3, 44.4, 6000));
    EXPECT_NEAR(local.x, 37288.97, 0.01);
    EXPECT_NEAR(local.y, 33374.29, 0.01);
    EXPECT_NEAR(local.z, 5783.64, 0.01);
}

TEST(LocalFrame, TopocentricExampleOfGuidanceNote7) {
    // IOGP publication 373-7-2, "Geographic/topocentric conversions" (EPSG method 9837): origin
    // 55 N, 5 E, 200 m; place 53°48'33.820"N, 2°07'46.380"E, 73.0 m. The place is printed to
    // 0.001", 3 cm; the result to 1 mm.
    const Geodetic place =
        geodetic_deg(53 + 48 / 60.0 + 33.82 / 3600, 2 + 7 / 60.0 + 46.38 / 3600, 73);
    const glm::dvec3 local = LocalFrame(geodetic_deg(55, 5, 200)).to_local(place);
    EXPECT_NEAR(local.x, -189013.869, 0.03);
    EXPECT_NEAR(local.y, -128642.040, 0.03);
    EXPECT_NEAR(local.z, -4220.171, 0.03);
}

TEST(LocalFrame, OriginIsZero) {
    const Geodetic origin = geodetic_deg(47.3, 11.4, 2000);
    EXPECT_LT(glm::length(LocalFrame(origin).to_local(origin)), 1e-8);
}

TEST(LocalFrame, PointDueNorthHasZeroEast) {
    const glm::dvec3 local = LocalFrame(geodetic_deg(47, 11)).to_local(geodetic_deg(48, 11));
    EXPECT_NEAR(local.x, 0, 1e-8);
    EXPECT_GT(local.y, 111000);
}

TEST(LocalFrame, PointAboveTheOriginHasOnlyUp) {
    const glm::dvec3 local =
        LocalFrame(geodetic_deg(-34, 20.5, 300)).to_local(geodetic_deg(-34, 20.5, 1300));
    EXPECT_NEAR(local.x, 0, 1e-8);
    EXPECT_NEAR(local.y, 0, 1e-8);
    EXPECT_NEAR(local.z, 1000, 1e-8);
}

TEST(LocalFrame, TheEarthFallsAwayWithDistance) {
    // Along the equator the section is a circle: at the arc s the drop is a (1 - cos(s / a)).
    const double arc_deg = 0.5;
    const glm::dvec3 local = LocalFrame(geodetic_deg(0, 0)).to_local(geodetic_deg(0, arc_deg));
    EXPECT_NEAR(local.z, -kA_m * (1 - std::cos(radians(arc_deg))), 1e-7);
}

TEST(LocalFrame, AgreesWithAWrittenOutGeocentricComputation) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> lat(-90, 90);
    std::uniform_real_distribution<double> lon(-180, 180);
    std::uniform_real_distribution<double> offset_deg(-5, 5);
    std::uniform_real_distribution<double> height_m(-6000, 9000);
    std::vector<double> errors_mm;
    std::vector<double> back_um;
    for (int i = 0; i < 2000; ++i) {
        const Geodetic origin = geodetic_deg(lat(random), lon(random), height_m(random));
        const double place_lat =
            std::clamp(degrees(origin.lat_rad) + offset_deg(random), -90.0, 90.0);
        const Geodetic place =
            geodetic_deg(place_lat, degrees(origin.lon_rad) + offset_deg(random), height_m(random));
        const LocalFrame frame(origin);
        const glm::dvec3 expected = rotated(origin, geocentric(place) - geocentric(origin));
        const glm::dvec3 local = frame.to_local(place);
        errors_mm.push_back(glm::distance(local, expected) * 1000);
        back_um.push_back(glm::distance(geocentric(frame.to_geodetic(local)), geocentric(place)) *
                          1e6);
    }
    EXPECT_LT(worst(errors_mm), 1);
    EXPECT_LT(worst(back_um), 1);
    test::print_accuracy("ENU against written-out geocentric", errors_mm, "mm", 1);
    test::print_accuracy("ENU there and back", back_um, "um", 1);
}

TEST(LocalFrame, AxesAreThoseOfThePlaceTurnedIntoTheFrame) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> lat(-90, 90);
    std::uniform_real_distribution<double> lon(-180, 180);
    for (int i = 0; i < 200; ++i) {
        const Geodetic origin = geodetic_deg(lat(random), lon(random), 500);
        const Geodetic place = geodetic_deg(lat(random), lon(random));
        const LocalFrame frame(origin);
        const Axes axes = frame.axes(place.lat_rad, place.lon_rad);
        EXPECT_LT(glm::distance(axes.east, rotated(origin, east_of(place))), 1e-14);
        EXPECT_LT(glm::distance(axes.north, rotated(origin, north_of(place))), 1e-14);
        EXPECT_LT(glm::distance(axes.up, rotated(origin, up_of(place))), 1e-14);
        EXPECT_EQ(frame.up(place.lat_rad, place.lon_rad), axes.up);
        EXPECT_LT(glm::distance(glm::cross(axes.east, axes.north), axes.up), 1e-14);
    }
}

TEST(LocalFrame, UpIsWhereHeightGrows) {
    const LocalFrame frame(geodetic_deg(46, 8));
    const glm::dvec3 low = frame.to_local(geodetic_deg(46.9, 9.3, 0));
    const glm::dvec3 high = frame.to_local(geodetic_deg(46.9, 9.3, 1000));
    EXPECT_LT(glm::distance((high - low) / 1000.0, frame.up(radians(46.9), radians(9.3))), 1e-11);
}

TEST(LocalFrame, WorksAtThePole) {
    // At the pole the frame's north is the meridian opposite to the origin's longitude.
    const LocalFrame frame(geodetic_deg(90, 0));
    const glm::dvec3 local = frame.to_local(geodetic_deg(89, 180));
    EXPECT_NEAR(local.x, 0, 1e-8);
    EXPECT_GT(local.y, 111000);
}

TEST(LocalFrame, CopiesAreEqualAndIndependent) {
    const Geodetic place = geodetic_deg(47.1, 11.2, 10);
    LocalFrame a(geodetic_deg(47, 11));
    const LocalFrame b = a;
    EXPECT_EQ(a.to_local(place), b.to_local(place));
    a = LocalFrame(geodetic_deg(0, 0));
    EXPECT_EQ(b.origin(), geodetic_deg(47, 11));
    EXPECT_NE(a.to_local(place), b.to_local(place));
    a = b;
    EXPECT_EQ(a.to_local(place), b.to_local(place));
}

}  // namespace
}  // namespace relevo::geo
