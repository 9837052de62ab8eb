// The export sheet: what it asks for becomes a file, and no file is lost by it.
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>

#include "base/error.h"
#include "viewer/file_export.h"
#include "viewer/settings.h"
#include "window/viewer_fixture.h"

namespace relevo::test_export {
namespace {

using namespace viewer;
namespace fs = std::filesystem;
using test::WindowedProgram;
using testing::ElementsAre;
using testing::HasSubstr;

class ExportOrders : public testing::Test {
  protected:
    ExportOrders() { scene_.dems = {(test::source_dir() / "data/dem/jacksboro.tif").string()}; }
    ExportOrder order() const {
        return order_of(choice_, stamps_, scene_, sun::parse_time("2026-06-21T18:00:00Z").utc,
                        sun::Zone::named("America/New_York"));
    }
    const fs::path folder_ = test::scratch_dir("export_orders");
    scene::Scene scene_;
    scene::Stamps stamps_;
    ExportChoice choice_;
};

TEST_F(ExportOrders, NameTheFileByFolderPatternAndFormat) {
    EXPECT_EQ(order().path, "jacksboro_20260621T1400.png");
    choice_.folder = folder_.string();
    choice_.format = kJpeg;
    EXPECT_EQ(order().path, folder_ / "jacksboro_20260621T1400.jpg");
    EXPECT_EQ(order().encoding.quality, choice_.quality);
    choice_.name = "noon";
    choice_.set_kind(kSolid);
    EXPECT_EQ(order().path, folder_ / "noon.stl");
    choice_.set_kind(kFigures);
    EXPECT_EQ(order().path, folder_ / "noon.tif");
    ::setenv("HOME", folder_.c_str(), 1);
    choice_.folder = "~";
    EXPECT_EQ(order().path, folder_ / "noon.tif");
}

TEST_F(ExportOrders, SayWhatCannotBe) {
    const auto fault = [&] {
        try {
            order();
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(fault(), "");
    choice_.folder = (folder_ / "nowhere").string();
    EXPECT_THAT(fault(), HasSubstr("nowhere: there is no such folder"));
    choice_.folder.clear();
    choice_.name = "{dam}";
    EXPECT_THAT(fault(), HasSubstr("dam"));
    choice_.name.clear();
    EXPECT_THAT(fault(), HasSubstr("name is empty"));
    choice_.name = "wide";
    choice_.format = 3;  // WebP has sides of at most 16383
    choice_.size_px = {20000, 100};
    EXPECT_THAT(fault(), HasSubstr("20000"));
}

TEST_F(ExportOrders, ListAllFilesThatTheyWrite) {
    choice_.name = "a";
    EXPECT_THAT(files_of(order()), ElementsAre("a.png"));
    choice_.set_kind(kMap);
    EXPECT_THAT(files_of(order()), ElementsAre("a.tif"));
    choice_.format = kPng;
    EXPECT_THAT(files_of(order()), ElementsAre("a.png", "a.pgw", "a.png.aux.xml"));
    choice_.format = 4;  // AVIF has no room for a scene
    EXPECT_THAT(files_of(order()), testing::Contains("a.avif"));
}

TEST_F(ExportOrders, UsesSetSizeFormatAndStamps) {
    for (const ExportUse& use : kExportUses) {
        use.apply_to(choice_, stamps_, {800, 600});
        EXPECT_EQ(use.is_of(choice_), use.size_px.x > 0) << use.name;
        EXPECT_EQ(stamps_.margin, use.is_stamped) << use.name;
        EXPECT_NO_THROW(order()) << use.name;
        ++choice_.size_px.x;
        EXPECT_FALSE(use.is_of(choice_)) << use.name;
    }
    // A kind keeps no format of another.
    choice_.set_kind(kMap);
    EXPECT_EQ(choice_.format, kTiff);
    choice_.set_kind(kPicture);
    EXPECT_EQ(choice_.format, kPng);
}

TEST_F(ExportOrders, MeshesHaveTheirCommand) {
    choice_.set_kind(kSolid);
    choice_.name = "a";
    choice_.error_m = 5;
    scene_.exaggeration = 2;
    scene_.dem.crs = "EPSG:4326";
    scene_.holes = dem::Holes::Mark;  // pictures alone are painted
    EXPECT_THAT(command_of(order()),
                testing::AllOf(HasSubstr("relevo export mesh "), HasSubstr(" --crs EPSG:4326"),
                               HasSubstr(" --exaggerate 2"), HasSubstr(" --error 5 --base auto"),
                               HasSubstr(" -o a.stl"), testing::Not(HasSubstr("mark"))));
}

TEST_F(ExportOrders, MeshesAreThoseOfTheirCommand) {
    choice_.folder = folder_.string();
    choice_.name = "window";
    choice_.error_m = 20;
    for (const int kind : {kMesh, kSolid}) {
        choice_.set_kind(kind);
        const ExportOrder wanted = order();
        const auto write = [&](ExportOrder order) {
            FileExport file(std::move(order), "software", nullptr, [] {});
            WindowedProgram::wait([&] { return file.is_done(); });
            return file.result();
        };
        EXPECT_THAT(write(wanted), HasSubstr("triangles"));
        EXPECT_THROW(write(wanted), Error) << "it is there already";
        ExportOrder again = wanted;
        again.overwrite = true;
        EXPECT_NO_THROW(write(again));
        again.path = scene_.dems.front();
        EXPECT_THROW(write(again), Error) << "the DEM itself";
        ExportOrder captured = wanted;
        captured.path =
            path_in(choice_.folder, "command" + fs::path(wanted.path).extension().string());
        const std::string command = command_of(captured);
        ASSERT_EQ(std::system(fmt::format("{}/bin/{} > {}", test::build_dir().string(), command,
                                          (folder_ / "said.txt").string())
                                  .c_str()),
                  0);
        EXPECT_TRUE(read_text(wanted.path, "test") == read_text(captured.path, "test"));
    }
}

TEST_F(ExportOrders, OfMeshesSayHowFarTheyAreAndCanBeCancelled) {
    choice_.folder = folder_.string();
    choice_.name = "fine";
    choice_.error_m = 0.02;
    choice_.set_kind(kMesh);
    std::vector<double> shares;
    {
        FileExport* made = nullptr;
        std::atomic<bool> is_made = false;
        FileExport mesh(order(), "software", nullptr, [&] {
            while (!is_made)
                std::this_thread::yield();
            if (made->is_done()) return;
            shares.push_back(made->share());
            if (made->share() > 0.3) made->cancel();
        });
        made = &mesh;
        is_made = true;
        ASSERT_TRUE(WindowedProgram::wait([&] { return mesh.is_done(); }));
        EXPECT_THAT(mesh.result(), HasSubstr("cancelled, no file was written"));
    }
    EXPECT_TRUE(std::ranges::is_sorted(shares));
    ASSERT_GT(shares.size(), 5U);
    EXPECT_LT(shares.front(), 0.01);
    EXPECT_GT(shares.back(), 0.3);
    EXPECT_LT(shares.back(), 0.5);
    EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(ExportOrders, MapSheetsAreThoseOfTheirCommand) {
    choice_.folder = folder_.string();
    choice_.name = "sheet";
    choice_.is_transparent = true;  // pictures alone are
    choice_.set_kind(kSheet);
    choice_.map_scale = 2e6;
    stamps_.scale = stamps_.north = true;
    scene_.time.at = "2026-06-21T18:00:00Z";
    const ExportOrder wanted = order();
    EXPECT_EQ(wanted.path, folder_ / "sheet.pdf");
    EXPECT_THAT(files_of(wanted), ElementsAre(wanted.path));
    EXPECT_THAT(command_of(wanted),
                testing::AllOf(HasSubstr(" --sheet a4"), HasSubstr(" --map-scale 2000000"),
                               testing::Not(HasSubstr("--size"))));
    FilesInUse files;
    scene::Scene scene = scene_;
    session::Session session(scene, {.device = "software"}, files);
    {
        FileExport file(wanted, "software", session.dem(), [] {});
        WindowedProgram::wait([&] { return file.is_done(); });
        EXPECT_THAT(file.result(), HasSubstr("picture saved"));
    }
    ExportOrder captured = wanted;
    captured.path = folder_ / "command.pdf";
    ASSERT_EQ(
        std::system(fmt::format("{}/bin/{} --device software 2> {}", test::build_dir().string(),
                                command_of(captured), (folder_ / "said.txt").string())
                        .c_str()),
        0)
        << read_text(folder_ / "said.txt", "test");
    EXPECT_TRUE(read_text(wanted.path, "test") == read_text(captured.path, "test"));
}

TEST_F(ExportOrders, OfPicturesSayHowFarTheyAreAndCanBeCancelled) {
    choice_.folder = folder_.string();
    choice_.name = "poster";
    choice_.size_px = {3000, 2000};
    choice_.samples = 16;
    FilesInUse files;
    scene::Scene scene = scene_;
    session::Session session(scene, {.device = "software"}, files);
    const ExportOrder poster = order();
    FileExport drawn(poster, "software", session.dem(), [] {});
    ASSERT_TRUE(WindowedProgram::wait([&] { return drawn.share() > 0.1; }));
    EXPECT_TRUE(drawn.can_cancel());
    drawn.cancel();
    ASSERT_TRUE(WindowedProgram::wait([&] { return drawn.is_done(); }));
    EXPECT_LT(drawn.share(), 1);
    EXPECT_THAT(drawn.result(), HasSubstr("cancelled, no file was written"));
    EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(ExportOrders, AreRemembered) {
    const Memory memory(folder_ / "config", folder_ / "state");
    Settings settings;
    settings.exporting = {.kind = kMap,
                          .size_px = {300, 200},
                          .format = kTiff,
                          .samples = 16,
                          .quality = 50,
                          .is_transparent = true,
                          .is_centred = false,
                          .error_m = 2.5,
                          .paper = 3,
                          .map_scale = 25000,
                          .folder = "/some/where",
                          .name = "{dem}"};
    settings.film = {.size_px = {640, 360},
                     .ending = "webm",
                     .quality = 7,
                     .samples = 4,
                     .has_date = true,
                     .name = "x"};
    memory.write(settings);
    EXPECT_EQ(memory.settings(), settings);
    // Whatever stands there, the sheet has what can be.
    std::ofstream(folder_ / "config/settings.json")
        << R"({"export": {"kind": 77, "width_px": 1e300, "quality": -5, "format": "x", "samples": 3,)"
           R"( "error_m": 0, "paper": 9, "map_scale": 0.5, "name": [], "film_format": "avi", "film_samples": 0}})";
    const Settings odd = memory.settings();
    EXPECT_EQ(odd.exporting.kind, kFigures);
    EXPECT_EQ(odd.exporting.format, kPng);
    EXPECT_EQ(odd.exporting.size_px.x, scene::kMaxSide_px);
    EXPECT_EQ(odd.exporting.quality, 1);
    EXPECT_EQ(odd.exporting.samples, 4);
    EXPECT_EQ(odd.exporting.error_m, kLeastError_m);
    EXPECT_EQ(odd.exporting.paper, 4);
    EXPECT_EQ(odd.exporting.map_scale, 0);
    EXPECT_EQ(odd.exporting.name, ExportChoice().name);
    EXPECT_EQ(odd.film.ending, "mp4");
    EXPECT_EQ(odd.film.samples, 1);
}

class ExportWindow : public Viewer {
  protected:
    void press(const std::vector<std::string>& keys) const {
        act(keys);
        std::this_thread::sleep_for(std::chrono::milliseconds(400));
    }
    /// Opens the sheet, whose name field has the keyboard.
    void open_sheet() {
        act({"mousemove", "700", "100"});
        ASSERT_TRUE(changes_in(kSheet, [&] { press({"key", "ctrl+p"}); }));
    }
    /// From the field of the name. Shift is held for as long as a hand does.
    void to_folder() const {
        press({"keydown", "shift"});
        press({"key", "Tab"});
        press({"keyup", "shift"});
    }
    bool appears(const std::string& name) {
        return wait([&] { return fs::exists(folder_ / name); });
    }
    static constexpr glm::ivec4 kSheet{300, 200, 680, 400};
};

TEST_F(ExportWindow, ReturnExportsWhatTheCommandCaptures) {
    open({dem_, "--only", "--time", "2026-06-21T18:00:00Z"});
    // The title of the window names the place, once the names are read.
    EXPECT_TRUE(wait([&] {
        return program_->title().ends_with("jacksboro.tif, near Caryville (US) - Relevo");
    })) << program_->title();
    open_sheet();
    press({"key", "Return"});
    const auto file = folder_ / "jacksboro_20260621T1400.png";
    ASSERT_TRUE(wait([&] { return fs::exists(file); })) << program_->output();
    const auto captured = folder_ / "captured.png";
    test::WindowedProgram capture(
        display_, test::build_dir() / "bin/relevo",
        {"-q", "capture", "--from", file.string(), "-o", captured.string()});
    ASSERT_EQ(capture.status(), 0) << capture.output();
    const image::Image8 a = image::read(file), b = image::read(captured);
    EXPECT_EQ(a.width, 1920);
    EXPECT_EQ(a.height, 1080);
    EXPECT_EQ(test::difference(a, b, 2), 0);
    // The DEM is in the middle: as much sky on the left as on the right.
    const auto first_ground = [&](bool from_left) {
        const int row = 3 * a.height / 5;
        const std::uint8_t* const sky = a.row(2);
        for (int x = 0; x < a.width; ++x) {
            const std::uint8_t* const at = a.row(row) + 3 * (from_left ? x : a.width - 1 - x);
            if (std::abs(at[0] - sky[0]) > 12) return x;
        }
        return a.width;
    };
    EXPECT_LT(std::abs(first_ground(true) - first_ground(false)), a.width / 6);
}

TEST_F(ExportWindow, AsksBeforeAFileIsReplacedAndRemembersTheNextTime) {
    open({dem_, "--only", "--time", "2026-06-21T18:00:00Z"});
    std::ofstream(folder_ / "x.png") << "a letter";
    const auto letter = [&] { return read_text(folder_ / "x.png", "test"); };
    open_sheet();
    press({"key", "ctrl+a"});
    press({"type", "x"});
    press({"key", "Return"});  // asks
    std::this_thread::sleep_for(std::chrono::seconds(2));
    EXPECT_EQ(letter(), "a letter");
    press({"key", "Escape"});  // back to the sheet
    press({"key", "Return"});
    press({"key", "Return"});  // under another name
    ASSERT_TRUE(appears("x-2.png")) << program_->output();
    EXPECT_EQ(letter(), "a letter");
    // A folder that is not there is said; nothing is written.
    to_folder();
    press({"key", "ctrl+a"});
    press({"type", "nowhere"});
    press({"key", "Return"});
    fs::create_directories(folder_ / "nowhere");
    press({"key", "Return"});
    ASSERT_TRUE(appears("nowhere/x.png")) << program_->output();
    press({"key", "Escape"});
    press({"key", "ctrl+q"});
    ASSERT_EQ(program_->status(), 0) << program_->output();
    // The next time folder and name are the same.
    open({dem_, "--only", "--time", "2026-06-21T18:00:00Z"});
    open_sheet();
    press({"key", "Return"});
    press({"key", "Return"});
    EXPECT_TRUE(appears("nowhere/x-2.png")) << program_->output();
}

/// What the sheet cannot write it says, and stays as it is.
TEST_F(ExportWindow, FiguresOfTheOverlayGoWhereTheSheetSays) {
    fs::create_directories(folder_ / "config/relevo");
    std::ofstream(folder_ / "config/relevo/settings.json")
        << R"({"export": {"kind": 9, "folder": "/proc", "name": "hours"}})";
    open({dem_, "--only", "--time", "2026-06-21T18:00:00Z"});
    ASSERT_TRUE(changes([&] { act({"key", "o"}); }));
    open_sheet();
    press({"key", "Return"});
    ASSERT_TRUE(wait([&] {
        return program_->output().find("/proc/hours.tif") != std::string::npos;
    })) << program_->output();
    to_folder();
    press({"key", "ctrl+a", "BackSpace", "Return"});
    EXPECT_TRUE(appears("hours.tif")) << program_->output();
}

}  // namespace
}  // namespace relevo::test_export
