// Figures of the sun that lie on the ground of the window, against those of the command line.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/error.h"
#include "dem/load.h"
#include "overlay/band_over.h"
#include "viewer/sun_overlay.h"
#include "window/viewer_fixture.h"

namespace relevo::viewer::test_sun_overlay {
namespace {

std::string bundled_path() {
    return (test::source_dir() / "data/dem/jacksboro.tif").string();
}

void run(const std::string& arguments) {
    const std::string command =
        fmt::format("{} -q {} > /dev/null", (test::build_dir() / "bin/relevo").string(), arguments);
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

constexpr OverlayChoice kDay{.kind = OverlayKind::Hours}, kMask{.kind = OverlayKind::Mask};

OverlayWanted of(const std::string& file, const OverlayChoice& choice,
                 const MemoryBudget& memory = dem::LoadOptions{}.memory) {
    dem::Source source = dem::Source::open(file);
    dem::Heightfield field = dem::load(source, memory);
    OverlayWanted wanted;
    wanted.dem = std::make_shared<const session::LoadedDem>(session::LoadedDem{
        std::make_shared<const dem::Source>(std::move(source)), std::move(field)});
    wanted.dems = {file};
    wanted.options.memory = memory;
    wanted.figure = figure_of(choice, sun::parse_time("2026-12-24T16:00:00Z").utc,
                              sun::Zone::named("America/New_York"), "standard");
    return wanted;
}

/// An answer that there is nothing more to be had of.
std::shared_ptr<const OverlayShown> end_of(const OverlayWork& work) {
    EXPECT_TRUE(test::WindowedProgram::wait([&] { return work.is_done(); }));
    return work.answer();
}

TEST(SunOverlay, HasTheFiguresOfTheCommandLine) {
    const OverlayChoice week{.kind = OverlayKind::Hours, .period = OverlayPeriod::Week};
    const OverlayChoice first{.kind = OverlayKind::FirstLight};
    const OverlayChoice last{.kind = OverlayKind::LastLight, .period = OverlayPeriod::Year};
    const OverlayChoice irradiation{.kind = OverlayKind::Irradiation};
    const OverlayChoice sky{.kind = OverlayKind::SkyView};
    const struct {
        OverlayChoice choice;
        const char* verb;
        const char* title;
        const char* unit;
    } cases[] = {
        {kDay, "hours --date 2026-12-24", "Sun hours, 24 Dec 2026", "h"},
        {week, "hours --from 2026-12-21 --to 2026-12-27", "Sun hours, 21 Dec to 27 Dec 2026", "h"},
        {first, "hours --bands first --date 2026-12-24", "First light, 24 Dec 2026", ""},
        {last, "hours --bands last --date 2026-12-24", "Last light, 24 Dec 2026", ""},
        {irradiation, "hours --bands global --date 2026-12-24", "Irradiation, 24 Dec 2026",
         "kWh/m2"},
        {kMask, "shadow --time 2026-12-24T16:00Z", "Direct sun, 24 Dec 2026, 11:00", "1"},
        {sky, "sky-view", "Sky-view factor", "1"},
    };
    const auto file = test::scratch_dir() / "sun.tif";
    OverlayWork work([] {});
    for (const auto& [choice, verb, title, unit] : cases) {
        const OverlayWanted wanted = of(bundled_path(), choice);
        work.want(wanted);
        const auto shown = end_of(work);
        ASSERT_EQ(shown->error, "");
        EXPECT_TRUE(shown->is_whole());
        EXPECT_EQ(shown->overlay.legend->title, title);
        EXPECT_EQ(shown->overlay.legend->unit, unit);
        run(fmt::format("sun {} {} -o {} --overwrite", verb, bundled_path(), file.string()));
        const overlay::BandOver band =
            overlay::read_band_over(wanted.dem->field.grid, file.string(), 1);
        // Where places are looked up figures are mixed with a millionth of their neighbours'.
        const session::Overlay read =
            session::read_overlay({.file = file.string()}, wanted.dem->field.grid);
        ASSERT_EQ(shown->raster->values.size(), band.values.size());
        int others = 0;
        for (std::size_t i = 0; i < band.values.size(); ++i) {
            const float value = shown->raster->values.data()[i], written = band.values.data()[i];
            ASSERT_EQ(std::isnan(value), std::isnan(written)) << verb;
            // A value at the side of a post without light is that of its post alone.
            if (std::isnan(value)) continue;
            ASSERT_NEAR(value, written, 1e-3) << verb;
            others += shown->overlay.raster->rgba.data()[i] != read.raster->rgba.data()[i];
        }
        EXPECT_LT(others, 1e-3 * static_cast<double>(band.values.size())) << verb;
        // A point that is looked at has the nearest post's.
        const geo::Geodetic place = wanted.dem->field.grid.place(120.3, 77.8);
        EXPECT_NEAR(shown->value_at(place), band.values.at(120, 78), 1e-4);
    }
    EXPECT_TRUE(std::isnan(work.answer()->value_at(geo::geodetic_deg(40, -84, 0))));
}

TEST(SunOverlay, APointsHoursAreThoseOfItsDay) {
    OverlayWork work([] {});
    const OverlayWanted wanted = of(bundled_path(), kDay);
    work.want(wanted);
    const auto shown = end_of(work);
    const geo::Geodetic place = wanted.dem->field.grid.place(150, 200);
    const auto csv = test::scratch_dir() / "day.json";
    run(fmt::format(
        "sun day {} --at {:.9f},{:.9f} --date 2026-12-24 --tz America/New_York --json > {}",
        bundled_path(), place.lat_rad * 180 / M_PI, place.lon_rad * 180 / M_PI,
        csv.string() + " #"));
    const auto day = nlohmann::json::parse(read_text(csv, "test"))["days"][0];
    // A ray of its own against a sweep: 2 minutes.
    EXPECT_NEAR(shown->value_at(place), day["direct_sun_h"].get<double>(), 2 / 60.0);
}

/// A DEM of more posts than have their figures first.
std::string larger_dem() {
    const auto file = test::scratch_dir("dem") / "larger.tif";
    const std::string command =
        fmt::format("{} {} 800 700 {}", (test::build_dir() / "bin/make_dem").string(),
                    bundled_path(), file.string());
    EXPECT_EQ(std::system(command.c_str()), 0);
    return file.string();
}

TEST(SunOverlay, IsCoarseFirstAndGivenUpForWhatIsWantedThen) {
    const OverlayWanted day = of(larger_dem(), kDay);
    OverlayWanted year = day;
    year.figure = figure_of({.kind = OverlayKind::Hours, .period = OverlayPeriod::Year},
                            day.figure.time.begin, day.figure.zone, "standard");
    OverlayWork* of_answers = nullptr;
    std::mutex mutex;
    std::vector<std::shared_ptr<const OverlayShown>> answers;
    OverlayWork work([&] {
        const std::lock_guard lock(mutex);
        const auto answer = of_answers->answer();
        if (answer && (answers.empty() || answers.back() != answer)) answers.push_back(answer);
    });
    of_answers = &work;
    const auto count = [&] {
        const std::lock_guard lock(mutex);
        return answers.size();
    };
    work.want(year);
    while (count() == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_GT(answers[0]->every, 1.5);
    EXPECT_FALSE(work.is_done());
    EXPECT_LT(work.progress(), 1);
    const auto began = std::chrono::steady_clock::now();
    work.want(day);
    const auto last = end_of(work);
    const double took_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    fmt::print("[ measured ] a day of 560 000 posts instead of a year after {:.2f} s\n", took_s);
    ASSERT_TRUE(work.is_done());  // no answer comes any more
    EXPECT_TRUE(last->is_whole());
    EXPECT_TRUE(same_figures(last->of, day));
    for (const auto& answer : answers)
        EXPECT_FALSE(answer->is_whole() && same_figures(answer->of, year));
    // What is shown first is much the same.
    const auto coarse = std::find_if(answers.begin(), answers.end(), [&](const auto& answer) {
        return same_figures(answer->of, day);
    });
    ASSERT_NE((*coarse)->every, 1);
    double sum = 0, least = 24;
    for (int row = 10; row < 700; row += 20)
        for (int column = 10; column < 800; column += 20) {
            const geo::Geodetic place = day.dem->field.grid.place(column, row);
            sum += std::abs((*coarse)->value_at(place) - last->value_at(place));
            least = std::min(least, last->value_at(place));
        }
    EXPECT_LT(sum / (30 * 35), 0.8);
    EXPECT_LT(least, 7);  // so that it means something
    // Other colours of what is there are no work.
    OverlayWanted faint = day;
    faint.opacity = 0.5;
    work.want(faint);
    EXPECT_EQ(end_of(work)->raster, last->raster);
    EXPECT_EQ(work.answer()->overlay.raster->rgba.at(400, 300) >> 24, 128u);
    // Closed amidst of it.
    work.want(year);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    work.forget();
    EXPECT_EQ(work.answer(), nullptr);
    work.want(year);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

TEST(SunOverlay, IsSavedOfEveryPostAlsoWhereMemoryHasFewer) {
    const std::string larger = larger_dem();
    const auto folder = test::scratch_dir();
    std::filesystem::current_path(folder);
    run(fmt::format("sun shadow {} --time 2026-12-24T16:00Z -o {}", larger,
                    (folder / "command.tif").string()));
    const OverlayWanted wanted = of(larger, kMask, MemoryBudget::of_posts(400'000));
    ASSERT_GT(wanted.dem->field.reduction, 1);
    OverlayWork work([] {});
    work.want(wanted);
    const auto shown = end_of(work);
    EXPECT_FALSE(shown->is_whole());
    EXPECT_GT(shown->every, 1.9);
    const auto count = [&] {
        return std::distance(std::filesystem::directory_iterator(folder), {});
    };
    const auto before = count();
    {
        const OverlaySave given_up(wanted, nullptr, [] {});
    }
    EXPECT_EQ(count(), before);
    const OverlaySave save(wanted, nullptr, [] {});
    while (!save.is_done())
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_GT(save.progress(), 0.9);
    EXPECT_EQ(save.result(), "relevo-1.tif");
    EXPECT_EQ(read_text(folder / "relevo-1.tif", "test"),
              read_text(folder / "command.tif", "test"));
}

TEST(SunOverlay, SaysWhyThereIsNone) {
    OverlayWork work([] {});
    OverlayWanted wanted = of(bundled_path(), kDay);
    wanted.file = scene::Overlay{.file = "/no/such.tif"};
    work.want(wanted);
    EXPECT_THAT(end_of(work)->error, testing::HasSubstr("/no/such.tif"));
    EXPECT_EQ(work.answer()->overlay.raster, nullptr);
}

}  // namespace
}  // namespace relevo::viewer::test_sun_overlay

namespace relevo {
namespace {

constexpr glm::ivec4 kGround{400, 120, 640, 560};

/// Pixels in colours of the built-in ramp "sun", between its purples and its yellows.
int orange(const image::Image8& screen) {
    return count_near(screen, kGround, {0xf8, 0xb4, 0x4c}, 40);
}

TEST_F(Viewer, LaysTheShownDaysSunHoursOnTheGroundAndSavesThem) {
    const std::vector<std::string> arguments{dem_, "--only", "--time", "2026-12-21T16:00Z"};
    open(arguments);
    const int plain = orange(display_.screen());
    ASSERT_TRUE(changes([&] { act({"key", "o"}); }));
    EXPECT_GT(orange(display_.screen()), plain + 50000);
    // In no file yet: it is in no scene.
    EXPECT_FALSE(scene().contains("overlay"));
    EXPECT_TRUE(wait([&] {
        return program_->output().find("without the overlay") != std::string::npos;
    })) << program_->output();
    act({"key", "ctrl+e"});
    ASSERT_TRUE(wait([&] { return std::filesystem::exists(folder_ / "relevo-1.tif"); }));
    ASSERT_TRUE(settles());
    test::WindowedProgram hours(display_, test::build_dir() / "bin/relevo",
                                {"-q", "sun", "hours", dem_, "--date", "2026-12-21", "-o",
                                 (folder_ / "command.tif").string()});
    ASSERT_EQ(hours.status(), 0) << hours.output();
    EXPECT_EQ(read_text(folder_ / "relevo-1.tif", "test"),
              read_text(folder_ / "command.tif", "test"));
    const auto saved = scene();
    EXPECT_EQ(saved["overlay"]["file"], "relevo-1.tif");
    EXPECT_EQ(saved["overlay"]["title"], "Sun hours, 21 Dec 2026");
    // The picture with its legend is that of a capture of the scene, and of the command in it.
    act({"key", "F12"});
    ASSERT_TRUE(wait([&] { return std::filesystem::exists(folder_ / "relevo-1.png"); }));
    test::WindowedProgram capture(
        display_, test::build_dir() / "bin/relevo",
        {"-q", "capture", "--scene", (folder_ / fmt::format("relevo-{}.json", saved_)).string(),
         "-o", (folder_ / "captured.png").string()});
    ASSERT_EQ(capture.status(), 0) << capture.output();
    const image::Image8 taken = image::read(folder_ / "relevo-1.png");
    EXPECT_LE(test::difference(taken, image::read(folder_ / "captured.png"), 1), 2e-4);
    EXPECT_THAT(read_text(folder_ / "relevo-1.png", "test"), testing::HasSubstr("--overlay "));
    // Another day has other figures, which are in no file.
    ASSERT_TRUE(changes(
        [&] {
            act({"key", "--repeat", "60", "--delay", "10", "shift+bracketright"});
        },
        0.02));
    EXPECT_FALSE(scene().contains("overlay"));
    act({"key", "ctrl+z"});
    ASSERT_TRUE(settles());
    // Off, and on again by undo.
    ASSERT_TRUE(changes([&] { act({"key", "o"}); }));
    EXPECT_LT(orange(display_.screen()), plain + 5000);
    ASSERT_TRUE(changes([&] { act({"key", "ctrl+z"}); }));
    EXPECT_GT(orange(display_.screen()), plain + 50000);
}

TEST_F(Viewer, APictureHasTheLegendsOfWhatColoursTheGround) {
    open({dem_, "--preset", "slope", "--time", "2026-06-21T20:00:00Z"});
    act({"key", "F12"});
    const auto taken = folder_ / "relevo-1.png";
    ASSERT_TRUE(wait([&] { return std::filesystem::exists(taken); })) << program_->output();
    const auto capture = [&](const std::string& name, const std::vector<std::string>& options) {
        std::vector<std::string> arguments{"-q",           "capture", "--from",
                                           taken.string(), "-o",      (folder_ / name).string()};
        arguments.insert(arguments.end(), options.begin(), options.end());
        test::WindowedProgram program(display_, test::build_dir() / "bin/relevo", arguments);
        EXPECT_EQ(program.status(), 0) << program.output();
        return image::read(folder_ / name);
    };
    const image::Image8 picture = image::read(taken);
    EXPECT_LE(test::difference(picture, capture("with.png", {}), 1), 2e-4);
    EXPECT_GT(test::difference(picture, capture("without.png", {"--no-legend"}), 1), 0.005);
}

TEST_F(Viewer, APictureHasTheScenesStamps) {
    open({dem_, "--stamp", "title,scale,north,graticule,date,sun", "--title", "A ridge", "--time",
          "2026-06-21T20:00:00Z", "--tz", "Asia/Tokyo"});
    act({"key", "F12"});
    const auto taken = folder_ / "relevo-1.png";
    ASSERT_TRUE(wait([&] { return std::filesystem::exists(taken); })) << program_->output();
    const auto captured = [&](const std::vector<std::string>& options) {
        std::vector<std::string> arguments{"-q",         "capture",
                                           "--from",     taken.string(),
                                           "-o",         (folder_ / "captured.png").string(),
                                           "--overwrite"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        test::WindowedProgram program(display_, test::build_dir() / "bin/relevo", arguments);
        EXPECT_EQ(program.status(), 0) << program.output();
        return image::read(folder_ / "captured.png");
    };
    const image::Image8 picture = image::read(taken);
    EXPECT_LE(test::difference(picture, captured({}), 1), 2e-4);
    EXPECT_GT(test::difference(picture, captured({"--stamp", "none"}), 1), 0.02);
    EXPECT_THAT(read_text(taken, "test"),
                testing::AllOf(testing::HasSubstr("--stamp title,scale,north,graticule,date,sun "),
                               testing::HasSubstr("--title 'A ridge' ")));
}

TEST_F(Viewer, AScenesOverlayIsThereAndCanBeTakenAway) {
    test::WindowedProgram sky(display_, test::build_dir() / "bin/relevo",
                              {"-q", "sun", "hours", dem_, "--date", "2026-12-21", "-o",
                               (folder_ / "hours.tif").string()});
    ASSERT_EQ(sky.status(), 0) << sky.output();
    open({dem_, "--only", "--overlay", (folder_ / "hours.tif").string(), "--overlay-title", "H"});
    EXPECT_GT(orange(display_.screen()), 50000);
    EXPECT_EQ(scene()["overlay"]["title"], "H");
    // By the panel: its choice, the first entry.
    const glm::ivec4 box{90, 216, 200, 18}, choice{90, 240, 200, 16};
    ASSERT_TRUE(changes_in(box, [&] { act({"mousemove", "170", "225"}); }));
    ASSERT_TRUE(changes_in(choice, [&] { act({"click", "1"}); }));
    ASSERT_TRUE(changes_in(choice, [&] { act({"mousemove", "190", "248"}); }));
    ASSERT_TRUE(changes([&] { act({"click", "1"}); }));
    EXPECT_LT(orange(display_.screen()), 5000);
    EXPECT_FALSE(scene().contains("overlay"));
}

}  // namespace
}  // namespace relevo
