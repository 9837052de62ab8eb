#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include "base/contains.h"
#include "base/text.h"
#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_toggles {
namespace {

#define SKIP_WITHOUT_PLUGIN(id)                                    \
    if (!std::filesystem::exists(source_dir() / "plugins" / (id))) \
    GTEST_SKIP() << "the plugin " << (id) << " is not there"

/// Effects that leave the bundled DEM as it is: they paint voids, slopes that it lacks, what a file
/// has that users name, summits, or the shade of air that another effect draws.
const std::set<std::string> kSilent{"avalanche", "blank",  "drape",  "infill",
                                    "labels",    "shafts", "summits"};

class Toggles : public testing::Test {
  protected:
    Result take(const std::string& name, std::vector<std::string> more) {
        if (std::find(more.begin(), more.end(), "--time") == more.end())
            more.insert(more.end(), {"--time", "2026-06-21T18:30-04:00"});
        more.insert(more.begin(), {"capture", bundled_dem(), "-o", (dir_ / name).string(), "--size",
                                   "96x64", "--overwrite"});
        return relevo(more);
    }
    image::Image8 picture(const std::string& name) { return image::read(dir_ / name); }
    /// What was said, without the line about the chosen view.
    static std::string notices(const Result& run) {
        std::string rest;
        for (const std::string& line : split(run.err, '\n'))
            if (!line.empty() && line.find("relevo: chosen: ") == std::string::npos)
                rest += line + "\n";
        return rest;
    }

    /// Neither the plugin's file nor anything that it declares is in the programs.
    static void expect_absent(const std::string& id, const std::filesystem::path& dump) {
        for (const auto& file : std::filesystem::directory_iterator(dump)) {
            const std::string text = read_text(file.path(), "test");
            for (const std::string& word : {id + ".glsl", id + "_on_"})
                EXPECT_EQ(text.find(word), std::string::npos) << word << " in " << file.path();
        }
    }

    std::filesystem::path dir_ = scratch_dir("toggles");
};

TEST_F(Toggles, OnlyHazePullsInTheSkyAndSaysSo) {
    SKIP_WITHOUT_PLUGIN("haze");
    SKIP_WITHOUT_PLUGIN("sky");
    const Result run = take("a.png", {"--only", "haze"});
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(notices(run), "relevo: haze requires sky: sky is switched on too\n");
    take("b.png", {"--only", "haze,sky"});
    EXPECT_EQ(image::compare(picture("a.png"), picture("b.png")).worst, 0);
}

TEST_F(Toggles, DisablingTheSkyTurnsTheHazeOffAndSaysSo) {
    SKIP_WITHOUT_PLUGIN("haze");
    SKIP_WITHOUT_PLUGIN("sky");
    const Result run = take("a.png", {"--disable", "sky"});
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(notices(run), "relevo: haze is off: it requires sky, sky is disabled\n");
}

TEST_F(Toggles, AllOffIsCoreAloneByteForByte) {
    // A copy of the program's data without any plugin.
    const std::filesystem::path share = dir_ / "share";
    std::filesystem::create_directories(share / "plugins");
    std::filesystem::create_directory_symlink(source_dir() / "shaders", share / "shaders");
    std::filesystem::create_directory_symlink(build_dir() / "share/relevo/data", share / "data");
    const Result bare = relevo({"-q", "capture", bundled_dem(), "-o", (dir_ / "bare.png").string(),
                                "--size", "96x64", "--time", "2026-06-21T18:30-04:00"},
                               {"RELEVO_SHARE=" + share.string()});
    ASSERT_EQ(bare.status, 0) << bare.err;
    take("off.png", {"--only", "", "--dump-shaders", (dir_ / "off").string()});
    // The pixels alone: the scene that each picture carries says what was asked for.
    EXPECT_EQ(image::compare(picture("bare.png"), picture("off.png")).worst, 0);
    for (const auto& plugin : std::filesystem::directory_iterator(source_dir() / "plugins"))
        expect_absent(plugin.path().filename().string(), dir_ / "off");
}

using Ids = std::vector<std::string>;

/// The installed effects and the words of their manifests.
struct Manifests {
    Ids ids;
    std::map<std::string, std::set<std::string>> provides, wants, exclusive;

