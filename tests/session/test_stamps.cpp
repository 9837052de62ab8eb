// Stamps against the projection of the ground.
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "base/units.h"
#include "dem/fixture.h"
#include "session/graticule.h"
#include "session/seen_ground.h"
#include "session/session.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_stamps {
namespace {

scene::Scene scene_of(double azimuth_deg, double elevation_deg) {
    scene::Scene scene;
    scene.dems = {(test::source_dir() / "data/dem/jacksboro.tif").string()};
    scene.time.at = "2026-06-21T15:30Z";
    scene.view.orbit.azimuth_deg = azimuth_deg;
    scene.view.orbit.aerial = false;
    scene.view.orbit.elevation_deg = elevation_deg;
    scene.width_px = 480;
    scene.height_px = 360;
    scene.effects.switches.only = std::vector<std::string>{};
    return scene;
}

SeenGround seen_of(const Session& session) {
    std::vector<float> depths_m;
    session.read_depths(depths_m);
    return {session.camera(), session.scene().width_px, session.scene().height_px,
            std::move(depths_m)};
}

/// What a session of a scene shows.
struct Shown {
    FilesInUse files;
    Session session;
    SeenGround seen;

    explicit Shown(const scene::Scene& scene)
        : session(scene, {.device = test::gl_device()}, files),
          seen((session.draw(), seen_of(session))) {}

    glm::dvec3 point(const geo::Geodetic& at) const {
        geo::Geodetic place = at;
        place.height_m = session.dem()->height_m(at);
        return session.ground().frame.to_local(place);
    }
};

TEST(SeenGround, PointsAreWhereTheyAreProjected) {
    const Shown shown(scene_of(150, 35));
    int ground = 0;
    for (int y = 3; y < 360; y += 40)
        for (int x = 5; x < 480; x += 40) {
            const auto point = shown.seen.point(x, y);
            if (!point) continue;
            ++ground;
            const auto back = shown.seen.project(*point);
            EXPECT_NEAR(back->x, x + 0.5, 1e-6);
            EXPECT_NEAR(back->y, y + 0.5, 1e-6);
        }
    EXPECT_GT(ground, 20);
}

TEST(SeenGround, ALengthAcrossTheViewIsAsLongAsTheScaleSays) {
    const Shown shown(scene_of(150, 35));
    const glm::ivec2 middle = *shown.seen.middle();
    EXPECT_LE(std::abs(middle.x - 240), 1);
    EXPECT_LE(std::abs(middle.y - 180), 1);
    const scene::Camera& camera = shown.session.camera();
    const glm::dvec3 right = cross(camera.forward, camera.up);
    const glm::dvec3 point = *shown.seen.point(middle.x, middle.y);
    const double px_per_m = shown.seen.px_per_m(shown.seen.depth_m(middle.x, middle.y));
    for (const double length_m : {-2000.0, 500.0, 5000.0}) {
        const glm::dvec2 moved =
            *shown.seen.project(point + length_m * right) - *shown.seen.project(point);
        EXPECT_NEAR(moved.x, length_m * px_per_m, 1e-6 * std::abs(length_m));
        EXPECT_NEAR(moved.y, 0, 1e-6);
    }
}

TEST(SeenGround, NorthIsWhereAPlaceFurtherNorthIsSeen) {
    for (const double azimuth_deg : {0.0, 150.0, 200.0, 285.0}) {
        const Shown shown(scene_of(azimuth_deg, 30));
        const glm::ivec2 middle = *shown.seen.middle();
        const glm::dvec3 point = *shown.seen.point(middle.x, middle.y);
        const geo::LocalFrame& frame = shown.session.ground().frame;
        geo::Geodetic place = frame.to_geodetic(point);
        const glm::dvec2 way =
            normalize(shown.seen.moved(point, frame.axes(place.lat_rad, place.lon_rad).north));
        place.lat_rad += radians(1e-4);  // 11 m
        const glm::dvec2 seen =
            normalize(*shown.seen.project(frame.to_local(place)) - *shown.seen.project(point));
        EXPECT_GT(dot(way, seen), std::cos(radians(0.1))) << azimuth_deg;
    }
    const Shown above(scene_of(180, 89.99));
    const glm::ivec2 middle = *above.seen.middle();
    const glm::dvec3 point = *above.seen.point(middle.x, middle.y);
    const glm::dvec2 way = normalize(above.seen.moved(point, {0, 1, 0}));
    EXPECT_NEAR(way.x, 0, 1e-3);
    EXPECT_NEAR(way.y, -1, 1e-3);
}

/// How many places of lines are seen where they are projected, and how many of those have a line.
struct Found {
    int seen = 0, drawn = 0;
};

Found places_on_lines(const Shown& shown, const Graticule& graticule, bool latitudes) {
    Found found;
    const double step = latitudes ? graticule.latitude_step_deg : graticule.longitude_step_deg;
    const geo::Geodetic middle = shown.session.ground().frame.origin();
    const auto first = std::lround(degrees(latitudes ? middle.lat_rad : middle.lon_rad) / step);
    for (long line = first - 6; line <= first + 6; ++line)
        for (int k = -400; k <= 400; ++k) {
            geo::Geodetic at = middle;
            (latitudes ? at.lat_rad : at.lon_rad) = radians(static_cast<double>(line) * step);
            (latitudes ? at.lon_rad : at.lat_rad) += radians(k * 2e-4);
            const glm::dvec3 point = shown.point(at);
            if (std::isnan(point.x)) continue;
            const auto px = shown.seen.project(point);
            if (!px || px->x < 2 || px->y < 2 || px->x > 478 || px->y > 358) continue;
            const int x = static_cast<int>(px->x), y = static_cast<int>(px->y);
            const scene::Camera& camera = shown.session.camera();
            const double depth_m = dot(point - camera.eye_m, camera.forward);
            if (std::abs(shown.seen.depth_m(x, y) / depth_m - 1) > 2e-3) continue;  // hidden
            ++found.seen;
            float most = 0;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx)
                    most = std::max(most, graticule.line.at(x + dx, y + dy));
            found.drawn += most > 0.4f;
        }
    return found;
}

