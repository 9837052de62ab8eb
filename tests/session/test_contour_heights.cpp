// Heights on the index lines of `contours`: against the ground that pictures show.
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <set>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "base/text.h"
#include "base/units.h"
#include "dem/fixture.h"
#include "session/marks.h"
#include "session/seen_ground.h"
#include "session/session.h"
#include "support/change.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_contour_heights {
namespace {

/// A label in a picture.
struct Label {
    chart::PlacedMark placed;
    double height_m;       ///< that it says
    glm::dvec3 at_m;       ///< its place
    glm::dvec2 projected;  ///< where that is in the picture [px]
    const dem::NamedPlace* place;
};

class Shown {
  public:
    explicit Shown(const scene::Scene& scene)
        : session(scene, {.device = test::gl_device()}, files_) {
        session.draw();
    }

    std::vector<Label> labels() {
        const int width = session.scene().width_px, height = session.scene().height_px;
        session.read_depths(depths_m_);
        lists_ = session.marks();
        std::vector<Label> found;
        if (lists_.empty()) return found;
        EXPECT_EQ(lists_.size(), 1u);
        const Marks& list = lists_.front();
        const auto points =
            visible_marks(list, view_of(session.camera(), width, height, depths_m_));
        chart::FreeRoom room({0, 0, double{1} * width, double{1} * height});
        const auto& places = list.standing->places->places;
        for (const chart::PlacedMark& placed : chart::place_marks(points, list.style, room)) {
            const auto place = std::ranges::find_if(places, [&](const auto& of) {
                return of.name.data() == points[placed.index].name.data();
            });
            const auto index = static_cast<std::uint32_t>(place - places.begin());
            const auto mark =
                std::ranges::find(list.standing->marks, index, &StandingMarks::Mark::index);
            const std::string text = placed.words.substr(0, placed.words.size() - 2);
            found.push_back({placed, parse_number(text).value_or(NAN), mark->at_m,
                             seen().project(mark->at_m).value_or(glm::dvec2(-1e9)), &*place});
        }
        return found;
    }

    SeenGround seen() const {
        return {session.camera(), session.scene().width_px, session.scene().height_px, depths_m_};
    }
    /// Of the DEM's heights, at a point of the ground.
    double height_m(const glm::dvec3& point_m) const {
        return session.ground().frame.to_geodetic(point_m).height_m / session.scene().exaggeration;
    }

  private:
    FilesInUse files_;

  public:
    Session session;

  private:
    std::vector<float> depths_m_;
    std::vector<Marks> lists_;
};

scene::Scene scene_of(const std::string& dem, double elevation_deg, double zoom) {
    scene::Scene scene;
    scene.dems = {dem};
    scene.time.at = "2026-06-21T15:30Z";
    scene.width_px = 1280;
    scene.height_px = 1024;
    scene.view.orbit.azimuth_deg = 170;
    scene.view.orbit.aerial = false;
    scene.view.orbit.elevation_deg = elevation_deg;
    scene.view.orbit.zoom = zoom;
    scene.effects.switches.only = std::vector<std::string>{"contours"};
    return scene;
}

std::string jacksboro() {
    return (test::source_dir() / "data/dem/jacksboro.tif").string();
}

/// Least difference of the ground's height from a label's around it [m], and the width of a pixel
/// there, across the view [m].
std::pair<double, double> off_m(const Shown& shown, const SeenGround& seen, const Label& label) {
    double least = 1e9, pixel_m = 0;
    for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx) {
            const int x = static_cast<int>(label.placed.at.x) + dx;
            const int y = static_cast<int>(label.placed.at.y) + dy;
            if (x < 0 || y < 0 || x >= seen.width_px() || y >= seen.height_px()) continue;
            const auto point = seen.point(x, y);
            if (!point) continue;
            least = std::min(least, std::abs(shown.height_m(*point) - label.height_m));
            pixel_m = std::max(pixel_m, 1 / seen.px_per_m(seen.depth_m(x, y)));
        }
    return {least, pixel_m};
}