    Manifests() {
        const auto list = nlohmann::json::parse(relevo({"plugins", "list", "--json"}).out);
        for (const auto& plugin : list["plugins"]) {
            const std::string id = ids.emplace_back(plugin["id"]);
            const auto manifest = nlohmann::json::parse(read_text(
                std::filesystem::path(plugin["folder"].get<std::string>()) / "plugin.json",
                "test"));
            provides[id] = manifest.value("provides", std::set<std::string>{});
            wants[id] = manifest.value("wants", std::set<std::string>{});
            exclusive[id] = manifest.value("exclusive", std::set<std::string>{});
        }
    }
    /// Both with all others need more textures than a device has.
    static bool are_large(const std::string& a, const std::string& b) {
        return std::set{a, b} == std::set<std::string>{"clouds", "drape"};
    }
    bool are_rivals(const std::string& a, const std::string& b) const {
        return share(exclusive.at(a), exclusive.at(b)) || are_large(a, b);
    }
    /// Whether the text of one depends on the other's being on.
    bool know_each_other(const std::string& a, const std::string& b) const {
        return share(wants.at(a), provides.at(b)) || share(wants.at(b), provides.at(a));
    }

  private:
    static bool share(const std::set<std::string>& a, const std::set<std::string>& b) {
        return std::ranges::any_of(a, [&](const std::string& word) { return b.contains(word); });
    }
};

/// Seven selections, of which at least one has both of any two effects, unless they are rivals, and
/// one has the first without the second. An effect is in four: two sets of four of seven share one,
/// and sets of different effects differ.
std::vector<Ids> mixtures(const Manifests& manifests) {
    constexpr unsigned kSelections = 7;
    std::vector<Ids> found(kSelections);
    std::map<std::string, int> uses;
    unsigned sets = 0;
    for (const std::string& id : manifests.ids) {
        do
            ++sets;
        while (std::popcount(sets) != 4);
        EXPECT_LT(sets, 1U << kSelections) << "more effects than sets";
        for (unsigned i = 0; i < kSelections; ++i)
            if (sets >> i & 1U) found[i].push_back(id);
    }
    // Of rivals, the one that was left out more often.
    for (Ids& ids : found) {
        std::ranges::stable_sort(ids, {}, [&](const std::string& id) { return uses[id]; });
        Ids kept;
        for (const std::string& id : ids)
            if (std::ranges::none_of(
                    kept, [&](const std::string& k) { return manifests.are_rivals(k, id); })) {
                kept.push_back(id);
                ++uses[id];
            }
        ids = kept;
    }
    return found;
}

/// None, each effect, mixtures, and the pairs that no mixture stands for.
std::vector<Ids> selections(const Manifests& manifests) {
    std::vector<Ids> found = mixtures(manifests);
    const std::size_t mixed = found.size();
    for (const std::string& a : manifests.ids)
        for (const std::string& b : manifests.ids) {
            if (!(a < b)) continue;
            const auto has_both = [&](const Ids& ids) {
                return contains(ids, a) && contains(ids, b);
            };
            if (manifests.know_each_other(a, b) ||
                std::none_of(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(mixed),
                             has_both))
                found.push_back({a, b});
        }
    for (const std::string& id : manifests.ids)
        found.push_back({id});
    return found;
}

/// A job with a picture of each selection, by its number, and of core alone.
nlohmann::json job_of(const std::vector<Ids>& selections) {
    const std::string lines = (source_dir() / "tests/data/lines/jacksboro.geojson").string();
    nlohmann::json choices = {{{"name", "none"}, {"only", nlohmann::json::array()}}};
    for (std::size_t i = 0; i < selections.size(); ++i) {
        nlohmann::json choice = {{"name", std::to_string(i)}, {"only", selections[i]}};
        // This one draws the lines of a file.
        if (contains(selections[i], std::string("tracks")))
            choice["set"] = {{"tracks.file", lines}};
        choices.push_back(choice);
    }
    return {{"format", 1},
            {"dem", {{"files", {bundled_dem()}}}},
            {"time", {{"at", "2026-06-21T18:30-04:00"}}},
            {"picture", {{"size", {96, 64}}}},
            {"sweep", {{{"effects", choices}}}},
            {"output", "{effects}.png"}};
}

/// The text of two effects is that of each, unless one asks for the other: so not each pair is
/// drawn by itself.
TEST_F(Toggles, EveryPairOfEffectsCompilesAndDraws) {
    const std::vector<Ids> tried = selections(Manifests());
    ASSERT_GE(tried.size(), 10U);
    // One process takes all pictures: starting one for each takes three times as long.
    const std::filesystem::path job = dir_ / "pairs.json";
    std::ofstream(job) << job_of(tried);
    const Result run = relevo({"-q", "run", job.string()});
    ASSERT_EQ(run.status, 0) << run.err;
    const image::Image8 none = picture("none.png");
    for (std::size_t i = 0; i < tried.size(); ++i) {
        const image::Image8 taken = picture(std::to_string(i) + ".png");
        if (std::ranges::all_of(tried[i], [](const auto& id) { return kSilent.contains(id); }))
            continue;
        if (tried[i] == Ids{"agx", "drape"}) continue;  // photographs keep their colours
        EXPECT_GT(image::compare(taken, none).worst, 1)
            << fmt::format("{}", fmt::join(tried[i], ","));
    }
    fmt::print("[ effects  ] {} selections stand for all pairs\n", tried.size());
}

/// The files of a folder with their texts.
std::map<std::string, std::string> files_of(const std::filesystem::path& folder) {
    std::map<std::string, std::string> texts;
    for (const auto& file : std::filesystem::directory_iterator(folder))
        texts[file.path().filename().string()] = read_text(file.path(), "test");
    return texts;
}

TEST_F(Toggles, FiftyInstalledPluginsThatAreOffChangeNothing) {
    const std::string plugins = (dir_ / "fifty").string();
    const std::array copied{"haze", "bloom", "avalanche", "tint", "cover"};
    for (std::size_t i = 0; i < 50; ++i) {
        const std::string id = fmt::format("{}{}", copied[i % copied.size()], i);
        ASSERT_EQ(
            relevo({"plugins", "new", id, "--from", copied[i % copied.size()], "--into", plugins})
                .status,
            0);
    }
    const auto take_with = [&](const std::string& name, const std::string& path) {
        return measured({"-q", "capture", bundled_dem(), "-o", (dir_ / (name + ".png")).string(),
                         "--size", "96x64", "--overwrite", "--time", "2026-06-21T18:30-04:00",
                         "--dump-shaders", (dir_ / name).string(), "--plugin-path", path});
    };
    std::filesystem::create_directories(dir_ / "empty");
    const Measured none = take_with("with_none", (dir_ / "empty").string()),
                   fifty = take_with("with_fifty", plugins);
    ASSERT_EQ(none.run.status, 0) << none.run.err;
    ASSERT_EQ(fifty.run.status, 0) << fifty.run.err;
    EXPECT_EQ(files_of(dir_ / "with_fifty"), files_of(dir_ / "with_none"));
    EXPECT_EQ(image::compare(picture("with_fifty.png"), picture("with_none.png")).worst, 0);
    fmt::print("[ plugins ] 50 that are off: {:+.0f} ms of processor, {:+} MiB\n",
               1000 * (fifty.processor_s - none.processor_s), fifty.peak_mib - none.peak_mib);
    EXPECT_LE(fifty.peak_mib, none.peak_mib + 24);
}

TEST_F(Toggles, AnOverlaysColoursAreTheLegendsWhateverTheLight) {
    const std::filesystem::path folder = dir_ / "plugins/legend";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "plugin.json")
        << R"({"format": 1, "id": "legend", "name": "Legend", "version": "1.0.0"})";
    std::ofstream(folder / "legend.glsl")
        << "uniform float legend_opaque = 1.0; //@ range(0, 1)\n"
           "void legend_on_display(in Surface s, inout vec4 overlay) {\n"
           "    overlay = legend_opaque * vec4(0.8, 0.4, 0.2, 1.0);\n"
           "}\n";
    const glm::ivec3 kColour{204, 102, 51};
    const std::string path = (dir_ / "plugins").string();
    take("plain.png", {"--only", "", "--view", "el=90,zoom=3"});
    const image::Image8 plain = picture("plain.png");
    for (const char* time : {"2026-06-21T18:30-04:00", "2026-06-22T01:00-04:00"}) {
        take("legend.png",
             {"--only", "legend", "--plugin-path", path, "--view", "el=90,zoom=3", "--time", time});
        const image::Image8 legend = picture("legend.png");
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(legend.at(48, 32, c), kColour[c], 1) << time;
    }
    // Half of it lies over half of the picture.
    take("half.png", {"--only", "legend", "--plugin-path", path, "--view", "el=90,zoom=3", "--set",
                      "legend.opaque=0.5"});
    const image::Image8 half = picture("half.png");
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(half.at(48, 32, c), 0.5 * plain.at(48, 32, c) + 0.5 * kColour[c], 1.5);
    // It is no light: linear pictures are without it.
    take("plain.exr", {"--only", "", "--view", "el=90,zoom=3"});
    take("legend.exr", {"--only", "legend", "--plugin-path", path, "--view", "el=90,zoom=3"});
    EXPECT_EQ(image::read_float(dir_ / "plain.exr").values,
              image::read_float(dir_ / "legend.exr").values);
}

