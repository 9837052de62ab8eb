// Marks of plugins: where they stand, and what hides them.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gmock/gmock.h>

#include "base/units.h"
#include "dem/fixture.h"
#include "session/marks.h"
#include "session/session.h"
#include "support/change.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_marks {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string written(const std::string& name, const std::string& text) {
    const fs::path file = test::scratch_dir() / name;
    std::ofstream(file, std::ios::binary) << text;
    return file.string();
}

std::string row(const std::string& name, const geo::Geodetic& at) {
    return fmt::format("{},{:.9f},{:.9f}\n", name, degrees(at.lat_rad), degrees(at.lon_rad));
}

scene::Scene scene_of(const std::string& dem, const std::string& places) {
    scene::Scene scene;
    scene.dems = {dem};
    scene.time.at = "2026-06-21T15:30Z";
    scene.width_px = 640;
    scene.height_px = 480;
    scene.effects.switches.only = std::vector<std::string>{"labels"};
    scene.effects.settings = {{"labels.file", places}, {"labels.leader_px", "0"}};
    return scene;
}

std::string jacksboro() {
    return (test::source_dir() / "data/dem/jacksboro.tif").string();
}

struct Shown {
    FilesInUse files;
    Session session;

    explicit Shown(const scene::Scene& scene)
        : session(scene, {.device = test::gl_device()}, files) {
        session.draw();
    }
    /// The visible marks of all lists.
    std::vector<chart::MarkPoint> marks() {
        std::vector<float> depths_m;
        session.read_depths(depths_m);
        const MarkView view = view_of(session.camera(), session.scene().width_px,
                                      session.scene().height_px, depths_m);
        std::vector<chart::MarkPoint> all;
        lists_ = session.marks();
        for (const Marks& list : lists_)
            for (const chart::MarkPoint& point : visible_marks(list, view))
                all.push_back(point);
        return all;
    }
    std::vector<std::string> names() {
        std::vector<std::string> names;
        for (const chart::MarkPoint& point : marks())
            names.emplace_back(point.name);
        return names;
    }

  private:
    std::vector<Marks> lists_;
};

/// A plugin that paints how far ground is from a post, and one that raises the ground by 150 m,
/// with a wider bound.
std::string test_plugins() {
    const fs::path folder = test::scratch_dir("plugins");
    const auto add = [&](const std::string& id, const std::string& more, const std::string& glsl) {
        fs::create_directories(folder / id);
        std::ofstream(folder / id / "plugin.json") << fmt::format(
            R"({{"format": 1, "id": "{0}", "name": "{0}", "version": "1"{1}}})", id, more);
        std::ofstream(folder / id / (id + ".glsl")) << glsl;
    };
    add("spot", "",
        "uniform float spot_column = 0.0; //@ range(-10, 10000)\n"
        "uniform float spot_row = 0.0; //@ range(-10, 10000)\n"
        "void spot_on_display(in Surface s, inout vec4 overlay) {\n"
        "    vec2 away = (s.post - vec2(spot_column, spot_row)) / 16.0 + 128.0 / 255.0;\n"
        "    overlay = vec4(clamp(away, 0.0, 1.0), 1.0, 1.0);\n"
        "}\n");
    add("lift", R"(, "displaces": {"up_m": 400})",
        "uniform float lift_m = 150.0; //@ range(0, 400)\n"
        "void lift_on_displace(in VertexFrame v, inout vec3 position_m) {\n"
        "    position_m += v.up * lift_m * frame.height_range.z;\n"
        "}\n");
    return folder.string();
}

/// Where a frame of `spot` shows its post: of the pixels around the nearest one, distances in posts
/// are fitted linearly. nullopt if these pixels are not one piece of ground.
std::optional<glm::dvec2> spot_in(const gl::Texture& frame) {
    const int width = frame.extent().width, height = frame.extent().height;
    std::vector<std::uint8_t> rgba(4 * static_cast<std::size_t>(width * height));
    frame.read(0, std::as_writable_bytes(std::span(rgba)));
    const auto away = [&](int x, int y) {  // posts; y from the top
        const std::uint8_t* const at =
            rgba.data() + 4 * static_cast<std::size_t>((height - 1 - y) * width + x);
        return at[2] == 255 ? glm::dvec2(at[0] - 128, at[1] - 128) * (16 / 255.0) : glm::dvec2(99);
    };
    glm::ivec2 nearest(2);
    for (int y = 2; y < height - 2; ++y)
        for (int x = 2; x < width - 2; ++x)
            if (length(away(x, y)) < length(away(nearest.x, nearest.y))) nearest = {x, y};
    glm::dvec2 mean(0), by_x(0), by_y(0);
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const glm::dvec2 d = away(nearest.x + dx, nearest.y + dy);
            if (length(d) > 6) return std::nullopt;
            mean += d / 9.0;
            by_x += d * (dx / 6.0);
            by_y += d * (dy / 6.0);
        }
    const glm::dvec2 step = inverse(glm::dmat2(by_x, by_y)) * -mean;
    if (!(length(step) < 1)) return std::nullopt;  // it is behind a crest
    return glm::dvec2(nearest) + 0.5 + step;
}