void check(const std::string& dem, double elevation_deg, double zoom, std::size_t least_labels,
           double exaggeration = 1) {
    scene::Scene scene = scene_of(dem, elevation_deg, zoom);
    scene.exaggeration = exaggeration;
    Shown shown(scene);
    const std::vector<Label> labels = shown.labels();
    EXPECT_GE(labels.size(), least_labels);
    const SeenGround seen = shown.seen();
    double worst_m = 0, worst_px = 0, sum_px = 0, moved_px = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const Label& label = labels[i];
        EXPECT_LE(std::abs(label.placed.turn_deg), 90 + 1e-9);
        const auto [off, pixel_m] = off_m(shown, seen, label);
        // The drawn ground is off the posts by so many pixels, where marks are not hidden yet.
        // Exaggerated slopes are steeper: the limit is for heights of the DEM.
        EXPECT_LE(off, kHidden_px * pixel_m) << label.placed.words;
        sum_px += exaggeration * off / pixel_m;
        worst_m = std::max(worst_m, off);
        worst_px = std::max(worst_px, exaggeration * off / pixel_m);
        moved_px = std::max(moved_px, distance(label.projected, label.placed.at));
        for (std::size_t j = 0; j < i; ++j) {
            const chart::Rect &a = label.placed.box, &b = labels[j].placed.box;
            EXPECT_FALSE(a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height &&
                         b.y < a.y + a.height);
            if (label.placed.words == labels[j].placed.words) {
                EXPECT_GE(distance(label.placed.at, labels[j].placed.at), 300);
            }
        }
    }
    const double coarser = std::clamp(exaggeration, 1.0, 2.0);  // of exaggerated ground
    EXPECT_LE(sum_px, 0.4 * coarser * static_cast<double>(labels.size()));
    EXPECT_LE(moved_px, kHidden_px + 1);  // none is drawn where hidden ground would be
    fmt::print(
        "[ heights ] {}, elevation {}, zoom {}: {} labels, ground off by at most {:.2f} m, "
        "{:.2f} px, mean {:.2f} px\n",
        std::filesystem::path(dem).filename().string(), elevation_deg, zoom, labels.size(), worst_m,
        worst_px, sum_px / static_cast<double>(labels.size()));
}

TEST(ContourHeights, StandOnGroundOfTheirHeight) {
    check(jacksboro(), 89.9, 1, 8);
    check(jacksboro(), 35, 2.5, 15);
    check(jacksboro(), 20, 8, 6);
    check(jacksboro(), 35, 2.5, 15, 3);
}

TEST(ContourHeights, StandOnGroundOfTheirHeightOnOtherDems) {
    SKIP_WITHOUT_TEST_DATA(data);
    check((data / "dem/tyrol_aw3d30_n47e011_1s_cog.tif").string(), 89.9, 1, 8);
    check((data / "dem/tyrol_aw3d30_n47e011_1s_cog.tif").string(), 30, 5, 20);
    check((data / "dem/mt_rainier_90m.tif").string(), 30, 2, 8);
    check((data / "dem/holyroodpark.tif").string(), 30, 2, 6);
}

TEST(ContourHeights, StayWhileTheCameraMoves) {
    scene::Scene scene = scene_of(jacksboro(), 35, 2.5);
    Shown shown(scene);
    std::size_t kept = 0, all = 0;
    std::vector<Label> before;
    for (int step = 0; step < 12; ++step) {
        scene.view.orbit.azimuth_deg = 170 + 0.25 * step;
        scene.view.orbit.zoom = 2.5 * std::pow(1.01, step);
        test::look(shown.session, scene.view);
        shown.session.draw();
        const std::vector<Label> now = shown.labels();
        const SeenGround seen = shown.seen();
        for (const Label& label : before) {
            const auto at = seen.project(label.at_m);
            // Those near the edge come and go.
            if (!at || at->x < 60 || at->y < 60 || at->x > 1220 || at->y > 964) continue;
            all += 1;
            kept += std::ranges::any_of(now, [&](const Label& other) {
                return other.height_m == label.height_m && distance(other.projected, *at) < 10;
            });
        }
        before = now;
    }
    fmt::print("[ heights ] {} of {} labels stay from frame to frame\n", kept, all);
    EXPECT_GT(all, 150u);
    EXPECT_GE(static_cast<double>(kept), 0.93 * static_cast<double>(all));
}