TEST_F(Toggles, AbIsWithOnTheLeftAndWithoutOnTheRight) {
    SKIP_WITHOUT_PLUGIN("haze");
    SKIP_WITHOUT_PLUGIN("sky");
    // From within the DEM: a block seen from outside has no air before it.
    const std::vector<std::string> eye{"--eye", "36.30,-84.20,1500", "--heading", "300"};
    const auto from_eye = [&](const char* name, std::vector<std::string> more) {
        more.insert(more.end(), eye.begin(), eye.end());
        return take(name, more).status;
    };
    ASSERT_EQ(from_eye("ab.png", {"--ab", "haze"}), 0);
    ASSERT_EQ(from_eye("with.png", {}), 0);
    ASSERT_EQ(from_eye("without.png", {"--disable", "haze"}), 0);
    const image::Image8 ab = picture("ab.png"), with = picture("with.png"),
                        without = picture("without.png");
    EXPECT_GT(image::compare(with, without).worst, 8);
    for (int y = 0; y < ab.height; ++y) {
        for (int x = 0; x < ab.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                const int expected = x < 47 ? with.at(x, y, c) : x < 49 ? 255 : without.at(x, y, c);
                ASSERT_EQ(ab.at(x, y, c), expected) << x << " " << y;
            }
        }
    }
}

