// Marks that native modules set: from the service to the picture.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "base/units.h"
#include "dem/fixture.h"
#include "session/marks.h"
#include "session/seen_ground.h"
#include "session/session.h"
#include "support/change.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_module_marks {
namespace {

namespace fs = std::filesystem;

std::string jacksboro() {
    return (test::source_dir() / "data/dem/jacksboro.tif").string();
}

/// A folder with a plugin whose module is one of those that tests build.
std::string plugin(const std::string& id, const std::string& manifest) {
    const fs::path folder = test::scratch_dir("plugins_of_" + id);
    fs::create_directories(folder / id);
    std::ofstream(folder / id / "plugin.json") << manifest;
    fs::copy(test::build_dir() / "tests/modules" / (id + ".so"), folder / id / (id + ".so"));
    return folder.string();
}

/// The manifest of the guide's example.
std::string summit_manifest() {
    std::ifstream file(test::source_dir() / "docs/plugin-guide.md");
    std::stringstream text;
    text << file.rdbuf();
    const std::string guide = text.str(), begin = "```json summit.json\n";
    const std::size_t from = guide.find(begin) + begin.size();
    return guide.substr(from, guide.find("```", from) - from);
}

scene::Scene scene_of(const std::string& id, const std::string& folder) {
    scene::Scene scene;
    scene.dems = {jacksboro()};
    scene.time.at = "2026-06-21T15:30Z";
    scene.width_px = 640;
    scene.height_px = 480;
    scene.view.orbit.elevation_deg = 60;
    scene.view.orbit.aerial = false;
    scene.effects.switches.only = std::vector<std::string>{id};
    scene.effects.plugin_path = {folder};
    return scene;
}

struct Shown {
    FilesInUse files;
    Session session;

    explicit Shown(const scene::Scene& scene)
        : session(scene, {.device = test::gl_device()}, files) {
        session.draw();
    }
    std::vector<chart::MarkPoint> points() {
        session.read_depths(depths_m_);
        lists_ = session.marks();
        std::vector<chart::MarkPoint> all;
        for (const Marks& list : lists_)
            for (const chart::MarkPoint& point :
                 visible_marks(list, view_of(session.camera(), session.scene().width_px,
                                             session.scene().height_px, depths_m_)))
                all.push_back(point);
        return all;
    }

  private:
    std::vector<float> depths_m_;
    std::vector<Marks> lists_;
};

TEST(ModuleMarks, TheGuidesExampleMarksTheHighestPost) {
    Shown shown(scene_of("summit", plugin("summit", summit_manifest())));
    const std::vector<chart::MarkPoint> points = shown.points();
    ASSERT_EQ(points.size(), 1u);
    EXPECT_EQ(points[0].name, "1076 m");
    // The ground there, against the DEM.
    std::vector<float> depths_m;
    shown.session.read_depths(depths_m);
    const SeenGround seen(shown.session.camera(), 640, 480, depths_m);
    const auto ground =
        seen.point(static_cast<int>(points[0].at.x), static_cast<int>(points[0].at.y));
    ASSERT_TRUE(ground);
    const double height_m = shown.session.ground().frame.to_geodetic(*ground).height_m;
    EXPECT_NEAR(height_m, 1076, 60);  // a pixel is 70 m wide
    // In the picture, and the same with all that was drawn before.
    const image::Image8 first = shown.session.picture();
    shown.session.draw();
    EXPECT_EQ(first.values, shown.session.picture().values);
    test::set_effects(shown.session, {.switches = {.only = std::vector<std::string>{}}});
    shown.session.draw();
    EXPECT_NE(first.values, shown.session.picture().values);
}

constexpr const char* kManifest =
    R"({"format": 1, "id": "marks", "name": "M", "version": "1", "module": "marks",
        "marks": {"places": {"symbol": "dot"}}})";

TEST(ModuleMarks, EveryFaultIsAnErrorThatNamesTheModule) {
    const std::string folder = plugin("marks", kManifest);
    const std::pair<const char*, const char*> cases[] = {
        {"nan", "marks[1].lat_deg: expected -90 to 90 but got nan"},
        {"latitude", "marks[1].lat_deg: expected -90 to 90 but got 95"},
        {"longitude", "marks[1].lon_deg: expected -360 to 360 but got 1e+30"},
        {"height", "marks[1].height_m: expected -2e+06 to 2e+06 but got inf"},
        {"rank", "marks[1].rank: expected a finite number but got nan"},
        {"azimuth", "marks[1].azimuth_deg: expected -360 to 360 but got nan"},
        {"symbol", "marks[1].symbol: expected 0 to 3 but got 77"},
        {"kind", "marks[1].height_of: expected 0 to 3 but got -1"},
        {"utf8", "marks[1].text is not UTF-8"},
        {"long", "marks[1].text: expected up to 1024 bytes but got more"},
        {"many", "expected up to 1000000 marks but got 10000000"},
        {"null", "marks is null"},
        {"list", "plugin.json has no list of marks \"huts\" without \"from\""}};
    for (const auto& [fault, says] : cases) {
        setenv("RELEVO_TEST_MARKS", fault, 1);
        const auto began = std::chrono::steady_clock::now();
        const std::string error = test::error_of([&] { Shown(scene_of("marks", folder)); });
        const double took_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        EXPECT_EQ(error, fmt::format("exit 1: render: {}/marks/marks.so: it cannot prepare a "
                                     "frame: relevo.marks: set: {}; --disable marks goes on "
                                     "without it",
                                     folder, says))
            << fault;
        EXPECT_LT(took_s, 20) << fault;
    }
    unsetenv("RELEVO_TEST_MARKS");
    Shown good(scene_of("marks", folder));
    EXPECT_EQ(good.points().size(), 2u);
}

