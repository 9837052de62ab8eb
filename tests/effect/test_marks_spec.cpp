// The entries of "marks" in plugin.json.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "effect/effect.h"
#include "effect/plugin_lint.h"
#include "effect/plugins.h"
#include "effect/registry.h"

namespace relevo::effect::test::test_marks_spec {
namespace {

const std::string kGlsl =
    "uniform float poi_size_px = 12.0; //@ range(4, 100)\n"
    "uniform float poi_wide = 12.0; //@ range(0, 4000)\n"
    "uniform int poi_symbol = 1; //@ enum(none, dot, triangle)\n"
    "uniform int poi_shape = 1; //@ enum(none, square)\n"
    "uniform vec3 poi_ink = vec3(0.5); //@ colour(srgb)\n"
    "uniform vec3 poi_light = vec3(0.5); //@ colour\n"
    "uniform float poi_now = 0.0; //@ host\n";

/// A plugin with one list of marks and no hook.
Effect poi(const std::string& marks, const std::string& texts = R"("file": {"kind": "file"})") {
    const Plugins plugins;
    plugins.write("plugins/poi/poi.glsl", kGlsl);
    plugins.write("plugins/poi/plugin.json",
                  R"({"format": 1, "id": "poi", "name": "P", "version": "1", "texts": {)" + texts +
                      "},\n\"marks\": {\"huts\": {" + marks + "}}}");
    return load_effect(plugins.plugins() / "poi", plugins.data());
}

TEST(MarksSpec, HasDefaultsConstantsAndParameters) {
    const Effect effect = poi(R"("from": "file", "size": 20, "colour": "#ff0080",)"
                              R"( "symbol": "triangle", "halo": "poi.ink")");
    ASSERT_EQ(effect.manifest.marks.size(), 1u);
    const MarksSpec& marks = effect.manifest.marks[0];
    shader::ParamStore values;
    values.declare(effect.params(), effect.manifest.texts);
    EXPECT_EQ(marks.from, "poi.file");
    EXPECT_EQ(marks.size_px.of(values)[0], 20);
    EXPECT_EQ(marks.colour.of(values), (shader::ParamValue{1, 0, 128 / 255.0, 0}));
    EXPECT_EQ(marks.halo.of(values)[0], 0.5);
    EXPECT_EQ(marks.symbol.of(values)[0], 2);
    EXPECT_EQ(marks.most.of(values)[0], 200);
    values.set("poi.ink", "#ffffff");
    EXPECT_EQ(marks.halo.of(values)[0], 1);
}

TEST(MarksSpec, MistakesAreNamed) {
    struct Bad {
        std::string marks, says;
    };
    const std::string kFile = R"("from": "file", )";
    for (const Bad& bad :
         {Bad{R"("size": 12)",
              ":2: marks.huts: expected a member \"from\" or \"known_summits\", or a \"module\" of "
              "the "
              "plugin "
              "that sets the marks"},
          Bad{kFile + R"("known_summits": true)",
              ":2: marks.huts: has both \"from\" and \"known_summits\"; make two lists"},
          Bad{R"("known_summits": "all")",
              ":2: marks.huts.known_summits: expected true or false but got \"all\""},
          Bad{R"("from": "list")",
              ":2: marks.huts.from: expected a text of kind file but got \"list\"; add \"texts\": "
              "{\"list\": {\"kind\": \"file\"}}"},
          Bad{kFile + R"("size": 900)",
              ":2: marks.huts.size: expected a number in [4, 200], or a parameter such as "
              "\"poi.size\", but got 900"},
          Bad{kFile + R"("symbol": "star")",
              ":2: marks.huts.symbol: expected one of none, dot, triangle, or a parameter such as "
              "\"poi.symbol\", but got \"star\""},
          Bad{kFile + R"("colour": "red")",
              ":2: marks.huts.colour: expected a colour such as \"#ff8800\", or a parameter such "
              "as "
              "\"poi.colour\", but got \"red\""},
          Bad{kFile + R"("size": "poi.none")",
              ":2: marks.huts.size: poi.none: the plugin has no such parameter"},
          Bad{kFile + R"("size": "poi.wide")",
              ":2: marks.huts.size: poi.wide: expected a range within [4, 200]"},
          Bad{kFile + R"("size": "poi.now")",
              ":2: marks.huts.size: poi.now: expected a float or an int that is not host"},
          Bad{kFile + R"("symbol": "poi.shape")",
              ":2: marks.huts.symbol: poi.shape: expected an int with enum(none, dot, triangle)"},
          Bad{kFile + R"("colour": "poi.light")",
              ":2: marks.huts.colour: poi.light: expected a vec3 with colour(srgb)"},
          Bad{kFile + R"("colour": "poi.size_px")",
              ":2: marks.huts.colour: poi.size_px: expected a vec3 with colour(srgb)"}}) {
        const std::string error = relevo::test::error_of([&] { poi(bad.marks); });
        EXPECT_THAT(error, testing::EndsWith("plugins/poi/plugin.json" + bad.says)) << bad.marks;
    }
    EXPECT_THAT(relevo::test::error_of([&] { poi(kFile + R"("size": 9)", R"("file": {})"); }),
                testing::HasSubstr("expected a text of kind file"));
}

}  // namespace
}  // namespace relevo::effect::test::test_marks_spec