TEST_F(Toggles, AbOfTheOnlyEffectIsThatEffectAgainstTheRest) {
    SKIP_WITHOUT_PLUGIN("haze");
    SKIP_WITHOUT_PLUGIN("layering");
    SKIP_WITHOUT_PLUGIN("sky");
    struct Case {
        std::string only, ab, with, without;
    };
    // What the effect has pulled in stays on the right: the difference is the effect alone.
    for (const Case& c :
         {Case{"layering", "layering", "layering", ""}, Case{"haze", "haze", "haze,sky", "sky"},
          Case{"haze,layering", "haze", "haze,layering,sky", "layering,sky"},
          Case{"haze,sky", "sky", "haze,sky", ""}}) {
        const Result run = take("ab.png", {"--only", c.only, "--ab", c.ab});
        ASSERT_EQ(run.status, 0) << c.only << ": " << run.err;
        take("with.png", {"--only", c.with});
        take("without.png", {"--only", c.without});
        const image::Image8 ab = picture("ab.png"), with = picture("with.png"),
                            without = picture("without.png");
        EXPECT_GT(image::compare(with, without).worst, 8) << c.only;
        int off = 0;
        for (int y = 0; y < ab.height; ++y)
            for (int x = 0; x < ab.width; ++x)
                for (int i = 0; i < 3; ++i)
                    off += x < 47 ? ab.at(x, y, i) != with.at(x, y, i)
                                  : x >= 49 && ab.at(x, y, i) != without.at(x, y, i);
        EXPECT_EQ(off, 0) << c.only << " without " << c.ab;
    }
}