TEST(ModuleMarks, AreSortedByRankAndKeepWhatFilesLack) {
    effect::ModuleMarks marks(3);
    marks[0] = {.lat_deg = 1, .rank = 5, .symbol = RELEVO_SYMBOL_TRIANGLE, .text = "last\n"};
    marks[1] = {.height_of = RELEVO_ABOVE_GROUND, .height_m = 20, .rank = 2, .text = "above"};
    marks[2] = {.height_of = RELEVO_ON_KNOWN_GROUND,
                .height_m = 700,
                .rank = 2,
                .azimuth_deg = 90,
                .text = "known"};
    const std::shared_ptr<const MarkPlaces> places = places_of(marks);
    ASSERT_EQ(places->places.size(), 3u);
    EXPECT_EQ(places->places[0].name, "above");
    EXPECT_TRUE(places->places[0].at.above_ground);
    EXPECT_EQ(places->places[0].at.place.height_m, 20);
    EXPECT_EQ(places->places[1].name, "known");
    EXPECT_FALSE(places->places[1].at.has_height);
    EXPECT_EQ(places->looks[1].known_ground_m, 700.0F);
    EXPECT_NEAR(*places->looks[1].azimuth_rad, radians(90.0), 1e-12);
    EXPECT_EQ(places->places[2].name, "last\\n");
    EXPECT_EQ(places->looks[2].symbol, chart::Symbol::Triangle);
    EXPECT_FALSE(places->looks[0].symbol);
}

TEST(Marks, KeepOutOfTheRoomOfStamps) {
    const dem::Grid grid = dem::Source::open(jacksboro()).grid();
    std::string csv = "name,lat,lon\n";
    for (int row = 5; row < grid.rows(); row += 6)
        for (int column = 5; column < grid.columns(); column += 6) {
            const geo::Geodetic at = grid.place(column, row);
            csv += fmt::format("MM,{:.9f},{:.9f}\n", degrees(at.lat_rad), degrees(at.lon_rad));
        }
    const fs::path file = test::scratch_dir() / "many.csv";
    std::ofstream(file) << csv;
    scene::Scene scene = scene_of("labels", "");
    scene.effects.plugin_path.clear();
    scene.view.orbit.elevation_deg = 89;
    scene.view.orbit.aerial = false;
    scene.view.orbit.zoom = 2;
    scene.effects.settings = {{"labels.file", file.string()}, {"labels.leader_px", "0"}};
    scene.stamps.title = scene.stamps.north = scene.stamps.scale = true;
    scene.stamps.title_text = "A title as wide as many marks";
    Shown stamped(scene);
    const image::Image8 both = stamped.session.picture();
    test::set(stamped.session, "labels.most", "0");
    stamped.session.draw();
    const image::Image8 stamps = stamped.session.picture();
    scene.stamps = {};
    scene.effects.settings.push_back({"labels.most", "0"});
    const image::Image8 plain = Shown(scene).session.picture();
    // Where there is a stamp, the picture with marks is that without.
    int of_stamps = 0, changed = 0, marked = 0;
    for (int y = 0; y < plain.height; ++y)
        for (int x = 0; x < plain.width; ++x) {
            const auto same = [&](const image::Image8& a, const image::Image8& b) {
                return a.at(x, y, 0) == b.at(x, y, 0) && a.at(x, y, 1) == b.at(x, y, 1) &&
                       a.at(x, y, 2) == b.at(x, y, 2);
            };
            const bool is_stamp = !same(stamps, plain), is_mark = !same(both, stamps);
            of_stamps += is_stamp;
            marked += is_mark;
            changed += is_stamp && is_mark;
        }
    EXPECT_GT(of_stamps, 5000);
    EXPECT_GT(marked, 5000);
    EXPECT_EQ(changed, 0);
}

}  // namespace
}  // namespace relevo::session::test_module_marks