TEST(Graticule, LinesAreWhereTheirLatitudesAndLongitudesAreProjected) {
    for (const double elevation_deg : {30.0, 89.99}) {
        const Shown shown(scene_of(160, elevation_deg));
        const Graticule graticule = make_graticule(shown.seen, shown.session.ground().frame,
                                                   [](const auto&) { return true; });
        ASSERT_GT(graticule.latitude_step_deg, 0);
        EXPECT_GE(graticule.labels.size(), 4u);
        for (const bool latitudes : {true, false}) {
            const Found found = places_on_lines(shown, graticule, latitudes);
            ASSERT_GT(found.seen, 200) << elevation_deg;
            EXPECT_GT(found.drawn, 0.95 * found.seen) << elevation_deg << ' ' << latitudes;
            fmt::print(
                "[ accuracy ] {} of {} places on lines of {} have one, seen from {} degrees\n",
                found.drawn, found.seen, latitudes ? "latitude" : "longitude", elevation_deg);
        }
        // And nowhere else: most of the picture has none.
        const auto drawn = std::count_if(graticule.line.begin(), graticule.line.end(),
                                         [](float a) { return a > 0; });
        EXPECT_LT(drawn, 0.1 * 480 * 360);
    }
}

TEST(Graticule, GoesOnAcross180Degrees) {
    test::Raster raster;
    raster.columns = raster.rows = 100;
    raster.crs = "EPSG:4326";
    raster.geotransform = {{179.95, 0.001, 0, -16.95, 0, -0.001}};
    scene::Scene scene = scene_of(180, 89.9);
    scene.dems = {test::write_raster(test::scratch_dir() / "fiji.tif", raster)};
    const Shown shown(scene);
    const Graticule graticule =
        make_graticule(shown.seen, shown.session.ground().frame, [](const auto&) { return true; });
    std::vector<std::string> names;
    for (const chart::Stamps::Label& label : graticule.labels)
        names.push_back(label.words);
    EXPECT_THAT(names, testing::IsSupersetOf({"180°00'", "179°58'E", "179°58'W", "17°00'S"}));
    EXPECT_NEAR(graticule.longitude_step_deg, graticule.latitude_step_deg, 1e-9);
}

