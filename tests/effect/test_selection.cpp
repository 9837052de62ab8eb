#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "effect/plugins.h"
#include "effect/selection.h"
#include "shader/stitch.h"

namespace relevo::effect::test::test_selection {
namespace {

using relevo::test::error_of;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Words = std::vector<std::string>;

Preset preset(Switches switches, std::vector<Setting> settings = {}) {
    return {"winter", "winter.json", "", std::move(switches), std::move(settings)};
}

// layering gives materials that bump and gloss need; wet is off by default and needs gloss' shine.
void add_ground(const Plugins& plugins) {
    plugins.add("layering", R"("provides": ["materials"])");
    plugins.add("bump", R"("requires": ["materials"], "after": ["materials"])");
    plugins.add("gloss",
                R"("provides": ["shine"], "requires": ["materials"], "after": ["materials"])");
    plugins.add("wet", R"("requires": ["shine"], "enabled_by_default": false)");
}

// ---- what only one provides

/// Two grounds, of which `meadow` is on by default.
void add_two_grounds(const Plugins& plugins) {
    plugins.add("meadow", R"("provides": ["materials"], "exclusive": ["materials"])");
    plugins.add("bands", R"("provides": ["materials"], "exclusive": ["materials"],
                            "enabled_by_default": false)");
    plugins.add("bump", R"("requires": ["materials"], "after": ["materials"])");
}

TEST(Selection, OneOfThoseThatProvideAWordAloneStays) {
    const Plugins plugins;
    add_two_grounds(plugins);
    const Registry registry = plugins.load();
    EXPECT_THAT(ids(select(registry, {}, {})), ElementsAre("meadow", "bump"));
    const Selection bands = select(registry, {}, {.enable = {"bands"}});
    EXPECT_THAT(ids(bands), ElementsAre("bands", "bump"));
    EXPECT_THAT(bands.notices,
                ElementsAre("meadow is off: bands provides materials in its place; --disable "
                            "bands brings it back"));
    // Whoever is asked for last.
    const Selection meadow =
        select(registry, {preset({.enable = {"bands"}})}, {.enable = {"meadow"}});
    EXPECT_THAT(ids(meadow), ElementsAre("meadow", "bump"));
    EXPECT_THAT(meadow.notices,
                ElementsAre("bands is off: meadow provides materials in its place; --disable "
                            "meadow brings it back"));
    EXPECT_THAT(ids(select(registry, {preset({.enable = {"bands"}})}, {.disable = {"bands"}})),
                ElementsAre("meadow", "bump"));
    EXPECT_THAT(ids(select(registry, {}, {.only = Words{"bump"}})), ElementsAre("meadow", "bump"));
}

TEST(Selection, WhatIsProvidedAloneHidesNothingElse) {
    // Paint adds to the materials that others give.
    const Plugins plugins;
    add_two_grounds(plugins);
    plugins.add("paint", R"("provides": ["materials"])");
    const Registry registry = plugins.load();
    const Selection selection = select(registry, {}, {});
    EXPECT_THAT(ids(selection), ElementsAre("meadow", "paint", "bump"));
    EXPECT_THAT(selection.notices, IsEmpty());
}

TEST(Selection, WhatWentOffDoesNotComeBackByAnotherWord) {
    const Plugins plugins;
    add_two_grounds(plugins);
    plugins.add("stripes", R"("provides": ["lines", "materials"], "exclusive": ["materials"],
                              "enabled_by_default": false)");
    plugins.add("legend", R"("requires": ["lines"], "enabled_by_default": false)");
    const Registry registry = plugins.load();
    const Selection selection =
        select(registry, {preset({.enable = {"stripes", "legend"}})}, {.enable = {"bands"}});
    EXPECT_THAT(ids(selection), ElementsAre("bands", "bump"));
}

// ---- what is on

TEST(Selection, DefaultsAreOn) {
    const Plugins plugins;
    add_ground(plugins);
    const Registry registry = plugins.load();
    const Selection selection = select(registry, {}, {});
    EXPECT_THAT(ids(selection), ElementsAre("layering", "bump", "gloss"));
    EXPECT_THAT(selection.capabilities, ElementsAre("materials", "shine"));
    EXPECT_THAT(selection.notices, IsEmpty());
    EXPECT_TRUE(selection.has("bump"));
    EXPECT_FALSE(selection.has("wet"));
    EXPECT_EQ(selection.snippets().size(), 3u);
}

TEST(Selection, WhatADemLacksIsOffByDefaultAndAskedForByNameANotice) {
    const Plugins plugins;
    add_ground(plugins);
    plugins.add("lake", R"("default_where": ["water"])");
    const Registry registry = plugins.load();
    const auto on = [&](const Switches& switches, const GroundWords& ground) {
        return select(registry, {}, switches, {}, ground);
    };
    // Not known yet; it has water; it has none.
    EXPECT_TRUE(on({}, {}).has("lake"));
    EXPECT_TRUE(on({}, Words{"water"}).has("lake"));
    const Selection dry = on({}, Words{});
    EXPECT_FALSE(dry.has("lake"));
    EXPECT_TRUE(dry.has("layering"));
    EXPECT_THAT(dry.notices, IsEmpty());
    EXPECT_THAT(dry.warnings, IsEmpty());
    const Selection asked = on({.enable = {"lake"}}, Words{"marked_holes"});
    EXPECT_TRUE(asked.has("lake"));
    EXPECT_THAT(asked.notices, ElementsAre("lake is on, but this DEM has no water"));
    EXPECT_THAT(on({.enable = {"lake"}}, Words{"water"}).notices, IsEmpty());
    EXPECT_FALSE(on({.disable = {"lake"}}, Words{"water"}).has("lake"));
}

TEST(Selection, NothingIsOnWithoutPlugins) {
    const Selection selection = select(Registry(), {}, {});
    EXPECT_THAT(selection.effects, IsEmpty());
    EXPECT_THAT(selection.capabilities, IsEmpty());
}

TEST(Selection, OnlyPullsRequirementsIn) {
    const Plugins plugins;
    add_ground(plugins);
    const Registry registry = plugins.load();
    const Selection selection = select(registry, {}, {.only = Words{"wet"}});
    EXPECT_THAT(ids(selection), ElementsAre("layering", "gloss", "wet"));
    EXPECT_THAT(selection.notices,
                ElementsAre("wet requires shine: gloss is switched on too",
                            "gloss requires materials: layering is switched on too"));
}

TEST(Selection, OnlyNothingIsNothing) {
    const Plugins plugins;
    add_ground(plugins);
    const Registry registry = plugins.load();
    EXPECT_THAT(select(registry, {}, {.only = Words{}}).effects, IsEmpty());
}

TEST(Selection, EnableAddsToTheDefaults) {
    const Plugins plugins;
    add_ground(plugins);
    const Registry registry = plugins.load();
    EXPECT_THAT(ids(select(registry, {}, {.enable = {"wet"}})),
                ElementsAre("layering", "bump", "gloss", "wet"));
    EXPECT_THAT(ids(select(registry, {}, {.only = Words{"layering"}, .enable = {"bump"}})),
                ElementsAre("layering", "bump"));
}

TEST(Selection, DisablingARequiredEffectTurnsItsDependantsOff) {
    const Plugins plugins;
    add_ground(plugins);
    const Registry registry = plugins.load();
    const Selection selection = select(registry, {}, {.disable = {"layering"}});
    EXPECT_THAT(selection.effects, IsEmpty());
    EXPECT_THAT(selection.notices,
                ElementsAre("bump is off: it requires materials, layering is disabled",
                            "gloss is off: it requires materials, layering is disabled"));
}

TEST(Selection, WhatIsDisabledIsNotPulledIn) {
    const Plugins plugins;
    add_ground(plugins);
    const Registry registry = plugins.load();
    const Selection selection =
        select(registry, {}, {.only = Words{"wet"}, .disable = {"layering"}});
    EXPECT_THAT(selection.effects, IsEmpty());
    EXPECT_THAT(selection.notices,
                ElementsAre("wet requires shine: gloss is switched on too",
                            "gloss is off: it requires materials, layering is disabled",
                            "wet is off: it requires shine, gloss is off"));
}

TEST(Selection, ARequirementThatNobodyMeetsTurnsAnEffectOff) {
    const Plugins plugins;
    plugins.add("bump", R"("requires": ["materials"])");
    plugins.add("glow", R"("requires": ["heat"])");
    plugins.add("lava", R"("provides": ["heat"], "enabled_by_default": false)");
    const Registry registry = plugins.load();
    const Selection selection = select(registry, {}, {});
    EXPECT_THAT(selection.effects, IsEmpty());
    EXPECT_THAT(selection.notices,
                ElementsAre("bump is off: it requires materials, which no plugin here provides",
                            "glow is off: it requires heat, lava is off, --enable lava changes "
                            "that"));
}

TEST(Selection, OfTwoProvidersTheOneThatIsOnByDefaultIsPulledIn) {
    const Plugins plugins;
    plugins.add("ash", R"("provides": ["materials"], "enabled_by_default": false)");
    plugins.add("layering", R"("provides": ["materials"])");
    plugins.add("bump", R"("requires": ["materials"])");
    const Registry registry = plugins.load();
    EXPECT_THAT(ids(select(registry, {}, {.only = Words{"bump"}})),
                ElementsAre("bump", "layering"));
    EXPECT_THAT(ids(select(registry, {}, {.only = Words{"bump"}, .disable = {"layering"}})),
                ElementsAre("ash", "bump"));
}

TEST(Selection, AnEffectMayMeetItsOwnRequirement) {
    const Plugins plugins;
    plugins.add("ash", R"("provides": ["materials"], "requires": ["materials"])");
    EXPECT_THAT(select(plugins.load(), {}, {}).notices, IsEmpty());
}

TEST(Selection, AllOffIsByteForByteCoreAlone) {
    const Plugins plugins;
    add_ground(plugins);
    const Registry registry = plugins.load();
    const auto text = [](const Selection& selection) {
        shader::StitchInput input;
        input.snippets = selection.snippets();
        input.capabilities = selection.capabilities;
        const shader::Stitched stitched = shader::stitch(
            shader::FolderTexts(relevo::test::source_dir() / "tests/shader/fixtures/shaders"),
            {.vertex_main = "terrain.vert.glsl", .fragment_main = "terrain.frag.glsl"}, input);
        return stitched.vertex.text + stitched.fragment.text;
    };
    const std::string off =
        text(select(registry, {}, {.disable = {"layering", "bump", "gloss", "wet"}}));
    EXPECT_EQ(off, text(select(Registry(), {}, {})));
    EXPECT_NE(off, text(select(registry, {}, {})));
}

// ---- presets

TEST(Selection, TheCommandLineHasTheLastWord) {
    const Plugins plugins;
    add_ground(plugins);
    const Registry registry = plugins.load();
    const Preset only_layering = preset({.only = Words{"layering"}, .disable = {"bump"}});
    EXPECT_THAT(ids(select(registry, {only_layering}, {})), ElementsAre("layering"));
    EXPECT_THAT(ids(select(registry, {only_layering}, {.enable = {"bump"}})),
                ElementsAre("layering", "bump"));
    EXPECT_THAT(ids(select(registry, {only_layering}, {.only = Words{"gloss"}})),
                ElementsAre("layering", "gloss"));
    EXPECT_THAT(ids(select(registry, {only_layering}, {.disable = {"layering"}})), IsEmpty());
}

TEST(Selection, OnlyForgetsWhatWasDisabledBefore) {
    const Plugins plugins;
    add_ground(plugins);
    const Registry registry = plugins.load();
    EXPECT_THAT(ids(select(registry, {preset({.disable = {"layering"}})}, {.only = Words{"bump"}})),
                ElementsAre("layering", "bump"));
}

TEST(Selection, WhatIsEnabledAgainIsNotCalledDisabled) {
    const Plugins plugins;
    add_ground(plugins);
    const Registry registry = plugins.load();
    EXPECT_THAT(select(registry, {preset({.disable = {"gloss", "bump"}})},
                       {.enable = {"gloss", "wet"}, .disable = {"layering"}})
                    .notices,
                ElementsAre("gloss is off: it requires materials, layering is disabled",
                            "wet is off: it requires shine, gloss is off"));
}

TEST(Selection, ALaterPresetChangesAnEarlierOne) {
    const Plugins plugins;
    add_ground(plugins);
    const Registry registry = plugins.load();
    EXPECT_THAT(
        ids(select(registry, {preset({.only = Words{"layering"}}), preset({.enable = {"bump"}})},
                   {})),
        ElementsAre("layering", "bump"));
}

TEST(Selection, WhatAPresetDisablesIsNotPulledIn) {
    const Plugins plugins;
    add_ground(plugins);
    const Registry registry = plugins.load();
    EXPECT_THAT(select(registry, {preset({.disable = {"layering"}})}, {.enable = {"bump"}}).notices,
                ElementsAre("bump is off: it requires materials, layering is disabled",
                            "gloss is off: it requires materials, layering is disabled"));
}

TEST(Selection, APresetMayNamePluginsThatAreGone) {
    const Plugins plugins;
    add_ground(plugins);
    const Registry registry = plugins.load();
    const Selection selection =
        select(registry, {preset({.only = Words{"layering", "snow"}, .disable = {"ice"}})}, {});
    EXPECT_THAT(ids(selection), ElementsAre("layering"));
    EXPECT_THAT(selection.notices,
                ElementsAre("winter.json: snow is skipped, there is no such plugin",
                            "winter.json: ice is skipped, there is no such plugin"));
}

// ---- order

TEST(Selection, TiesAreBrokenById) {
    const Plugins plugins;
    for (const char* id : {"c", "a", "b"})
        plugins.add(id);
    const Registry registry = plugins.load();
    EXPECT_THAT(ids(select(registry, {}, {})), ElementsAre("a", "b", "c"));
}

TEST(Selection, AfterAWordIsBehindAllItsProviders) {
    const Plugins plugins;
    plugins.add("a", R"("after": ["mood"])");
    plugins.add("b", R"("provides": ["mood"])");
    plugins.add("c");
    plugins.add("d", R"("provides": ["mood"], "after": ["mood", "nothing"])");
    const Registry registry = plugins.load();
    EXPECT_THAT(ids(select(registry, {}, {})), ElementsAre("b", "c", "d", "a"));
    EXPECT_THAT(ids(select(registry, {}, {.disable = {"b", "d"}})), ElementsAre("a", "c"));
}

// ---- words of which there may be one

// Both cast shadows; maps are off by default.
void add_shadows(const Plugins& plugins) {
    plugins.add("maps", R"("provides": ["shadow"], "exclusive": ["shadow"],
                           "enabled_by_default": false)");
    plugins.add("sweep", R"("provides": ["shadow"], "exclusive": ["shadow"])");
}

TEST(Selection, OfTwoProvidersOfAnExclusiveWordTheOneAskedForLastIsOn) {
    const Plugins plugins;
    add_shadows(plugins);
    const Registry registry = plugins.load();
    EXPECT_THAT(ids(select(registry, {}, {})), ElementsAre("sweep"));
    const std::string gives_way =
        "sweep is off: maps provides shadow in its place; --disable maps brings it back";
    const Selection asked = select(registry, {}, {.enable = {"maps"}});
    EXPECT_THAT(ids(asked), ElementsAre("maps"));
    EXPECT_THAT(asked.notices, ElementsAre(gives_way));
    const std::vector<Preset> paper{preset({.enable = {"maps"}})};
    EXPECT_THAT(select(registry, paper, {}).notices, ElementsAre(gives_way));
    EXPECT_THAT(ids(select(registry, paper, {.enable = {"sweep"}})), ElementsAre("sweep"));
    EXPECT_THAT(ids(select(registry, {}, {.enable = {"maps"}, .disable = {"sweep"}})),
                ElementsAre("maps"));
}

TEST(Selection, OfTwoDefaultsThatExcludeEachOtherTheFirstIsOn) {
    const Plugins plugins;
    plugins.add("b", R"("provides": ["shadow"], "exclusive": ["shadow"])");
    plugins.add("a", R"("provides": ["shadow"], "exclusive": ["shadow"])");
    const Registry registry = plugins.load();
    EXPECT_THAT(ids(select(registry, {}, {})), ElementsAre("a"));
}

TEST(Selection, OfTwoExclusiveProvidersTheLastOneAskedForIsOn) {
    const Plugins plugins;
    add_shadows(plugins);
    const Registry registry = plugins.load();
    EXPECT_THAT(ids(select(registry, {}, {.only = Words{"maps", "sweep"}})), ElementsAre("sweep"));
    EXPECT_THAT(ids(select(registry, {}, {.only = Words{"sweep", "maps"}})), ElementsAre("maps"));
    EXPECT_THAT(ids(select(registry, {}, {.only = Words{"maps"}, .enable = {"sweep"}})),
                ElementsAre("sweep"));
    const Selection both = select(registry, {}, {.enable = {"sweep", "maps"}});
    EXPECT_THAT(both.notices,
                testing::Contains("sweep is off: maps provides shadow in its place; --disable maps "
                                  "brings it back"));
}

// ---- the order that is asked for

TEST(Selection, AnOrderReplacesThatOfTheManifests) {
    const Plugins plugins;
    plugins.add("soil", R"("provides": ["soil"])");
    plugins.add("photo", R"("provides": ["photo"], "after": ["soil"])");
    plugins.add("names", R"("after": ["photo"])");
    plugins.add("track", "");
    const Registry registry = plugins.load();
    EXPECT_THAT(ids(select(registry, {}, {})), ElementsAre("soil", "photo", "names", "track"));
    EXPECT_EQ(select(registry, {}, {}).over_overlay, std::nullopt);
    // "after" of two effects in it does not count, that of others does.
    const Selection other = select(registry, {}, {.order = {"track", "names", "overlay", "photo"}});
    EXPECT_THAT(ids(other), ElementsAre("soil", "track", "names", "photo"));
    EXPECT_THAT(*other.over_overlay, ElementsAre("photo"));
    // Effects that are off do not matter.
    const Selection off = select(
        registry, {}, {.disable = {"names"}, .order = {"photo", "names", "track", "overlay"}});
    EXPECT_THAT(ids(off), ElementsAre("soil", "photo", "track"));
    EXPECT_THAT(*off.over_overlay, IsEmpty());
}

TEST(Selection, TheOverlayLiesBesideAnEffectOfTheOrder) {
    const Plugins plugins;
    plugins.add("contours", "");
    plugins.add("photo", "");
    plugins.add("shade", "");
    plugins.add("track", "");
    const Registry registry = plugins.load();
    const auto over = [&](Words order, Words disable = {}) {
        return select(registry, {}, {.disable = std::move(disable), .order = std::move(order)})
            .over_overlay;
    };
    // Named last, it is not over effects that the order does not name.
    EXPECT_EQ(over({"photo", "overlay"}), (Words{"shade", "track"}));
    EXPECT_EQ(over({"contours", "photo", "overlay"}), (Words{"shade", "track"}));
    EXPECT_EQ(over({"overlay", "photo"}), (Words{"photo", "shade", "track"}));
    EXPECT_EQ(over({"photo", "overlay", "track"}), (Words{"track"}));
    // Effects that are off do not matter.
    EXPECT_EQ(over({"photo", "overlay", "track"}, {"track"}), (Words{"shade"}));
    EXPECT_EQ(over({"photo", "overlay"}, {"photo"}), std::nullopt);
    EXPECT_EQ(over({"overlay"}), std::nullopt);
}

TEST(SelectionError, AnOrderHasKnownEffectsOnce) {
    const Plugins plugins;
    plugins.add("track", "");
    const Registry registry = plugins.load();
    const auto error = [&](Words order) {
        return plugins.relative(
            error_of([&] { select(registry, {}, {.order = std::move(order)}); }));
    };
    EXPECT_EQ(error({"track", "overlay", "track"}), "exit 3: effects: order: track is named twice");
    EXPECT_THAT(error({"trck"}), testing::HasSubstr("did you mean track?"));
}

// ---- what is refused

TEST(SelectionError, ACircleNamesItsSides) {
    const Plugins plugins;
    plugins.add("bump", R"("provides": ["relief"], "after": ["air"])");
    plugins.add("haze", R"("provides": ["air"], "after": ["relief"])");
    plugins.add("aaa", R"("after": ["air"])");
    const Registry registry = plugins.load();
    EXPECT_EQ(plugins.relative(error_of([&] { select(registry, {}, {}); })),
              "exit 3: effects: haze and bump: their order is circular: haze after bump "
              "(relief), bump after haze (air); change \"after\" in plugins/haze/plugin.json or "
              "plugins/bump/plugin.json");
    EXPECT_THAT(ids(select(registry, {}, {.disable = {"bump"}})), ElementsAre("haze", "aaa"));
}

TEST(SelectionError, TwoProvidersOfAnExclusiveHookAndTheMend) {
    const Plugins plugins;
    plugins.add("filmic", "", "void filmic_on_tonemap(inout vec3 c) {}");
    plugins.add("plain", "", "void plain_on_tonemap(inout vec3 c) {}");
    const Registry registry = plugins.load();
    EXPECT_EQ(error_of([&] { select(registry, {}, {}); }),
              "exit 3: effects: tonemap: expected one provider of this exclusive hook but "
              "got filmic and plain; add --disable filmic or --disable plain");
    EXPECT_THAT(ids(select(registry, {}, {.disable = {"plain"}})), ElementsAre("filmic"));
}

TEST(SelectionError, TwoProvidersOfAService) {
    const Plugins plugins;
    for (const char* id : {"dome", "sky"})
        plugins.add(id, "",
                    std::string("vec3 ") + id +
                        "_on_background_radiance(vec3 d, bool disc) { return vec3(1); }");
    const Registry registry = plugins.load();
    EXPECT_EQ(error_of([&] { select(registry, {}, {}); }),
              "exit 3: effects: background_radiance: expected one provider of this exclusive "
              "hook but got dome and sky; add --disable dome or --disable sky");
}

TEST(SelectionError, UnknownNamesOnTheCommandLine) {
    const Plugins plugins;
    add_ground(plugins);
    const Registry registry = plugins.load();
    constexpr const char* kMessage =
        "exit 3: effects: layerin: no such plugin; did you mean layering?";
    EXPECT_EQ(error_of([&] { select(registry, {}, {.only = Words{"layerin"}}); }), kMessage);
    EXPECT_EQ(error_of([&] { select(registry, {}, {.enable = {"layerin"}}); }), kMessage);
    EXPECT_EQ(error_of([&] { select(registry, {}, {.disable = {"layerin"}}); }), kMessage);
}

TEST(SelectionError, BothOnAndOff) {
    const Plugins plugins;
    add_ground(plugins);
    const Registry registry = plugins.load();
    constexpr const char* kMessage =
        "exit 3: effects: wet: expected it either on or off but got both";
    EXPECT_EQ(error_of([&] { select(registry, {}, {.enable = {"wet"}, .disable = {"wet"}}); }),
              kMessage);
    EXPECT_EQ(error_of([&] { select(registry, {}, {.only = Words{"wet"}, .disable = {"wet"}}); }),
              kMessage);
}

// ---- values

class Settings : public testing::Test {
  protected:
    Settings() {
        plugins_.add(
            "haze", "",
            "uniform float haze_density = 1.0; //@ range(0, 2) unit(1/km)\n"
            "uniform vec3 haze_tint = vec3(1); //@ colour\n"
            "void haze_on_albedo(inout Surface s) { s.diffuse *= haze_density * haze_tint; "
            "}");
        registry_ = plugins_.load();
        store_.declare(registry_.params());
        selection_ = select(registry_, {}, {});
    }

