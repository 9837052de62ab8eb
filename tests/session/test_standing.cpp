// Nobody stands in the ground that they see: eyes over DEMs of all spacings, and what is drawn
// below and above them.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "session/session.h"
#include "support/change.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_standing {
namespace {

constexpr double kEye_m = 2;
constexpr int kSide_px = 33;  // odd: a pixel looks straight ahead
/// Of a drawn height; near the eye float positions are exact to a millimetre.
constexpr double kAccuracy_m = 0.03;

/// How a view is taken: as capture and the window do, or as a picture of a job.
enum class Taken { Alone, InJob };

/// Depth of the drawn ground in the picture's middle [m]; infinity where there is none.
float depth_ahead_m(Session& session, const scene::View& view, Taken taken = Taken::Alone) {
    if (taken == Taken::InJob) {
        scene::Scene next = session.scene();
        next.view = view;
        session.show(next, session.time());
    } else {
        test::look(session, view);
    }
    session.draw();
    std::vector<float> depths_m;
    session.read_depths(depths_m);
    return depths_m[kSide_px * kSide_px / 2];
}

struct Count {
    int sites = 0;
    int under_by_posts = 0;  ///< would be under, by heights between the posts
    int under = 0;           ///< ground above the eye, none below it
    int off = 0;             ///< not as far above the ground as was asked for
    double worst_m = 0;
};

/// Stands at random places of a DEM that have a height in all directions.
Count stand_in(const scene::Scene& scene, int sites, Taken taken) {
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    const dem::Grid& grid = session.dem()->field.grid;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(0.02, 0.98);
    Count count;
    for (int tries = 0; count.sites < sites && tries < 20 * sites; ++tries) {
        const double column = share(random) * (grid.columns() - 1);
        const double row = share(random) * (grid.rows() - 1);
        scene::View view;
        view.eye = scene::Standpoint{grid.place(column, row), /*above_ground=*/true};
        view.eye->place.height_m = kEye_m;
        const double posts_m = session.dem()->height_m(view.eye->place);
        if (std::isnan(posts_m)) continue;
        ++count.sites;
        view.pitch_deg = 90;
        const bool sky_above = std::isinf(depth_ahead_m(session, view, taken));
        view.pitch_deg = -90;
        const double below_m = depth_ahead_m(session, view, taken);
        if (!sky_above || std::isinf(below_m)) {
            ++count.under;
            continue;
        }
        const double off_m = std::abs(below_m - kEye_m);
        count.off += off_m > kAccuracy_m;
        count.worst_m = std::max(count.worst_m, off_m);
        view.eye->above_ground = false;
        view.eye->place.height_m = posts_m + kEye_m / scene.exaggeration;
        count.under_by_posts += std::isinf(depth_ahead_m(session, view, taken));
    }
    return count;
}

/// @returns how many would be under the drawn ground by heights between the posts
int expect_all_to_stand(const std::string& name, const scene::Scene& scene, int sites = 20,
                        Taken taken = Taken::Alone) {
    const Count count = stand_in(scene, sites, taken);
    fmt::print(
        "[ standing ] {}: {} sites, {} under the drawn ground ({} by the posts' heights), "
        "worst {:.3f} m off\n",
        name, count.sites, count.under, count.under_by_posts, count.worst_m);
    EXPECT_EQ(count.sites, sites) << name;
    EXPECT_EQ(count.under, 0) << name;
    EXPECT_EQ(count.off, 0) << name;
    return count.under_by_posts;
}

scene::Scene scene_of(const std::filesystem::path& dem) {
    scene::Scene scene;
    scene.dems = {dem.string()};
    scene.time.at = "2026-06-21T12:00Z";
    scene.width_px = scene.height_px = kSide_px;
    scene.effects.switches.only = std::vector<std::string>{};
    if (dem.extension() == ".asc") scene.dem.crs = "EPSG:32633";
    return scene;
}

/// Steep ground with a height of its own at each post, as mountains have at coarse spacings, or
/// gentle ground with a few spikes, of which levels of detail know little.
/// @param lowest_m  of the ground
std::filesystem::path written_dem(double spacing_m, bool steep, double lowest_m) {
    const std::filesystem::path file =
        test::scratch_dir(fmt::format("dem_{}_{}", spacing_m, steep)) / "dem.asc";
    constexpr int kPosts = 150;
    std::ofstream out(file);
    out << fmt::format("ncols {0}\nnrows {0}\nxllcorner 500000\nyllcorner 5000000\ncellsize {1}\n",
                       kPosts, spacing_m);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> noise(0, 1);
    for (int row = 0; row < kPosts; ++row) {
        for (int column = 0; column < kPosts; ++column) {
            const double hill = 1 + std::sin(column / 9.0) * std::cos(row / 7.0);
            const double spike = noise(random) > 0.995 ? 3 * spacing_m : 0;
            const double rough = steep ? noise(random) * spacing_m : spike;
            out << fmt::format("{:.3f} ", lowest_m + rough + (steep ? 3 : 0.02) * spacing_m * hill);
        }
        out << '\n';
    }
    return file;
}

TEST(Standing, NoEyeIsUnderTheDrawnGroundOfAnySpacing) {
    int under_by_posts = 0;
    for (const double spacing_m : {1.0, 5.0, 30.0, 90.0, 250.0, 1000.0})
        for (const bool steep : {true, false})
            under_by_posts += expect_all_to_stand(
                fmt::format("{} ground of {:.0f} m", steep ? "steep" : "spiky", spacing_m),
                scene_of(written_dem(spacing_m, steep, 100)));
    EXPECT_GT(under_by_posts, 10);  // or the DEMs are too easy
}

TEST(Standing, NoEyeOfAJobsPicturesIsUnderTheGround) {
    EXPECT_GT(expect_all_to_stand("a job over steep ground of 250 m",
                                  scene_of(written_dem(250, true, 100)), 40, Taken::InJob),
              5);
}

TEST(Standing, NoEyeIsUnderExaggeratedGround) {
    scene::Scene scene = scene_of(written_dem(90, true, -200));
    scene.exaggeration = 2.5;
    expect_all_to_stand("steep ground of 90 m, 2.5 times as high", scene);
    // A coarse level of detail leaves out most spikes.
    scene = scene_of(written_dem(30, false, 100));
    scene.pixel_error = 60;
    expect_all_to_stand("spiky ground of 30 m, coarsely drawn", scene);
}

TEST(Standing, NoEyeIsUnderGroundThatAnEffectDisplaces) {
    const std::filesystem::path folder = test::scratch_dir("plugins");
    std::filesystem::create_directory(folder / "swell");
    std::ofstream(folder / "swell" / "plugin.json")
        << R"({"format": 1, "id": "swell", "name": "Swell", "version": "1.0",)"
           R"( "displaces": {"up_m": "swell.height_m"}})";
    std::ofstream(folder / "swell" / "swell.glsl")
        << "uniform float swell_height_m = 40.0;  //@ range(0, 500) unit(m)\n"
           "void swell_on_displace(in VertexFrame v, inout vec3 position_m) {\n"
           "    position_m += swell_height_m * (0.5 + 0.5 * sin(v.post.x)) * v.up;\n"
           "}\n";
    scene::Scene scene = scene_of(written_dem(90, true, 100));
    scene.effects.switches.only = std::vector<std::string>{"swell"};
    scene.effects.plugin_path = {folder.string()};
    expect_all_to_stand("ground that swells", scene);

    // Also when the effect's parameter changes below the eye.
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    scene::View view;
    view.eye = scene::Standpoint{session.ground().frame.origin(), /*above_ground=*/true};
    view.eye->place.height_m = kEye_m;
    view.pitch_deg = -90;
    test::look(session, view);
    test::set(session, "swell.height_m", "300");
    session.draw();
    std::vector<float> depths_m;
    session.read_depths(depths_m);
    EXPECT_NEAR(depths_m[kSide_px * kSide_px / 2], kEye_m, kAccuracy_m);
}

TEST(Standing, AnEyeOverTheSeaStandsOnTheWaterThatIsDrawn) {
    // All below 0 and open to the edge: sea with a known floor, down to 100 m.
    scene::Scene scene = scene_of(written_dem(250, true, -5000));
    scene.effects.switches.only = std::vector<std::string>{"sea"};
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    scene::View view;
    view.eye = scene::Standpoint{session.ground().frame.origin(), /*above_ground=*/true};
    view.eye->place.height_m = kEye_m;
    test::look(session, view);
    const double height_m = session.ground().frame.to_geodetic(session.camera().eye_m).height_m;
    EXPECT_NEAR(height_m, kEye_m, kAccuracy_m);
}

TEST(Standing, AnEyeMayBeFarAboveTheGround) {
    const scene::Scene scene = scene_of(test::source_dir() / "data/dem/jacksboro.tif");
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    scene::View view;
    view.eye = scene::Standpoint{session.ground().frame.origin(), /*above_ground=*/true};
    for (const double height_m : {500.0, 100e3, 1e7}) {
        view.eye->place.height_m = height_m;
        test::look(session, view);
        const geo::Geodetic eye = session.ground().frame.to_geodetic(session.camera().eye_m);
        EXPECT_NEAR(eye.height_m - session.dem()->height_m(session.ground().frame.origin()),
                    height_m, 20);
    }
}

TEST(Standing, ZoomComesNearerToWhatIsInTheMiddleOfTheBundledDem) {
    scene::Scene scene = scene_of(test::source_dir() / "data/dem/jacksboro.tif");
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    scene::View view;
    view.orbit = {.azimuth_deg = 200, .elevation_deg = 30, .zoom = 1};
    const double whole_m = depth_ahead_m(session, view);
    for (const double zoom : {2.0, 5.0, 20.0}) {
        view.orbit.zoom = zoom;
        EXPECT_NEAR(depth_ahead_m(session, view) * zoom / whole_m, 1, 0.02) << "zoom " << zoom;
    }
    view.orbit.zoom = 1e6;
    test::look(session, view);
    const geo::Geodetic eye = session.ground().frame.to_geodetic(session.camera().eye_m);
    EXPECT_NEAR(eye.height_m - session.dem()->height_m(eye), scene::kClearance_m, 1);
}

TEST(Standing, ASessionMayBeginFarAboveTheGround) {
    scene::Scene scene = scene_of(test::source_dir() / "data/dem/jacksboro.tif");
    const geo::Geodetic place{radians(36.35), radians(-84.24), 3000};
    scene.view.eye = scene::Standpoint{place, /*above_ground=*/true};
    scene.view.pitch_deg = -90;
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    session.draw();
    std::vector<float> depths_m;
    session.read_depths(depths_m);
    EXPECT_NEAR(depths_m[depths_m.size() / 2], 3000, 20);
}

TEST(Standing, NoEyeIsUnderTheDrawnGroundOfRealDems) {
    SKIP_WITHOUT_TEST_DATA(data);
    for (const char* const name :
         {"dem/holyroodpark.tif", "dem/roi.tif", "dem/srtm_bigtujunga30m_utm11.tif",
          "dem/missoula_valley.img", "dem/N42E001.hgt", "dem/hawaii_rotated20.tif",
          "dem/dem_RGI50-05.08389.tif", "dem/monterey_bay_topobathy.tif", "dem/rmnp/rmnp-dem.tif",
          "dem/colorado_tut_relief.nc"}) {
        scene::Scene scene = scene_of(data / name);
        if (std::string(name) == "dem/roi.tif") scene.dem.unit = "us-ft";
        if (std::string(name).ends_with(".nc")) scene.dem.crs = "EPSG:4326";
        expect_all_to_stand(name, scene, 50);
    }
}

}  // namespace
}  // namespace relevo::session::test_standing