/// Distances of visible marks from where the renderer draws their posts [px].
std::vector<double> distances_px(double elevation_deg, double exaggeration, bool lifted) {
    const dem::Grid grid = dem::Source::open(jacksboro()).grid();
    std::string csv = "name,lat,lon\n";
    for (int row_of = 40; row_of < grid.rows() - 20; row_of += 75)
        for (int column = 40; column < grid.columns() - 20; column += 75)
            csv += row(fmt::format("{} {}", column, row_of), grid.place(column, row_of));
    scene::Scene scene = scene_of(jacksboro(), written("posts.csv", csv));
    scene.effects.switches.only = {"labels", "spot"};
    if (lifted) scene.effects.switches.only->push_back("lift");
    scene.effects.plugin_path = {test_plugins()};
    scene.exaggeration = exaggeration;
    scene.view.orbit.elevation_deg = elevation_deg;
    scene.view.orbit.aerial = false;
    scene.view.orbit.azimuth_deg = 160;
    scene.view.orbit.zoom = 1.5;
    Shown shown(scene);
    std::vector<double> distances;
    for (const chart::MarkPoint& mark : shown.marks()) {
        const std::string name(mark.name);
        test::set(shown.session, "spot.column", name.substr(0, name.find(' ')));
        test::set(shown.session, "spot.row", name.substr(name.find(' ') + 1));
        shown.session.draw();
        if (const auto spot = spot_in(shown.session.texture()))
            distances.push_back(distance(*spot, mark.at));
    }
    return distances;
}

TEST(SummitMarks, AreOnTheDem) {
    scene::Scene scene =
        scene_of((test::source_dir() / "data/dem/vancouver-island.tif").string(), "");
    scene.effects.switches.only = {"summits"};
    scene.effects.settings.clear();
    Shown shown(scene);
    const std::vector<std::string> names = shown.names();
    EXPECT_THAT(names, testing::IsSupersetOf({"Mount Garibaldi", "Golden Hinde"}));
    const std::vector<Marks> lists = shown.session.marks();
    ASSERT_EQ(lists.size(), 1u);
    const auto& marks = lists[0].standing->marks;
    ASSERT_GT(marks.size(), 100u);
    for (std::size_t i = 1; i < marks.size(); ++i)
        EXPECT_GE(marks[i - 1].height_m, marks[i].height_m);          // the highest first
    EXPECT_EQ(shown.session.marks()[0].standing, lists[0].standing);  // kept
}

TEST(SummitMarks, StandOnTheTopsOfTheDem) {
    test::Raster cone;
    cone.columns = cone.rows = 100;
    cone.crs = "EPSG:32630";
    cone.geotransform = {{376180, 30, 0, 6298100, 0, -30}};
    cone.value = [](int column, int row, int) {
        return 1500 - 10 * std::hypot(column - 50, row - 50);  // 61 m from Ben Nevis
    };
    scene::Scene scene = scene_of(test::write_raster(test::scratch_dir() / "cone.tif", cone), "");
    scene.effects.switches.only = {"summits"};
    scene.effects.settings.clear();
    Shown shown(scene);
    const std::vector<Marks> lists = shown.session.marks();
    ASSERT_EQ(lists.size(), 1u);
    const StandingMarks& standing = *lists[0].standing;
    ASSERT_FALSE(standing.marks.empty());
    EXPECT_EQ(standing.places->places[standing.marks[0].index].name, "Ben Nevis");
    EXPECT_NEAR(standing.marks[0].height_m, 1500, 0.01);
}

TEST(MarksOnGround, StandWhereTheRendererDrawsTheirPosts) {
    struct View {
        double elevation_deg, exaggeration;
    };
    for (const bool lifted : {false, true})
        for (const auto [elevation_deg, exaggeration] :
             {View{25, 1}, View{89.9, 1}, View{50, 3}, View{89.9, 3}}) {
            const std::vector<double> px = distances_px(elevation_deg, exaggeration, lifted);
            ASSERT_GT(px.size(), 8u) << elevation_deg;
            fmt::print(
                "[ marks ] {} posts, elevation {}, exaggerated {}, {}: at most {:.2f} "
                "px off\n",
                px.size(), elevation_deg, exaggeration, lifted ? "raised" : "as it is",
                *std::ranges::max_element(px));
            EXPECT_LT(*std::ranges::max_element(px), 1)
                << elevation_deg << ' ' << exaggeration << ' ' << lifted;
        }
}

