#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "base/units.h"
#include "light/fields.h"
#include "render/ground.h"
#include "scene/framing.h"

namespace relevo::render::test_ground {
namespace {

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();
constexpr const char* kUtm = "EPSG:32632";

struct Shape {
    const char* name;
    dem::Heightfield field;
};

double hills(int column, int row, double height_m) {
    return height_m * (1 + std::sin(0.05 * column) * std::sin(0.07 * row + 1));
}

dem::Affine utm(double spacing_m, double turned_deg = 0) {
    const double c = spacing_m * std::cos(radians(turned_deg));
    const double s = spacing_m * std::sin(radians(turned_deg));
    return {500000, c, s, 5200000, s, -c};
}

std::vector<Shape> shapes() {
    const auto in_circle = [](int column, int row) {
        return std::hypot(column - 100, row - 100) < 80 ? hills(column, row, 900) : kHole;
    };
    const auto bent = [](int column, int row) {
        return column < 60 || row > 150 ? hills(column, row, 900) : kHole;
    };
    const auto strip = [](int column, int row) {
        return std::abs(column - row) < 25 ? hills(column, row, 900) : kHole;
    };
    const auto hilly = [](double height_m) {
        return [=](int column, int row) { return hills(column, row, height_m); };
    };
    std::vector<Shape> all;
    all.push_back({"square", test::field_of(301, 301, utm(90), kUtm, hilly(800))});
    all.push_back({"wide", test::field_of(601, 151, utm(90), kUtm, hilly(800))});
    all.push_back({"tall", test::field_of(101, 501, utm(90), kUtm, hilly(800))});
    all.push_back({"turned", test::field_of(251, 201, utm(90, 20), kUtm, hilly(800))});
    all.push_back({"round", test::field_of(201, 201, utm(90), kUtm, in_circle)});
    all.push_back({"bent", test::field_of(201, 201, utm(90), kUtm, bent)});
    all.push_back({"strip", test::field_of(201, 201, utm(90), kUtm, strip)});
    all.push_back({"ten metres", test::field_of(21, 21, utm(0.5), kUtm, hilly(1))});
    all.push_back({"pole", test::field_of(301, 301, {-1.5e6, 1e4, 0, 1.5e6, 0, -1e4}, "EPSG:3413",
                                          hilly(1500))});
    all.push_back({"continent",
                   test::field_of(401, 301, {-20, 0.1, 0, 60, 0, -0.1}, "EPSG:4326", hilly(2000))});
    all.push_back(
        {"planet", test::field_of(361, 181, {-180, 1, 0, 90, 0, -1}, "EPSG:4326", hilly(3000))});
    return all;
}

/// Every post as it is drawn, and below it the block's lower side.
std::vector<glm::dvec3> all_of(const dem::Heightfield& field, const Ground& ground) {
    std::vector<glm::dvec3> points;
    for (int row = 0; row < field.grid.rows(); ++row)
        for (int column = 0; column < field.grid.columns(); ++column) {
            if (std::isnan(field.height_m.at(column, row))) continue;
            geo::Geodetic place = field.place(column, row);
            points.push_back(ground.frame.to_local(place));
            place.height_m = ground.base_m(1);
            if (ground.block_m > 0) points.push_back(ground.frame.to_local(place));
        }
    return points;
}

/// Width and height of points in a picture, as shares of its sides.
glm::dvec2 filled(const std::vector<glm::dvec3>& points, const scene::Camera& camera,
                  double aspect) {
    const glm::dvec3 right = cross(camera.forward, camera.up);
    const double tan_y = std::tan(camera.fov_y_rad / 2);
    glm::dvec2 least(1e300), most(-1e300);
    for (const glm::dvec3& point : points) {
        const glm::dvec3 to = point - camera.eye_m;
        const glm::dvec2 at = glm::dvec2(dot(to, right) / aspect, dot(to, camera.up)) /
                              (dot(to, camera.forward) * tan_y);
        least = min(least, at);
        most = max(most, at);
    }
    return 0.5 * (most - least);
}

TEST(GroundToShow, ItsOutlineIsThatOfAllPostsWhateverTheShape) {
    for (const Shape& shape : shapes()) {
        const Ground ground = make_ground(shape.field);
        const GroundToShow show = ground_to_show(shape.field, ground, 1);
        std::vector<glm::dvec3> points = show.points;
        const auto base = block_below(show.rim, ground, 1);
        points.insert(points.end(), base.begin(), base.end());
        const auto all = all_of(shape.field, ground);
        const scene::DefaultDay day(ground.frame.origin(), ground.block_m <= 0);
        const scene::Orbit orbit = scene::frame_ground({}, show.net, show.aerial, day).orbit;
        for (const double aspect : {0.5, 1.25, 2.5}) {
            const glm::dvec2 sides =
                filled(all, scene::orbit_camera(orbit, points, radians(40), aspect), aspect);
            EXPECT_NEAR(std::max(sides.x, sides.y), 0.95, 0.01)
                << shape.name << " " << aspect << " azimuth " << *orbit.azimuth_deg;
        }
    }
}

TEST(Block, IsSevenHundredthsOfTheDemsWidthDeepAndNothingOfAPlanet) {
    for (const Shape& shape : shapes()) {
        const Ground ground = make_ground(shape.field);
        if (shape.name == std::string("planet")) {
            EXPECT_EQ(ground.block_m, 0);
            EXPECT_TRUE(block_below(ground_to_show(shape.field, ground, 1).rim, ground, 1).empty());
            continue;
        }
        const glm::dvec2 sides_m = ground.north_east_m - ground.south_west_m;
        EXPECT_NEAR(ground.block_m, 0.07 * std::sqrt(sides_m.x * sides_m.y), 1e-6);
        // Deep below the lowest post, whatever the exaggeration of heights.
        EXPECT_NEAR(ground.base_m(3), 3 * ground.lowest_m - ground.block_m, 1e-6);
    }
}

TEST(Block, StandsOnWhereItsRimIsLowest) {
    for (const Shape& shape : shapes()) {
        const Ground ground = make_ground(shape.field);
        if (ground.block_m <= 0) continue;
        const auto base = block_below(ground_to_show(shape.field, ground, 1).rim, ground, 1);
        double lowest = 1e300;
        for (const glm::dvec3& point : base)
            lowest = std::min(lowest, point.z);
        FrameInputs inputs;
        inputs.camera.eye_m = {0, 0, 1e6};
        const double floor_m = make_frame_block(inputs, ground, 10, 10, 1).block.y;
        // Voids leave room below; the corners of others are on the floor.
        EXPECT_GE(lowest, floor_m - 0.01 * ground.block_m) << shape.name;
        if (shape.name == std::string("square") || shape.name == std::string("continent")) {
            EXPECT_NEAR(lowest, floor_m, 0.02 * ground.block_m) << shape.name;
        }
    }
}

TEST(Footprint, IsWhereTheGroundIs) {
    const std::vector<Shape> all = shapes();
    const auto round = std::find_if(all.begin(), all.end(), [](const Shape& shape) {
        return shape.name == std::string("round");
    });
    const Ground ground = make_ground(round->field);
    // A circle of 80 posts 90 m apart, in a square of 200.
    EXPECT_EQ(ground.footprint.at({0, 0}), 1);
    EXPECT_EQ(ground.footprint.at({6500, 0}), 1);
    EXPECT_EQ(ground.footprint.at({0, -6500}), 1);
    EXPECT_EQ(ground.footprint.at({7900, 0}), 0);
    EXPECT_EQ(ground.footprint.at({6500, 6500}), 0);
    EXPECT_EQ(ground.footprint.at({1e9, 0}), 0);
}

TEST(Outside, IsBesideTheGroundOrHighAboveIt) {
    const std::vector<Shape> all = shapes();
    const Ground ground = make_ground(all[0].field);  // 27 km wide, 0 to 1600 m high
    EXPECT_FALSE(is_outside(ground, {0, 0, 2000}, 1));
    EXPECT_FALSE(is_outside(ground, {12e3, 12e3, 2000}, 1));
    EXPECT_FALSE(is_outside(ground, {0, 0, 10e3}, 1));
    EXPECT_TRUE(is_outside(ground, {0, 0, 12e3}, 1));
    EXPECT_TRUE(is_outside(ground, {16e3, 0, 2000}, 1));
    EXPECT_TRUE(is_outside(ground, {0, -16e3, 100}, 1));
    // High is above the ground as it is drawn.
    EXPECT_FALSE(is_outside(ground, {0, 0, 12e3}, 5));
    // Beside a planet is nowhere: an eye low above its far side is within.
    const Ground planet = make_ground(all.back().field);
    EXPECT_FALSE(is_outside(planet, planet.frame.to_local(geo::geodetic_deg(0, 90, 5e4)), 1));
    EXPECT_FALSE(is_outside(planet, planet.frame.to_local(geo::geodetic_deg(10, 180, 5e4)), 1));
    EXPECT_TRUE(is_outside(planet, planet.frame.to_local(geo::geodetic_deg(10, 180, 9e6)), 1));
}

}  // namespace
}  // namespace relevo::render::test_ground