    std::vector<std::string> apply(const std::vector<Preset>& presets,
                                   const std::vector<Setting>& command_line) {
        return apply_settings(store_, registry_, selection_, presets, command_line);
    }

    Plugins plugins_;
    Registry registry_;
    shader::ParamStore store_;
    Selection selection_;
};

TEST_F(Settings, TheCommandLineComesLast) {
    EXPECT_THAT(apply({preset({}, {{"haze.density", "0.5", 3}, {"haze.tint", "0,0.5,1", 4}})},
                      {{"haze.density", "0.25"}}),
                IsEmpty());
    EXPECT_EQ(store_.value("haze.density")[0], 0.25);
    EXPECT_EQ(store_.value("haze.tint")[1], 0.5);
}

TEST_F(Settings, NeverSwitchAnEffectOn) {
    selection_ = select(registry_, {}, {.disable = {"haze"}});
    EXPECT_THAT(apply({}, {{"haze.density", "0.25"}}),
                ElementsAre("haze.density is set, but haze is off; --enable haze switches it on"));
    EXPECT_EQ(store_.value("haze.density")[0], 0.25);
    EXPECT_THAT(selection_.effects, IsEmpty());
}

TEST_F(Settings, OfAPluginThatIsGoneAreSkippedInAPreset) {
    EXPECT_THAT(apply({preset({}, {{"snow.line", "1800", 3}, {"haze.density", "0.5", 4}})}, {}),
                ElementsAre("winter.json:3: snow.line is skipped, there is no plugin snow"));
    EXPECT_EQ(store_.value("haze.density")[0], 0.5);
}

TEST_F(Settings, TextsAreSetAsTheyAreAndFilesCountFromTheirPreset) {
    plugins_.add("way", R"("module": "way", "texts": {"track": {"kind": "file"}, "title": {}})");
    registry_ = plugins_.load();
    store_.declare(registry_.params(), registry_.texts());
    selection_ = select(registry_, {}, {});
    const Preset winter = preset(
        {}, {{"way.track", "walk.gpx", 3, "presets"}, {"way.title", "walk.gpx", 4, "presets"}});
    EXPECT_THAT(apply({winter}, {}), IsEmpty());
    EXPECT_EQ(store_.text("way.track"), "presets/walk.gpx");
    EXPECT_EQ(store_.text("way.title"), "walk.gpx");
    EXPECT_THAT(apply({winter}, {{"way.track", "own.gpx"}}), IsEmpty());
    EXPECT_EQ(store_.text("way.track"), "own.gpx");
    // A scene that is written to another folder has them whole.
    const std::vector<Setting> whole = with_absolute_files(
        {{"way.track", "own.gpx"}, {"way.track", "walk.gpx", 3, "/maps"}, {"way.title", "own.gpx"}},
        store_);
    EXPECT_EQ(whole[0].text, (std::filesystem::current_path() / "own.gpx").string());
    EXPECT_EQ(whole[1].text, "/maps/walk.gpx");
    EXPECT_EQ(whole[1].folder, "");
    EXPECT_EQ(whole[2].text, "own.gpx");
    store_.reset("way.track");
    EXPECT_EQ(store_.text("way.track"), "");
    EXPECT_EQ(error_of([&] {
                  apply({}, {{"way.trak", "a"}});
              }),
              "exit 3: parameter: way.trak: no such parameter; did you mean way.track?");
    EXPECT_EQ(error_of([&] { store_.text("haze.density"); }),
              "exit 3: parameter: haze.density: a value, not a text");
}

TEST_F(Settings, ErrorsNameParameterAndPlace) {
    EXPECT_EQ(error_of([&] {
                  apply({preset({}, {{"haze.densty", "1", 3}})}, {});
              }),
              "exit 3: effects: winter.json:3: haze.densty: no such parameter; did "
              "you mean haze.density?");
    EXPECT_EQ(error_of([&] {
                  apply({preset({}, {{"haze.density", "7", 3}})}, {});
              }),
              "exit 3: effects: winter.json:3: haze.density: expected a number in "
              "[0, 2] 1/km but got \"7\"");
    EXPECT_EQ(error_of([&] {
                  apply({}, {{"snow.line", "1800"}});
              }),
              "exit 3: parameter: snow.line: no such parameter");
    EXPECT_EQ(error_of([&] {
                  apply({}, {{"haze.density", "much"}});
              }),
              "exit 3: parameter: haze.density: expected a number in [0, 2] 1/km but got "
              "\"much\"");
}

}  // namespace
}  // namespace relevo::effect::test::test_selection