/// Processor time of this thread, on which modules and marks are worked out [ms].
double processor_ms() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

TEST(ContourHeights, TakeFewMilliseconds) {
    scene::Scene scene = scene_of(jacksboro(), 35, 2.5);
    Shown shown(scene);
    std::array<double, 2> frame_ms{1e9, 1e9}, first_ms{}, marks_ms{1e9, 1e9};
    for (int step = 0; step < 24; ++step) {
        const auto on = static_cast<std::size_t>(step % 2);
        test::set(shown.session, "contours.labels", on ? "true" : "false");
        scene.view.orbit.azimuth_deg = 170 + 10 * step;  // ground that was not seen yet
        test::look(shown.session, scene.view);
        double began_ms = processor_ms();
        shown.session.draw();
        first_ms[on] = std::max(first_ms[on], processor_ms() - began_ms);
        began_ms = processor_ms();
        shown.session.draw();
        frame_ms[on] = std::min(frame_ms[on], processor_ms() - began_ms);
        began_ms = processor_ms();
        shown.labels();
        marks_ms[on] = std::min(marks_ms[on], processor_ms() - began_ms);
    }
    fmt::print(
        "[ heights ] 1280 x 1024: {:.1f} ms a frame, {:.1f} ms to place them; a first frame {:.1f} "
        "ms at most, {:.1f} without\n",
        frame_ms[1] - frame_ms[0], marks_ms[1] - marks_ms[0], first_ms[1], first_ms[0]);
    EXPECT_LT(frame_ms[1] - frame_ms[0], 30);
}

TEST(ContourHeights, AreTheSameWhateverWasDrawnBefore) {
    const scene::Scene scene = scene_of(jacksboro(), 35, 2.5);
    Shown fresh(scene);
    const image::Image8 picture = fresh.session.picture();
    scene::Scene other = scene;
    other.view.orbit.zoom = 6;
    Shown moved(other);
    test::look(moved.session, scene.view);
    moved.session.draw();
    EXPECT_EQ(picture.values, moved.session.picture().values);
}

TEST(ContourHeights, AreOffWithTheirParameter) {
    scene::Scene scene = scene_of(jacksboro(), 35, 2.5);
    scene.effects.settings = {{"contours.labels", "false"}};
    Shown shown(scene);
    EXPECT_TRUE(shown.labels().empty());
    test::set(shown.session, "contours.labels", "true");
    shown.session.draw();
    EXPECT_GT(shown.labels().size(), 15u);
}

/// A slope from 0 m at the south to 1600 m, with a plateau of exactly 500 m in its west half, and
/// sea floor in the south.
TEST(ContourHeights, KeepOffFlatGroundAndWater) {
    test::Raster raster;
    raster.columns = raster.rows = 200;
    raster.value = [](int column, int row, int) {
        const double slope_m = 10.0 * (160 - row);
        if (slope_m < 0) return slope_m;
        return column < 100 && row > 80 && row < 130 ? 500.0 : slope_m;
    };
    const std::string dem =
        test::write_raster(test::scratch_dir("plateau") / "plateau.tif", raster);
    scene::Scene scene = scene_of(dem, 89.9, 1);
    scene.effects.settings = {{"contours.interval_m", "50"}, {"contours.label_apart_px", "60"}};
    Shown shown(scene);
    const dem::Grid grid = dem::Source::open(dem).grid();
    std::set<double> levels;
    for (const Label& label : shown.labels()) {
        const glm::dvec2 post = grid.post(label.place->at.place);
        levels.insert(label.height_m);
        EXPECT_GT(label.height_m, 0);
        EXPECT_FALSE(post.x < 98 && post.y > 82 && post.y < 128) << label.height_m;
        if (label.height_m == 500) {
            EXPECT_GT(post.x, 96);
        }
    }
    EXPECT_THAT(levels, testing::IsSupersetOf({250.0, 500.0, 750.0, 1000.0, 1250.0}));
}

}  // namespace
}  // namespace relevo::session::test_contour_heights