TEST_F(Toggles, ExaggerationMovesNoRockAndNoSnow) {
    SKIP_WITHOUT_PLUGIN("layering");
    // The heavier of the materials as a colour, from above through a long lens.
    const std::filesystem::path folder = dir_ / "plugins/kinds";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "plugin.json")
        << R"({"format": 1, "id": "kinds", "name": "Kinds", "version": "1.0.0",
               "requires": ["materials"], "after": ["materials"]})";
    std::ofstream(folder / "kinds.glsl")
        << "void kinds_on_display(in Surface s, inout vec4 overlay) {\n"
           "    overlay = vec4(float(s.material.x) / 4.0, 0.0, 0.0, 1.0);\n"
           "}\n";
    std::vector<image::Image8> pictures;
    for (const char* exaggeration : {"1", "3"}) {
        take("kinds.png", {"--only", "layering,kinds", "--plugin-path", (dir_ / "plugins").string(),
                           "--view", "el=90,zoom=1.2", "--fov", "1", "--exaggerate", exaggeration,
                           "--set", "layering.limits=metres", "--set",
                           "layering.rock_snow_m=700,760", "--set", "layering.slope_deg=12,25"});
        pictures.push_back(picture("kinds.png"));
    }
    std::array<double, 4> count{};
    double moved = 0, all = 0;
    for (int y = 8; y < pictures[0].height - 8; ++y) {
        for (int x = 8; x < pictures[0].width - 8; ++x, ++all) {
            ++count[static_cast<std::size_t>(std::lround(pictures[0].at(x, y, 0) / 63.75))];
            moved += pictures[0].at(x, y, 0) != pictures[1].at(x, y, 0);
        }
    }
    fmt::print("[ exaggeration ] grass {:.0f} %, rock {:.0f} %, snow {:.0f} %; {:.1f} % differ\n",
               100 * count[1] / all, 100 * count[2] / all, 100 * count[3] / all, 100 * moved / all);
    EXPECT_GT(count[1] / all, 0.1);
    EXPECT_GT(count[2] / all, 0.05);
    EXPECT_LT(moved / all, 0.05);
}

double mean(const image::Image8& picture) {
    double sum = 0;
    for (const std::uint8_t value : picture.values)
        sum += value;
    return sum / static_cast<double>(picture.values.size());
}

/// Standard deviation over the lower half, which is ground.
double detail(const image::Image8& picture) {
    double sum = 0, squares = 0, n = 0;
    for (int y = picture.height / 2; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x, ++n) {
            sum += picture.at(x, y, 1);
            squares += picture.at(x, y, 1) * picture.at(x, y, 1);
        }
    }
    return std::sqrt(squares / n - sum / n * (sum / n));
}

TEST_F(Toggles, ExposureHoldsFromNoonOnSnowToCivilTwilightToNight) {
    SKIP_WITHOUT_PLUGIN("cover");
    SKIP_WITHOUT_PLUGIN("sky");
    const auto shown = [&](const char* time, std::vector<std::string> more) {
        more.insert(more.begin(), {"-q", "capture", bundled_dem(), "-o", (dir_ / "a.png").string(),
                                   "--size", "160x120", "--overwrite", "--view",
                                   "az=200,el=35,zoom=3", "--land-cover", "none", "--time", time});
        EXPECT_EQ(relevo(more).status, 0);
        return picture("a.png");
    };
    // Snow everywhere, at noon of the longest day: bright, not white, and its slopes are seen.
    const image::Image8 snow =
        shown("2026-06-21T13:38-04:00", {"--set", "cover.snow=line", "--set",
                                         "cover.snow_line_m=-1000", "--set", "cover.trees=none"});
    fmt::print("[ exposure ] snow at noon: mean {:.0f}, deviation {:.1f}\n", mean(snow),
               detail(snow));
    EXPECT_GT(mean(snow), 180);
    EXPECT_LT(mean(snow), 248);
    EXPECT_GT(detail(snow), 1.5);  // of the slopes alone: snow has no patches
    // The end of civil twilight, the sun 6 degrees below the horizon: 21:25.
    const image::Image8 dusk = shown("2026-06-21T21:25-04:00", {});
    fmt::print("[ exposure ] ground at civil dusk: mean {:.0f}, deviation {:.1f}\n", mean(dusk),
               detail(dusk));
    EXPECT_GT(mean(dusk), 17);
    EXPECT_GT(detail(dusk), 1.5);  // of the slopes alone: forest has no patches from afar
    // Night without a moon: dark, and not black.
    const image::Image8 night = shown("2026-06-22T01:00-04:00", {});
    fmt::print("[ exposure ] ground at night: mean {:.0f}\n", mean(night));
    EXPECT_GT(mean(night), 5);
    EXPECT_LT(mean(night), mean(dusk));
}

}  // namespace
}  // namespace relevo::test::test_toggles