/// Level ground with a ridge from west to east, 600 m high, 60 posts of 30 m from the north edge.
std::string ridge_dem() {
    test::Raster raster;
    raster.columns = raster.rows = 160;
    raster.value = [](int, int row_of, int) {
        return 500 + std::max(0.0, 600 - 60.0 * std::abs(row_of - 60));
    };
    return test::write_raster(test::scratch_dir("ridge") / "ridge.tif", raster);
}

TEST(Marks, ARidgeHidesWhatIsBehindIt) {
    const std::string dem = ridge_dem();
    const dem::Grid grid = dem::Source::open(dem).grid();
    const auto at = [&](double column, double row_of) { return grid.place(column, row_of); };
    const std::string csv =
        "name,lat,lon,height\n" + row("behind", at(80, 30)) + row("crest", at(80, 60)) +
        row("before", at(80, 100)) + row("just behind", at(82, 52)) +
        fmt::format("high,{:.9f},{:.9f},1500\n", degrees(at(78, 30).lat_rad),
                    degrees(at(78, 30).lon_rad)) +
        fmt::format("lifted,{:.9f},{:.9f},900agl\n", degrees(at(76, 30).lat_rad),
                    degrees(at(76, 30).lon_rad)) +
        row("outside", geo::geodetic_deg(10, 10)) + row("behind the eye", at(80, 155));
    scene::Scene scene = scene_of(dem, written("ridge.csv", csv));
    geo::Geodetic eye = at(80, 150);
    eye.height_m = 560;
    scene.view.eye = scene::Standpoint{eye};
    scene.view.heading_deg = 0;
    scene.view.pitch_deg = 5;
    EXPECT_THAT(Shown(scene).names(),
                testing::UnorderedElementsAre("crest", "before", "high", "lifted"));
    scene.view.eye->place.height_m = 4000;
    scene.view.pitch_deg = -50;
    EXPECT_THAT(Shown(scene).names(), testing::IsSupersetOf({"behind", "crest", "before"}));
}

TEST(Marks, AreOrderedByRankDistanceOrHeight) {
    const std::string dem = ridge_dem();
    const dem::Grid grid = dem::Source::open(dem).grid();
    const auto ranked = [&](const std::string& name, double row_of, const char* rank) {
        std::string line = row(name, grid.place(80, row_of));
        line.insert(line.size() - 1, std::string(",") + rank);
        return line;
    };
    scene::Scene scene =
        scene_of(dem, written("order.csv", "name,lat,lon,rank\n" + ranked("far", 62, "") +
                                               ranked("middle", 75, "7.5") +
                                               ranked("near", 90, "2") + ranked("crest", 60, "9")));
    geo::Geodetic eye = grid.place(80, 150);
    eye.height_m = 1500;
    scene.view.eye = scene::Standpoint{eye};
    scene.view.heading_deg = 0;
    scene.view.pitch_deg = -15;
    Shown shown(scene);
    EXPECT_THAT(shown.names(), testing::ElementsAre("near", "middle", "crest", "far"));
    test::set(shown.session, "labels.order", "nearest");
    EXPECT_THAT(shown.names(), testing::ElementsAre("near", "middle", "far", "crest"));
    test::set(shown.session, "labels.order", "highest");
    EXPECT_THAT(shown.names(), testing::ElementsAre("crest", "far", "near", "middle"));
}

/// Pixels of pure green.
int greens(const image::Image8& picture, int from, int to) {
    int count = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = from; x < to; ++x)
            count +=
                picture.at(x, y, 0) < 40 && picture.at(x, y, 1) > 215 && picture.at(x, y, 2) < 40;
    return count;
}

TEST(Marks, AreInPicturesButNotInLinearOnes) {
    const dem::Grid grid = dem::Source::open(jacksboro()).grid();
    const std::string places =
        written("middle.csv", "name,lat,lon\n" + row("MMMM", grid.place(150, 150)));
    scene::Scene scene = scene_of(jacksboro(), places);
    scene.effects.settings.push_back({"labels.colour", "#00ff00"});
    scene.effects.settings.push_back({"labels.halo", "#00ff00"});
    scene.view.orbit.elevation_deg = 89;
    scene.view.orbit.aerial = false;
    FilesInUse files;
    Session session(scene, {.device = test::gl_device(), .radiance = true}, files);
    session.draw();
    EXPECT_GT(greens(session.picture(), 0, 640), 200);
    const image::ImageF with = session.radiance();
    test::set(session, "labels.most", "0");
    session.draw();
    EXPECT_EQ(greens(session.picture(), 0, 640), 0);
    EXPECT_EQ(with.values, session.radiance().values);
    // Of a comparison only the half with the effect has them.
    const std::string both = written("both.csv", "name,lat,lon\n" + row("MM", grid.place(75, 150)) +
                                                     row("MM", grid.place(225, 150)));
    scene.effects.settings[0].text = both;
    Session compared(scene, {.device = test::gl_device(), .compared = {"labels"}}, files);
    compared.draw();
    EXPECT_GT(greens(compared.picture(), 0, 319), 100);
    EXPECT_EQ(greens(compared.picture(), 319, 640), 0);
}

