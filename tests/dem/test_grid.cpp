#include <cmath>

#include <proj.h>

#include "base/units.h"
#include "dem/grid.h"
#include "support/support.h"

namespace relevo::dem::test_grid {
namespace {

constexpr double kEquatorialRadius_m = 6378137;     // WGS 84, NIMA TR8350.2, table 3.1
constexpr double kQuarterMeridian_m = 10001965.73;  // equator to pole, same report, table 3.3
constexpr double kUtmScale = 0.9996;                // on the central meridian

geo::Crs crs(const char* text) {
    return geo::Crs::parse(text, "test");
}

/// 30 m posts about the central meridian of zone 32, in the north.
Grid utm_grid() {
    return Grid(1001, 801, {500000 - 500 * 30.0, 30, 0, 5200000, 0, -30}, crs("EPSG:32632"));
}

TEST(Affine, InverseGivesTheIndicesBack) {
    const Affine turned{500000, 28, -11, 5200000, -9, -30};
    const glm::dvec2 indices = turned.inverse(turned(12.25, -7.5));
    EXPECT_NEAR(indices.x, 12.25, 1e-9);
    EXPECT_NEAR(indices.y, -7.5, 1e-9);
}

TEST(Grid, PostsAreWhereProjPutsThem) {
    PJ_CONTEXT* context = proj_context_create();
    const struct {
        const char* code;
        bool swapped;  // the authority's order is north first
        Affine affine;
    } cases[] = {
        {"EPSG:32611", false, {376328.655454, 30, 0, 3807902.827628, 0, -30}},
        {"EPSG:32605", false, {230000, 87.2, 31.7, 2210000, 31.7, -87.2}},  // turned by 20 degrees
        {"EPSG:31287", true, {270000, 5, 0, 370000, 0, -5}},
        {"EPSG:27700", false, {325000, 2.5, 0, 673000, 0, -2.5}},
        {"EPSG:4326", true, {11 + 1 / 7200.0, 1 / 3600.0, 0, 48 - 1 / 7200.0, 0, -1 / 3600.0}},
        {"EPSG:26710", false, {557820, 30, 0, 5107980, 0, 30}},  // south-up
    };
    std::vector<double> errors_mm;
    for (const auto& c : cases) {
        const Grid grid(1200, 640, c.affine, crs(c.code));
        PJ* proj = proj_create_crs_to_crs(context, c.code, "EPSG:4326", nullptr);
        for (int row = 0; row < grid.rows(); row += 71)
            for (int column = 0; column < grid.columns(); column += 109) {
                const double x = c.affine.x0 + c.affine.x_column * column + c.affine.x_row * row;
                const double y = c.affine.y0 + c.affine.y_column * column + c.affine.y_row * row;
                const PJ_COORD out = proj_trans(
                    proj, PJ_FWD,
                    c.swapped ? proj_coord(y, x, 0, HUGE_VAL) : proj_coord(x, y, 0, HUGE_VAL));
                const geo::Geodetic expected = geo::geodetic_deg(out.v[0], out.v[1]);
                errors_mm.push_back(geo::geodesic(grid.place(column, row), expected).distance_m *
                                    1000);
                EXPECT_LT(errors_mm.back(), 1) << c.code << " " << column << " " << row;
            }
        proj_destroy(proj);
    }
    proj_context_destroy(context);
    test::print_accuracy("posts against PROJ", errors_mm, "mm", 1);
}

TEST(Grid, BatchEqualsSinglePosts) {
    const Grid grid = utm_grid();
    std::vector<glm::dvec2> posts;
    for (int i = 0; i < 600; ++i)
        posts.emplace_back(i * 1.5, i * 0.75);
    std::vector<geo::Geodetic> places(posts.size());
    grid.place(posts, places);
    for (std::size_t i = 0; i < posts.size(); ++i)
        EXPECT_EQ(places[i], grid.place(posts[i].x, posts[i].y)) << i;
}

TEST(Grid, PostUndoesPlace) {
    for (const char* code : {"EPSG:32632", "EPSG:31287", "EPSG:3857"}) {
        const Grid grid(500, 400, {400000, 28, -11, 420000, -9, -30}, crs(code));
        const glm::dvec2 post = grid.post(grid.place(123.25, 77.5));
        EXPECT_NEAR(post.x, 123.25, 1e-4) << code;  // of 30 m: 3 mm
        EXPECT_NEAR(post.y, 77.5, 1e-4) << code;
    }
}

TEST(Grid, LongitudesPastTheDateLineFindTheirPosts) {
    // Hawaii from 195 to 210 east, as old files count.
    const Grid grid(181, 85, {195, 1 / 12.0, 0, 25, 0, -1 / 12.0}, geo::Crs());
    EXPECT_NEAR(degrees(grid.center().lon_rad), -157.5, 1e-12);
    const glm::dvec2 post = grid.post(geo::geodetic_deg(24, -160));
    EXPECT_NEAR(post.x, 60, 1e-9);
    EXPECT_NEAR(post.y, 12, 1e-9);
}

TEST(Grid, SpacingInUtmIsGridDistanceOverTheScale) {
    const glm::dvec2 spacing_m = utm_grid().post_spacing_m();
    EXPECT_NEAR(spacing_m.x, 30 / kUtmScale, 1e-4);
    EXPECT_NEAR(spacing_m.y, 30 / kUtmScale, 1e-4);
}

TEST(Grid, SpacingInDegreesShrinksWithLatitude) {
    const double step_deg = 1 / 3600.0;
    const Grid equator(11, 11, {6, step_deg, 0, 5 * step_deg, 0, -step_deg}, geo::Crs());
    EXPECT_NEAR(equator.post_spacing_m().x, kEquatorialRadius_m * radians(step_deg), 1e-6);
    // At 60 degrees the parallel has the radius nu cos(lat), nu = a / sqrt(1 - e2 sin2(lat)).
    const Grid sixty(11, 11, {6, step_deg, 0, 60 + 5 * step_deg, 0, -step_deg}, geo::Crs());
    const double nu_m = kEquatorialRadius_m / std::sqrt(1 - 0.00669437999014 * 0.75);
    EXPECT_NEAR(sixty.post_spacing_m().x, nu_m * 0.5 * radians(step_deg), 1e-6);
}

TEST(Grid, SpacingInWebMercatorIsGroundMetres) {
    // On the sphere of the projection, scale 1/cos(lat); the ellipsoid is within 0.7 %.
    const double y_m = 5'300'000;
    const Grid grid(11, 11, {-135e5, 100, 0, y_m, 0, -100}, crs("EPSG:3857"));
    EXPECT_NEAR(grid.post_spacing_m().x, 100 * std::cos(grid.center().lat_rad), 0.7);
}

TEST(Grid, ExtentRunsFromTheFirstPostToTheLast) {
    const double degree_m = kEquatorialRadius_m * kPi / 180;
    const Grid equator(1201, 3, {6, 1 / 1200.0, 0, 1e-6, 0, -1e-6}, geo::Crs());
    EXPECT_NEAR(equator.extent_m().x, degree_m, 1e-3);
    const Grid meridian(3, 901, {6, 1e-6, 0, 90, 0, -0.1}, geo::Crs());
    EXPECT_NEAR(meridian.extent_m().y, kQuarterMeridian_m, 0.01);
}

TEST(Grid, ExtentOfATurnedGridIsItsBox) {
    // 10 km x 4 km turned by 30 degrees on the central meridian.
    const double c = std::cos(radians(30)) * 10;
    const double s = std::sin(radians(30)) * 10;
    const Grid grid(1001, 401, {500000, c, s, 5200000, s, -c}, crs("EPSG:32632"));
    const glm::dvec2 extent_m = grid.extent_m();
    EXPECT_NEAR(extent_m.x,
                (10000 * std::cos(radians(30)) + 4000 * std::sin(radians(30))) / kUtmScale,
                10);  // the convergence at 4 km from the central meridian turns it by 0.04 degrees
    EXPECT_NEAR(extent_m.y,
                (10000 * std::sin(radians(30)) + 4000 * std::cos(radians(30))) / kUtmScale, 10);
}

TEST(Grid, ExtentOfTheWholeEarthIsItsEquator) {
    const Grid earth(360, 180, {-179.5, 1, 0, 89.5, 0, -1}, geo::Crs());
    EXPECT_NEAR(earth.extent_m().x, 359 * kEquatorialRadius_m * kPi / 180, 1);
}

TEST(Grid, PartOfAsManyPostsHasTheSamePosts) {
    const Grid grid = utm_grid();
    const Grid part = grid.part({100, 200, 50, 40}, 50, 40);
    EXPECT_EQ(part.columns(), 50);
    EXPECT_EQ(part.rows(), 40);
    EXPECT_EQ(part.place(0, 0), grid.place(100, 200));
    EXPECT_EQ(part.place(49, 39), grid.place(149, 239));
}

TEST(Grid, CoarserPartHasItsPostsInTheMiddleOfItsCells) {
    const Grid grid = utm_grid();
    const Grid half = grid.part({100, 200, 50, 40}, 25, 10);
    EXPECT_EQ(half.affine()(0, 0), grid.affine()(100.5, 201.5));
    EXPECT_EQ(half.affine()(24, 9), grid.affine()(148.5, 237.5));
    // The edge of the cells stays.
    EXPECT_EQ(half.affine()(-0.5, -0.5), grid.affine()(99.5, 199.5));
}

}  // namespace
}  // namespace relevo::dem::test_grid
