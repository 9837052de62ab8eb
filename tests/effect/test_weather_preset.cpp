#include "effect/plugins.h"
#include "effect/weather_preset.h"

// What plugins take from the weather, and parameters that must rise.
namespace relevo::effect::test_weather_preset {
namespace {

using relevo::test::error_of;
using test::Plugins;

constexpr const char* kGlsl =
    "uniform float puddles_share = 0.5; //@ range(0, 1)\n"
    "uniform float puddles_low = 1.0; //@ range(0, 100)\n"
    "uniform float puddles_high = 2.0; //@ range(0, 100)\n"
    "uniform int puddles_kind = 0; //@ enum(small, large)\n"
    "void puddles_on_albedo(inout Surface s) {\n"
    "    s.diffuse *= puddles_share + puddles_low + puddles_high + float(puddles_kind);\n"
    "}\n";

class WeatherPreset : public ::testing::Test {
  protected:
    Registry load(const std::string& members) {
        plugins_.add("puddles", "\"enabled_by_default\": false, " + members, kGlsl);
        return plugins_.load();
    }
    std::string error(const std::string& members) {
        const Registry registry = load(members);
        return registry.broken().empty() ? "no error"
                                         : plugins_.relative(registry.broken().front().error);
    }
    Plugins plugins_;
};

TEST_F(WeatherPreset, SwitchesEffectsOnAndSetsTheirParameters) {
    const Registry registry =
        load(R"("weather": {"on": ["rainy"], "set": {"share": "rain", "kind": "deck_1_kind"}})");
    const Preset preset = weather_preset(
        registry, {.words = {"rainy", "cloudy"}, .figures = {{"rain", 0.8}, {"deck_1_kind", 1}}});
    EXPECT_EQ(preset.switches.enable, std::vector<std::string>{"puddles"});
    ASSERT_EQ(preset.settings.size(), 2U);
    shader::ParamStore store;
    store.declare(registry.params());
    const Selection selection = select(registry, {preset}, {});
    EXPECT_TRUE(selection.has("puddles"));
    apply_settings(store, registry, selection, {preset}, {});
    EXPECT_EQ(store.value("puddles.share")[0], 0.8);
    EXPECT_EQ(store.value("puddles.kind")[0], 1);
    // The command line has the last word, in both.
    apply_settings(store, registry, selection, {preset}, {{"puddles.share", "0.1"}});
    EXPECT_EQ(store.value("puddles.share")[0], 0.1);
    EXPECT_FALSE(select(registry, {preset}, {.disable = {"puddles"}}).has("puddles"));
    // Dry weather leaves it off, and what a report lacks as it was.
    EXPECT_TRUE(weather_preset(registry, {.words = {"cloudy"}}).switches.enable.empty());
    EXPECT_TRUE(weather_preset(registry, {}).settings.empty());
}

TEST_F(WeatherPreset, FiguresBeyondARangeAreItsEnd) {
    const Registry registry = load(R"("weather": {"set": {"low": "wind_m_s"}})");
    const Preset preset = weather_preset(registry, {.figures = {{"wind_m_s", 120}}});
    ASSERT_EQ(preset.settings.size(), 1U);
    EXPECT_EQ(preset.settings[0].text, "100");
}

TEST_F(WeatherPreset, WrongWordsAreErrorsOfThePlugin) {
    EXPECT_EQ(error(R"("weather": {"on": ["sunny"]})"),
              "plugin: plugins/puddles/plugin.json:1: weather.on: expected words of cloudy, foggy, "
              "rainy, snowy, thundery but got \"sunny\"");
    EXPECT_NE(error(R"("weather": {"set": {"share": "luck"}})").find("expected one of wind_m_s"),
              std::string::npos);
    EXPECT_EQ(
        error(R"("weather": {"set": {"depth": "rain"}})"),
        "plugin: plugins/puddles/plugin.json:1: weather.set: expected a parameter of type float "
        "or int, not host, but got \"puddles.depth\", which is none of the plugin's");
}

TEST_F(WeatherPreset, ParametersThatMustRiseAreChecked) {
    const Registry registry = load(R"("rising": [["low", "high"]])");
    shader::ParamStore store;
    store.declare(registry.params());
    const Selection on = select(registry, {}, {.enable = {"puddles"}});
    apply_settings(store, registry, on, {}, {});
    EXPECT_EQ(error_of([&] {
                  apply_settings(store, registry, on, {}, {{"puddles.low", "50"}});
              }),
              "exit 3: effects: puddles.high: expected more than puddles.low, 50, but got 2");
    // Of an effect that is off they are not.
    apply_settings(store, registry, select(registry, {}, {}), {}, {{"puddles.low", "50"}});
    EXPECT_NE(error(R"("rising": ["low"])").find("expected a list of lists"), std::string::npos);
}

}  // namespace
}  // namespace relevo::effect::test_weather_preset