TEST(Marks, FilesThatLieAreRefusedByName) {
    const fs::path folder = test::scratch_dir("lies");
    fs::create_directories(folder / "directory");
    std::string many = "lat,lon\n";
    many.reserve(8'100'000);
    for (int i = 0; i <= 1'000'000; ++i)
        many += "36.3,1\n";
    const struct {
        std::string name, text, says;
    } cases[] = {{"empty.csv", "", "an empty file"},
                 {"nan.csv", "lat,lon\nnan,8\n", "line 2"},
                 {"pole.csv", "lat,lon\n91,8\n", "line 2"},
                 {"rank.csv", "lat,lon,rank\n46,8,first\n",
                  "line 2: rank, expected a number but got \"first\""},
                 {"binary.csv", std::string("\x89PNG\0\0\x1a", 7), "not a text"},
                 {"header.csv", "lat,lon\n", "no points"},
                 {"words.csv", "hello\nworld\n", "no columns lat and lon"},
                 {"many.csv", many, "more than 1000000 places"},
                 {"open.json", "{\"type\": \"FeatureCollection\"", "open.json"},
                 {"cut.gpx", "<gpx><wpt lat=\"46\" lon=\"8\">", "cut.gpx"},
                 {"directory", "", "directory"},
                 {"missing.csv", "", "missing.csv"}};
    for (const auto& [name, text, says] : cases) {
        const fs::path file = folder / name;
        if (name != "directory" && name != "missing.csv")
            std::ofstream(file, std::ios::binary) << text;
        const auto began = std::chrono::steady_clock::now();
        const std::string error = test::error_of([&] {
            FilesInUse files;
            Session(scene_of(jacksboro(), file.string()), {.device = test::gl_device()}, files);
        });
        const double took_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        EXPECT_THAT(error, HasSubstr("exit 3: labels.file: " + file.string())) << name;
        EXPECT_THAT(error, HasSubstr(says)) << name;
        EXPECT_LT(took_s, 20) << name;
    }
}

TEST(Marks, TheirFileIsReadAgainOnlyIfItHasChanged) {
    const dem::Grid grid = dem::Source::open(jacksboro()).grid();
    const std::string header = "name,lat,lon\n";
    const std::string places = written("changed.csv", header + row("before", grid.place(150, 150)));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // newer files are read again
    scene::Scene scene = scene_of(jacksboro(), places);
    Shown shown(scene);
    EXPECT_THAT(shown.names(), testing::ElementsAre("before"));
    const auto standing = shown.session.marks().at(0).standing;
    scene.effects.switches.only->push_back("avalanche");
    test::set_effects(shown.session, scene.effects);
    EXPECT_EQ(shown.session.marks().at(0).standing, standing);
    written("changed.csv", header + row("afterwards", grid.place(150, 150)));
    test::set_effects(shown.session, scene.effects);
    shown.session.draw();
    EXPECT_THAT(shown.names(), testing::ElementsAre("afterwards"));
    // A file that is broken later leaves what there was.
    written("changed.csv", "hello");
    EXPECT_THAT(test::error_of([&] { test::set_effects(shown.session, scene.effects); }),
                HasSubstr("no columns lat and lon"));
    EXPECT_THAT(shown.names(), testing::ElementsAre("afterwards"));
}

TEST(Marks, AHundredThousandTakeBoundedTime) {
    const dem::Grid grid = dem::Source::open(jacksboro()).grid();
    std::string csv = "name,lat,lon\n";
    for (int i = 0; i < 100'000; ++i)
        csv += row("Place", grid.place(2 + i % 290, 2 + i / 290 % 290));
    scene::Scene scene = scene_of(jacksboro(), written("many.csv", csv));
    scene.view.orbit.elevation_deg = 60;
    scene.view.orbit.aerial = false;
    const auto seconds = [](const auto& act) {
        const auto began = std::chrono::steady_clock::now();
        act();
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    };
    std::optional<Shown> shown;
    const double opened_s = seconds([&] { shown.emplace(scene); });
    const double first_s = seconds([&] { shown->session.picture(); });
    const double second_s = seconds([&] { shown->session.picture(); });
    fmt::print(
        "[ marks ] of 100 000: opened in {:.2f} s, first picture {:.2f} s, second {:.2f} s\n",
        opened_s, first_s, second_s);
    EXPECT_LT(first_s, 5);
    EXPECT_LT(second_s, 2);
}

}  // namespace
}  // namespace relevo::session::test_marks