TEST(Graticule, HasStepsAndNamesOfMaps) {
    EXPECT_NEAR(graticule_step_deg(1.0, 7), 10 / 60.0, 1e-12);
    EXPECT_NEAR(graticule_step_deg(0.02, 7), 15 / 3600.0, 1e-12);
    EXPECT_NEAR(graticule_step_deg(170, 7), 30, 1e-12);
    EXPECT_NEAR(graticule_step_deg(360, 7), 30, 1e-12);
    EXPECT_EQ(latitude_text(47.5, 0.5), "47°30'N");
    EXPECT_EQ(latitude_text(-33, 1), "33°S");
    EXPECT_EQ(latitude_text(0, 1), "0°");
    EXPECT_EQ(latitude_text(36 + 1 / 120.0, 1 / 120.0), "36°00'30\"N");
    EXPECT_EQ(longitude_text(-121.5, 0.5), "121°30'W");
    EXPECT_EQ(longitude_text(181, 1), "179°W");
    EXPECT_EQ(longitude_text(180, 1), "180°");
}

TEST(Stamps, AreOnPicturesOfScenesThatWantThem) {
    scene::Scene scene = scene_of(160, 35);
    const auto picture = [&] {
        FilesInUse files;
        Session session(scene, {.device = test::gl_device()}, files);
        session.draw();
        return std::pair(session.picture(), session.stamp_notes());
    };
    const auto [plain, no_notes] = picture();
    EXPECT_TRUE(no_notes.empty());
    for (bool scene::Stamps::*one :
         {&scene::Stamps::title, &scene::Stamps::scale, &scene::Stamps::north,
          &scene::Stamps::graticule, &scene::Stamps::date, &scene::Stamps::sun}) {
        scene.stamps = {};
        scene.stamps.*one = true;
        EXPECT_GT(image::compare(plain, picture().first).share_over_1, 0.002);
    }
    scene.stamps.title = true;
    scene.width_px = 48;
    scene.height_px = 36;
    const auto [tiny, notes] = picture();
    ASSERT_FALSE(notes.empty());
    EXPECT_EQ(notes.front(), "stamp: title: no room in a picture of 48 x 36 pixels; omitted");
}

TEST(Stamps, OfAScaleAloneAreSmallLettersInACorner) {
    scene::Scene scene = scene_of(160, 35);
    scene.stamps.exaggeration = true;
    const auto picture = [&] {
        FilesInUse files;
        Session session(scene, {.device = test::gl_device()}, files);
        session.draw();
        return session.picture();
    };
    scene.exaggeration = 2;
    const image::Image8 with = picture();
    scene.stamps.exaggeration = false;
    const image::Image8 without = picture();
    int changed = 0;
    for (int y = 0; y < with.height; ++y)
        for (int x = 0; x < with.width; ++x) {
            const auto at = static_cast<std::size_t>(3 * (y * with.width + x));
            if (with.values[at] == without.values[at]) continue;
            ++changed;
            EXPECT_TRUE(x > 0.7 * with.width && y > 0.85 * with.height) << x << ", " << y;
        }
    EXPECT_GT(changed, 100);
    EXPECT_LT(changed, 1500);  // no panel
    // True heights have nothing to tell.
    scene.exaggeration = 1;
    const image::Image8 plain = picture();
    scene.stamps.exaggeration = true;
    EXPECT_EQ(picture().values, plain.values);
}

TEST(Stamps, FollowASceneThatIsShownNext) {
    scene::Scene scene = scene_of(160, 35);
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    session.draw();
    const image::Image8 plain = session.picture();
    scene = session.scene();
    scene.stamps.title = true;
    scene.stamps.title_text = "Next";
    session.show(scene, session.time());
    session.draw();
    EXPECT_GT(image::compare(plain, session.picture()).share_over_1, 0.002);
}

}  // namespace
}  // namespace relevo::session::test_stamps
