// Where the pictures of a contact sheet are, what stands below them, and that each is the job's.
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "base/log.h"
#include "session/batch.h"
#include "session/contact_sheet.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_contact_sheet {
namespace {

scene::Shot shot_at(const std::string& time, std::map<std::string, std::string> names) {
    return {.utc = sun::parse_time(time).utc,
            .zone = sun::Zone::named("Europe/Zurich"),
            .names = std::move(names)};
}

TEST(SheetLayout, CellsAreApartAndWithinTheSheet) {
    const SheetLayout layout = SheetLayout::of(7, {1280, 720}, 3);
    EXPECT_EQ(layout.rows, 3);
    EXPECT_EQ(layout.cell_px, glm::ivec2(320, 180));
    EXPECT_EQ(layout.corner_px(0), glm::ivec2(12, 12));
    EXPECT_EQ(layout.corner_px(4), glm::ivec2(12 + 332, 12 + 216));
    EXPECT_EQ(layout.size_px(), glm::ivec2(12 + 3 * 332, 12 + 3 * 216));
    EXPECT_EQ(SheetLayout::of(96, {1280, 1024}, 0).columns, 10);
    EXPECT_EQ(SheetLayout::of(2, {1280, 1024}, 9).columns, 2);
}

TEST(SheetLayout, RefusesSheetsThatAreTooLarge) {
    EXPECT_EQ(
        test::error_of([] {
            SheetLayout::of(1000, {1280, 720}, 1);
        }),
        "exit 3: --contact-sheet: 1000 pictures in 1 columns need 344 x 216012 px, expected at "
        "most 16384 px a side and 100 million in all; use other --columns or fewer pictures");
    EXPECT_NO_THROW(SheetLayout::of(1000, {1280, 720}, 0));
}

TEST(SheetCaptions, SayWhatDiffers) {
    const std::vector<std::string> both =
        captions_of({shot_at("2026-06-21T08:00Z", {{"camera", "north"}, {"site", "hut"}}),
                     shot_at("2026-06-21T08:00Z", {{"camera", "east"}, {"site", "hut"}})});
    EXPECT_EQ(both[0], "north");
    EXPECT_EQ(both[1], "east");
    const std::vector<std::string> times =
        captions_of({shot_at("2026-06-21T08:00Z", {{"haze.density", "0"}}),
                     shot_at("2026-12-21T08:00:30Z", {{"haze.density", "0.2"}})});
    EXPECT_EQ(times[0], "2026-06-21 10:00 UTC+02:00, haze.density 0");
    EXPECT_EQ(times[1], "2026-12-21 09:00:30 UTC+01:00, haze.density 0.2");
}

TEST(ContactSheet, HasTheJobsPicturesScaledDown) {
    const std::filesystem::path sheet_path = test::scratch_dir() / "sheet.png";
    std::vector<scene::Shot> shots;
    for (const char* const time : {"2026-06-21T13:00:00Z", "2026-06-21T23:00:00Z"}) {
        scene::Shot shot = shot_at(time, {});
        shot.scene.dems = {(test::source_dir() / "data/dem/jacksboro.tif").string()};
        shot.scene.time.at = time;
        shot.scene.view = scene::parse_view("az=200,el=35");
        shot.scene.width_px = 640;
        shot.scene.height_px = 400;
        shots.push_back(shot);
    }
    FilesInUse files;
    SceneTimes times;
    const SheetReport report = draw_contact_sheet(
        shots, {.device = test::gl_device(), .output = sheet_path}, times, files);
    const image::Image8 sheet = image::read(sheet_path);
    EXPECT_EQ(glm::ivec2(sheet.width, sheet.height), report.size_px);
    const SheetLayout layout = SheetLayout::of(2, {640, 400}, 0);
    for (std::size_t i = 0; i < shots.size(); ++i) {
        Session session(shots[i].scene, {.device = test::gl_device(), .format = PictureFormat{}},
                        files);
        const auto picture = std::get<image::Image8>(session.make_picture().pixels);
        double off = 0;
        for (int y = 0; y < layout.cell_px.y; ++y)
            for (int x = 0; x < layout.cell_px.x; ++x) {
                const glm::ivec2 at = layout.corner_px(i) + glm::ivec2(x, y);
                double mean = 0;
                for (int k = 0; k < 4; ++k)
                    mean += 0.25 * picture.at(2 * x + k % 2, 2 * y + k / 2, 1);
                off += std::abs(mean - sheet.at(at.x, at.y, 1));
            }
        EXPECT_LT(off / (layout.cell_px.x * layout.cell_px.y), 2.0);
    }
}

}  // namespace
}  // namespace relevo::session::test_contact_sheet
