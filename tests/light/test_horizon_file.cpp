#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/units.h"
#include "light/plane/horizon_file.h"
#include "support/support.h"

namespace relevo::light::test_horizon_file {
namespace {

const geo::Geodetic kNorth = geo::geodetic_deg(45, 8), kSouth = geo::geodetic_deg(-33, -70);

FileHorizon read(const std::string& text, const geo::Geodetic& place = kNorth) {
    const std::filesystem::path path = test::scratch_dir() / "horizon.txt";
    std::ofstream(path, std::ios::binary) << text;
    return read_horizon(path.string(), "--horizon", place.lat_rad < 0);
}

double height_deg(const FileHorizon& horizon, double azimuth_deg) {
    return degrees(horizon.skyline().elevation_rad(radians(azimuth_deg)));
}

TEST(HorizonFile, IsLinearBetweenItsDirectionsAndGoesRound) {
    const FileHorizon horizon = read("azimuth,elevation\n10,5\n100,20\n300,-1\n");
    EXPECT_EQ(horizon.directions.size(), 3U);
    EXPECT_NEAR(height_deg(horizon, 10), 5, 1e-9);
    EXPECT_NEAR(height_deg(horizon, 55), 12.5, 1e-9);
    EXPECT_NEAR(height_deg(horizon, 200), 9.5, 1e-9);
    EXPECT_NEAR(height_deg(horizon, 335), 2, 1e-9);
    EXPECT_NEAR(height_deg(horizon, 0), -1 + 60 * 6.0 / 70, 1e-9);
}

TEST(HorizonFile, EachFormatHasItsNorth) {
    // 10 degrees in the east.
    const FileHorizon heights = read("0\n10\n0\n0\n");
    const FileHorizon pvlib =
        read("horizon_azimuth,horizon_elevation\n0,0\n90,10\n180,0\n270,0\n360,0\n");
    const FileHorizon pvsyst = read("Site\nAzimuth, height\n-180 0\n-90 10\n0 0\n90 0\n");
    const FileHorizon own =
        read("# remark\nazimuth_deg,horizon_deg,distance_m\n0,0,\n90,10,5\n180,0,7\n270,0,\n");
    for (const FileHorizon& horizon : {heights, pvlib, pvsyst, own})
        for (const double azimuth : {0.0, 45.0, 90.0, 135.0, 270.0})
            EXPECT_NEAR(height_deg(horizon, azimuth),
                        std::max(0.0, 10 - std::abs(azimuth - 90) / 9), 1e-9)
                << horizon.description << " " << azimuth;
    // On the southern half 0 is north, and east is still -90.
    const FileHorizon south = read("Site\nAzimuth, height\n-180 0\n-90 10\n0 0\n90 0\n", kSouth);
    EXPECT_NEAR(height_deg(south, 90), 10, 1e-9);
    EXPECT_NEAR(height_deg(south, 270), 0, 1e-9);
}

TEST(HorizonFile, WhatIsWrongIsNamed) {
    const auto fault = [](const std::string& text) {
        std::string error = test::error_of([&] { read(text); });
        const auto at = error.find("horizon.txt: ");
        return at == error.npos ? error : error.substr(at + 13);
    };
    EXPECT_EQ(fault("azimuth,elevation\n0,0\n-90,5\n"),
              "line 3: azimuth \"-90\", expected 0 to 360 degrees");
    EXPECT_EQ(fault("azimuth,elevation\n0,0\n90,95\n"),
              "line 3: elevation \"95\", expected -90 to 90 degrees");
    EXPECT_EQ(fault("azimuth,elevation\n0,0\n90,x\n"),
              "line 3: elevation \"x\", expected -90 to 90 degrees");
    EXPECT_EQ(fault("azimuth,elevation\n0,0\n360,4\n"), "azimuth 0 has the elevations 0 and 4");
    EXPECT_EQ(fault("azimuth,elevation\n5,5\n"), "one direction, expected two or more");
    EXPECT_EQ(fault("0,0\n90,3\n"),
              "line 1: no line above it that names the columns azimuth and elevation");
    EXPECT_EQ(fault("direction,elevation\n0,0\n"),
              "line 2: no line above it that names the columns azimuth and elevation");
    EXPECT_EQ(fault("nothing\n"), "no numbers, expected the heights of a horizon");
}

}  // namespace
}  // namespace relevo::light::test_horizon_file
