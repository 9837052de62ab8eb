#include <algorithm>
#include <cctype>
#include <random>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/paths.h"
#include "base/text.h"
#include "effect/manifest.h"
#include "effect/plugins.h"
#include "effect/registry.h"
#include "shader/source.h"

namespace relevo::effect::test::test_manifest {
namespace {

using relevo::test::error_of;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr const char* kHead = R"("format": 1, "id": "haze", "name": "Haze", "version": "1.0")";
const std::string kHook = "void haze_on_albedo(inout Surface s) {}\n";

TEST(Manifest, NamesTheValuesThatAWindowShowsFirst) {
    const Plugins plugins;
    const char* const kGlsl =
        "uniform float haze_blue = 1.0; //@ range(0, 2)\nuniform float haze_air = 1.0; //@ "
        "range(0, 2)\n";
    plugins.add("haze", R"("first": ["blue"])", std::string(kGlsl) + kHook);
    const Effect effect = load_effect(plugins.plugins() / "haze", plugins.data());
    EXPECT_THAT(effect.manifest.first, ElementsAre("haze.blue"));
    plugins.add("haze", R"("first": ["blau"])", std::string(kGlsl) + kHook);
    EXPECT_THAT(error_of([&] { load_effect(plugins.plugins() / "haze", plugins.data()); }),
                testing::HasSubstr("first: expected parameters and texts of the plugin, not host, "
                                   "but got \"blau\""));
}

TEST(Manifest, OfEachEffectThatIsInstalledHasAGroup) {
    const Registry registry =
        Registry::load({relevo::test::source_dir() / "plugins"}, share_dir() / "data");
    EXPECT_GT(registry.effects().size(), 25U);
    for (const Effect& effect : registry.effects())
        EXPECT_FALSE(effect.manifest.group.empty()) << effect.id();
}

TEST(Manifest, IsReadWhole) {
    const Plugins plugins;
    plugins.write("data/noise/perlin.png", "");
    plugins.write("plugins/haze/day.png", "");
    plugins.write("plugins/haze/air.glsl", "float haze_air() { return 1.0; }\n");
    plugins.add("haze", R"(
        "description": "Air that shows.",
        "group": "air",
        "enabled_by_default": false,
        "provides": ["air"], "requires": ["sky"], "wants": ["shadow_map"], "after": ["relief"],
        "glsl": ["air.glsl", "haze.glsl"],
        "textures": {
            "day": {"kind": "2d", "file": "day.png", "encoding": "srgb", "wrap": "clamp",
                    "mipmaps": false},
            "layers": {"kind": "2d-array", "files": ["day.png", "data:noise/perlin.png"],
                       "encoding": "linear"},
            "noise": {"kind": "3d", "file": "data:noise/perlin.png", "slices": 32,
                      "encoding": "linear"}})",
                "uniform sampler2D haze_day;\nuniform sampler2DArray haze_layers;\n"
                "uniform sampler3D haze_noise;\n" +
                    kHook);
    const Effect effect = load_effect(plugins.plugins() / "haze", plugins.data());
    const Manifest& manifest = effect.manifest;
    EXPECT_EQ(manifest.id, "haze");
    EXPECT_EQ(manifest.description, "Air that shows.");
    EXPECT_EQ(manifest.group, "air");
    EXPECT_FALSE(manifest.enabled_by_default);
    EXPECT_THAT(manifest.provides, ElementsAre("air"));
    EXPECT_THAT(manifest.needs, ElementsAre("sky"));
    EXPECT_THAT(manifest.wants, ElementsAre("shadow_map"));
    EXPECT_THAT(manifest.after, ElementsAre("relief"));
    ASSERT_EQ(manifest.glsl.size(), 2u);
    EXPECT_EQ(manifest.glsl[0].filename(), "air.glsl");
    EXPECT_EQ(effect.snippets.size(), 2u);

    ASSERT_EQ(manifest.textures.size(), 3u);
    const TextureSpec& day = manifest.textures[0];
    EXPECT_EQ(day.resource, "haze.day");
    EXPECT_EQ(day.kind, TextureSpec::Kind::D2);
    EXPECT_TRUE(day.srgb);
    EXPECT_EQ(day.wrap, TextureSpec::Wrap::Clamp);
    EXPECT_FALSE(day.mipmaps);
    EXPECT_THAT(day.files, ElementsAre(plugins.plugins() / "haze" / "day.png"));
    EXPECT_THAT(manifest.textures[1].files, ElementsAre(plugins.plugins() / "haze" / "day.png",
                                                        plugins.data() / "noise" / "perlin.png"));
    EXPECT_EQ(manifest.textures[2].slices, 32);
    EXPECT_TRUE(manifest.textures[2].mipmaps);
}

TEST(Manifest, HasTextsForItsModule) {
    const Plugins plugins;
    plugins.write("plugins/haze/walk.gpx", "");
    plugins.add("haze", R"("module": "haze", "texts": {
        "track": {"kind": "file", "label": "Track", "default": "walk.gpx"},
        "title": {"description": "Above it"}})");
    const std::vector<shader::TextParam> texts =
        load_effect(plugins.plugins() / "haze", plugins.data()).manifest.texts;
    ASSERT_EQ(texts.size(), 2u);
    EXPECT_EQ(texts[0].address, "haze.track");
    EXPECT_TRUE(texts[0].is_file);
    EXPECT_EQ(texts[0].label, "Track");
    EXPECT_EQ(texts[0].initial, (plugins.plugins() / "haze/walk.gpx").string());
    EXPECT_FALSE(texts[1].is_file);
    EXPECT_EQ(texts[1].label, "title");
    EXPECT_EQ(texts[1].description, "Above it");
    EXPECT_EQ(texts[1].initial, "");
}

TEST(Manifest, SaysHowFarItMovesTheGround) {
    const Plugins plugins;
    plugins.add(
        "haze", R"("displaces": {"down_m": 2.5, "up_m": "haze.tall_m", "to_m": -30})",
        "uniform float haze_tall_m = 9.0; //@ range(0, 50)\n"
        "void haze_on_displace(in VertexFrame v, inout vec3 p) { p += haze_tall_m * v.up; }\n");
    const auto displaces =
        load_effect(plugins.plugins() / "haze", plugins.data()).manifest.displaces;
    ASSERT_TRUE(displaces);
    EXPECT_EQ(displaces->down.metres, 2.5);
    EXPECT_EQ(displaces->up.address, "haze.tall_m");
    EXPECT_EQ(displaces->aside.metres, 0);
    ASSERT_TRUE(displaces->to);
    EXPECT_EQ(displaces->to->metres, -30);
    EXPECT_EQ(displaces->line, 1);
}

TEST(Manifest, SaysWhatItInvents) {
    const Plugins plugins;
    const auto add = [&](const char* by) {
        plugins.add("haze",
                    fmt::format(R"("invents": {{"what": "it is greyer", "by": "{}", )"
                                R"("pixel_posts": 0.05, "post_m": 2}})",
                                by),
                    "uniform float haze_grey = 1.0; //@ range(0, 2)\n"
                    "uniform int haze_kind = 0; //@ range(0, 2)\n"
                    "void haze_on_albedo(inout Surface s) { s.diffuse *= haze_grey; }\n");
        return load_effect(plugins.plugins() / "haze", plugins.data()).manifest.invents;
    };
    const auto invents = add("grey");
    ASSERT_TRUE(invents);
    EXPECT_EQ(invents->what, "it is greyer");
    EXPECT_EQ(invents->address, "haze.grey");
    EXPECT_EQ(invents->pixel_posts, 0.05);
    EXPECT_EQ(invents->post_m, 2);
    EXPECT_EQ(plugins.relative(error_of([&] { add("kind"); })),
              "exit 3: plugin: plugins/haze/plugin.json:1: invents: expected a parameter of "
              "type float, not host, but got \"haze.kind\", which is of type int");
    EXPECT_EQ(plugins.relative(error_of([&] { add("green"); })),
              "exit 3: plugin: plugins/haze/plugin.json:1: invents: expected a parameter of "
              "type float, not host, but got \"haze.green\", which is none of the plugin's");
}

TEST(Manifest, NeedsLittle) {
    const Plugins plugins;
    plugins.add("haze");
    const Manifest manifest = load_manifest(plugins.plugins() / "haze", plugins.data());
    EXPECT_TRUE(manifest.enabled_by_default);
    EXPECT_THAT(manifest.textures, IsEmpty());
    ASSERT_EQ(manifest.glsl.size(), 1u);
    EXPECT_EQ(manifest.glsl[0].filename(), "haze.glsl");
}

TEST(Manifest, ANativePluginNeedsNoGlsl) {
    const Plugins plugins;
    plugins.write("plugins/haze/plugin.json", std::string("{") + kHead + R"(, "module": "haze"})");
    const Effect effect = load_effect(plugins.plugins() / "haze", plugins.data());
    EXPECT_EQ(effect.manifest.module, "haze");
    EXPECT_THAT(effect.snippets, IsEmpty());
}

struct Bad {
    const char* name;
    std::string json;
    const char* message;  ///< behind "exit 3: plugin: plugins/haze/plugin.json:"
};

class ManifestError : public testing::TestWithParam<Bad> {};

TEST_P(ManifestError, NamesFileAndLine) {
    const Plugins plugins;
    plugins.write("plugins/haze/haze.glsl", kHook);
    plugins.write("plugins/haze/a.png", "");
    plugins.write("plugins/haze/plugin.json", GetParam().json);
    EXPECT_EQ(plugins.relative(
                  error_of([&] { load_effect(plugins.plugins() / "haze", plugins.data()); })),
              std::string("exit 3: plugin: plugins/haze/plugin.json:") + GetParam().message);
}

/// The head, and in the second line what is wrong.
std::string with(const std::string& members) {
    return std::string("{") + kHead + ",\n" + members + "}";
}
std::string texture(const std::string& members) {
    return with(R"("textures": {"noise": {)" + members + "}}");
}
std::string text(const std::string& members) {
    return with(R"("module": "haze", "texts": {"track": {)" + members + "}}");
}

constexpr const char* kKeys =
    "format, id, name, description, version, group, first, enabled_by_default, default_where, "
    "provides, "
    "exclusive, requires, "
    "wants, after, module, glsl, textures, passes, instances, "
    "marks, texts, displaces, invents, rising, weather, $schema";
const std::string kUnknown = std::string("2: licence: no such key; there are ") + kKeys;

INSTANTIATE_TEST_SUITE_P(
    All, ManifestError,
    testing::Values(
        Bad{"Syntax", "{\n\"format\" 1}",
            "2: syntax error while parsing object separator - unexpected number literal; expected "
            "':'"},
        Bad{"NoObject", "\n[]", "2: expected an object but got a list"},
        Bad{"NoFormat", R"({"id": "haze"})", "1: expected a member \"format\""},
        Bad{"NewerFormat", "{\n\"format\": 2}",
            "2: format: expected 1, the format that this program reads, but got 2"},
        Bad{"NoId", R"({"format": 1})", "1: expected a member \"id\""},
        Bad{"BadId", "{\"format\": 1,\n\"id\": \"Haze\"}",
            "2: id: expected a letter a-z and then letters and digits but got \"Haze\""},
        Bad{"Underscore", "{\"format\": 1,\n\"id\": \"my_haze\"}",
            "2: id: expected a letter a-z and then letters and digits but got \"my_haze\""},
        Bad{"Reserved", "{\"format\": 1,\n\"id\": \"core\"}",
            "2: id: core is a word of core's; choose another"},
        Bad{"NoName", R"({"format": 1, "id": "haze"})", "1: expected a member \"name\""},
        Bad{"NumberForText", "{\"format\": 1, \"id\": \"haze\",\n\"name\": 7}",
            "2: name: expected a text but got 7"},
        Bad{"NoVersion", R"({"format": 1, "id": "haze", "name": "Haze"})",
            "1: expected a member \"version\""},
        Bad{"Misspelt", with(R"("provide": ["air"])"),
            "2: provide: no such key; did you mean \"provides\"?"},
        Bad{"UnknownKey", with(R"("licence": "MIT")"), kUnknown.c_str()},
        Bad{"NoList", with(R"("provides": "air")"),
            "2: provides: expected a list of texts but got \"air\""},
        Bad{"NumberInAList", with(R"("provides": [7])"),
            "2: provides: expected a list of texts but got 7 in it"},
        Bad{"ExclusiveOfAnothers", with(R"("provides": ["air"], "exclusive": ["fog"])"),
            "2: exclusive: expected words of \"provides\" but got \"fog\""},
        Bad{"CoresWord", with(R"("provides": ["night"])"),
            "2: provides: \"night\" is core's own word; expected another"},
        Bad{"BadWord", with(R"("wants": ["Shadow map"])"),
            "2: wants: expected words of a-z, 0-9 and _ but got \"Shadow map\""},
        Bad{"WordTwice", with(R"("after": ["a", "a"])"), "2: after: \"a\" is listed twice"},
        Bad{"NoGroup", with(R"("group": "fire")"),
            "2: group: expected one of ground, light, air, water, maps but got \"fire\""},
        Bad{"NoBool", with(R"("enabled_by_default": "yes")"),
            "2: enabled_by_default: expected true or false but got \"yes\""},
        Bad{"ModulePath", with(R"("module": "../haze.so")"),
            "2: module: expected the bare name of a library but got \"../haze.so\""},
        Bad{"NoGlsl", with(R"("glsl": ["fog.glsl"])"),
            "2: glsl: plugins/haze/fog.glsl: no such file"},
        Bad{"GlslOutside", with(R"("glsl": ["../fog.glsl"])"),
            "2: glsl: expected a file of the plugin's own folder but got ../fog.glsl"},
        Bad{"TableFile", with(R"("textures": {"curve": {"kind": "table"}})"),
            "2: textures.curve: expected a \"file\" of the plugin, or a text \"from\""},
        Bad{"RasterText", with(R"("textures": {"photo": {"kind": "raster", "from": "file"}})"),
            "2: textures.photo: expected a text of kind \"file\"; add \"texts\": {\"file\": "
            "{\"kind\": \"file\"}}"},
        Bad{"RasterValues",
            with(
                R"("textures": {"photo": {"kind": "raster", "from": "file", "holds": "values", "colours": "ramp"}})"),
            "2: textures.photo.colours: expected it of a raster that holds colours only"},
        Bad{"FieldText", with(R"("textures": {"rain": {"kind": "field", "from": "file"}})"),
            "2: textures.rain: expected a text of kind \"file\"; add \"texts\": {\"file\": "
            "{\"kind\": \"file\"}}"},
        Bad{"FieldWeather",
            with(R"("textures": {"rain": {"kind": "field", "from": "file", "weather": "rain"}})"),
            "2: textures.rain.weather: expected one of deck_1_cover, deck_2_cover, deck_3_cover "
            "but got \"rain\""},
        Bad{"Textures", with(R"("textures": [])"),
            "2: textures: expected an object of name and texture but got a list"},
        Bad{"TextureName", with(R"("textures": {"No": {}})"),
            "2: textures: expected words of a-z, 0-9 and _ but got \"No\""},
        Bad{"Texture", with(R"("textures": {"noise": "a.png"})"),
            "2: textures.noise: expected an object but got \"a.png\""},
        Bad{"NoKind", texture(R"("file": "a.png")"),
            "2: textures.noise: expected a member \"kind\""},
        Bad{"BadKind", texture(R"("kind": "2darray")"),
            "2: textures.noise.kind: expected one of 2d, 2d-array, 3d, table, cube, raster, "
            "lines, field "
            "but got \"2darray\"; "
            "did you "
            "mean 2d-array?"},
        Bad{"NoFile", texture(R"("kind": "2d", "file": "b.png", "encoding": "srgb")"),
            "2: textures.noise.file: plugins/haze/b.png: no such file"},
        Bad{"NoDataFile", texture(R"("kind": "3d", "file": "data:b.png", "encoding": "linear")"),
            "2: textures.noise.file: data/b.png: no such file"},
        Bad{"DataOutside",
            texture(R"("kind": "2d", "file": "data:../a.png", "encoding": "linear")"),
            "2: textures.noise.file: expected a file of the plugin's own folder but got ../a.png"},
        Bad{"Absolute", texture(R"("kind": "2d", "file": "/a.png", "encoding": "linear")"),
            "2: textures.noise.file: expected a file of the plugin's own folder but got /a.png"},
        Bad{"NoLayers", texture(R"("kind": "2d-array", "files": [], "encoding": "srgb")"),
            "2: textures.noise.files: expected a list of files, one a layer"},
        Bad{"NoEncoding", texture(R"("kind": "2d", "file": "a.png")"),
            "2: textures.noise: expected a member \"encoding\""},
        Bad{"Slices", texture(R"("kind": "3d", "file": "a.png", "slices": 1.5)"),
            "2: textures.noise.slices: expected a whole number in [1, 2048] but got 1.5"},
        Bad{"SlicesOfAPicture",
            texture(R"("kind": "2d", "file": "a.png", "encoding": "srgb", "slices": 2)"),
            "2: textures.noise.slices: no such key; there are kind, file, encoding, wrap, mipmaps"},
        Bad{"Unread", texture(R"("kind": "2d", "file": "a.png", "encoding": "srgb")"),
            "2: textures.noise: nothing reads it; expected uniform sampler2D haze_noise; in the "
            "plugin's GLSL"},
        Bad{"Texts", with(R"("texts": [])"),
            "2: texts: expected an object of name and text but got a list"},
        Bad{"TextName", with(R"("module": "haze", "texts": {"No": {}})"),
            "2: texts: expected words of a-z, 0-9 and _ but got \"No\""},
        Bad{"TextsOfNobody", with(R"("texts": {"track": {}})"),
            "2: texts: expected a \"module\", \"marks\", or data of \"textures\", that reads "
            "them"},
        Bad{"LinesOfNoText", texture(R"("kind": "lines", "from": "file")"),
            "2: textures.noise: expected a text of kind \"file\"; add \"texts\": {\"file\": "
            "{\"kind\": \"file\"}}"},
        Bad{"LinesWithoutFrom", texture(R"("kind": "lines")"),
            "2: textures.noise: expected a member \"from\""},
        Bad{"LinesKey", texture(R"("kind": "lines", "from": "file", "file": "a.gpx")"),
            "2: textures.noise.file: no such key; there are kind, from, attribute"},
        Bad{"TextKind", text(R"("kind": "path")"),
            "2: texts.track.kind: expected one of text, file but got \"path\""},
        Bad{"TextFile", text(R"("kind": "file", "default": "../a.gpx")"),
            "2: texts.track.default: expected a file of the plugin's own folder but got ../a.gpx"},
        Bad{"DefaultWhere", with(R"("default_where": ["snow"])"),
            "2: default_where: expected words of water, marked_holes, covered_voids but got "
            "\"snow\""},
        Bad{"Displaces", with(R"("displaces": 5)"), "2: displaces: expected an object but got 5"},
        Bad{"DisplacesKey", with(R"("displaces": {"by_m": 5})"),
            "2: displaces.by_m: no such key; there are down_m, up_m, aside_m, to_m"},
        Bad{"DisplacesDown", with(R"("displaces": {"down_m": -5})"),
            "2: displaces.down_m: expected metres from 0 to 100000, or a parameter such as "
            "\"haze.height_m\", but got -5"},
        Bad{"DisplacesFar", with(R"("displaces": {"up_m": 1e6})"),
            "2: displaces.up_m: expected metres from 0 to 100000, or a parameter such as "
            "\"haze.height_m\", but got 1000000"},
        Bad{"DisplacesTo", with(R"("displaces": {"to_m": "sea.level_m"})"),
            "2: displaces.to_m: expected metres from -100000 to 100000, or a parameter such as "
            "\"haze.height_m\", but got \"sea.level_m\""},
        Bad{"DisplacesToTruth", with(R"("displaces": {"to_m": true})"),
            "2: displaces.to_m: expected metres from -100000 to 100000, or a parameter such as "
            "\"haze.height_m\", but got true"},
        Bad{"DisplacesNothing", with(R"("displaces": {"up_m": 5})"),
            "2: displaces: no hook moves the ground; define haze_on_displace, or remove this"},
        Bad{"DisplacesByNone", with(R"("displaces": {"up_m": "haze.tall_m"})"),
            "2: displaces: expected a parameter of type float, not host, but got \"haze.tall_m\", "
            "which is none of the plugin's"}),
    [](const auto& test) { return test.param.name; });

// Whatever stands in a file, it is read or refused, never crashed upon. Run with the sanitizers.
TEST(Manifest, AMangledFileIsReadOrRefused) {
    const Plugins plugins;
    plugins.add("haze");
    plugins.write("plugins/haze/a.png", "");
    const std::string text = texture(R"("kind": "3d", "file": "a.png", "encoding": "srgb")");
    constexpr std::string_view kPieces[] = {"{",     "}",    "[", "]",       "\"", ":",    ",",
                                            "1e999", "null", "-", "\\u0000", "\n", "true", "\xFF"};
    std::mt19937 random(20260621);
    const auto below = [&](std::size_t n) { return random() % n; };
    int refused = 0;
    for (int round = 0; round < 400; ++round) {
        std::string mangled = text;
        for (std::size_t edits = 1 + below(3); edits > 0 && !mangled.empty(); --edits) {
            const std::size_t at = below(mangled.size());
            if (below(2) == 0)
                mangled.erase(at, 1 + below(8));
            else
                mangled.insert(at, kPieces[below(std::size(kPieces))]);
        }
        plugins.write("plugins/haze/plugin.json", mangled);
        try {
            load_manifest(plugins.plugins() / "haze", plugins.data());
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 200);
}

TEST(Manifest, FilesThatAreLinksOutOfTheFolderAreRefused) {
    const Plugins plugins;
    plugins.write("secret.glsl", kHook);
    plugins.write("data/shared.png", "");
    std::filesystem::create_directories(plugins.plugins() / "haze");
    std::filesystem::create_symlink(plugins.folder() / "secret.glsl",
                                    plugins.plugins() / "haze/link.glsl");
    plugins.write("plugins/haze/plugin.json",
                  std::string("{") + kHead + ",\n\"glsl\": [\"link.glsl\"]}");
    EXPECT_EQ(plugins.relative(
                  error_of([&] { load_manifest(plugins.plugins() / "haze", plugins.data()); })),
              "exit 3: plugin: plugins/haze/plugin.json:2: glsl: expected a file of the "
              "plugin's own folder but got link.glsl");
    // A folder that is a link itself is where its plugin is.
    plugins.add("bump");
    std::filesystem::create_directory_symlink(plugins.plugins() / "bump",
                                              plugins.folder() / "elsewhere");
    EXPECT_EQ(load_manifest(plugins.folder() / "elsewhere", plugins.data()).id, "bump");
}

TEST(Manifest, FilesThatAreNoneAreRefused) {
    const Plugins plugins;
    plugins.add("haze", R"("glsl": ["pipe.glsl"])");
    ASSERT_EQ(mkfifo((plugins.plugins() / "haze/pipe.glsl").c_str(), 0600), 0);
    EXPECT_EQ(plugins.relative(
                  error_of([&] { load_manifest(plugins.plugins() / "haze", plugins.data()); })),
              "exit 3: plugin: plugins/haze/plugin.json:1: glsl: plugins/haze/pipe.glsl: it "
              "is not a regular file");
    std::filesystem::remove(plugins.plugins() / "haze/plugin.json");
    ASSERT_EQ(mkfifo((plugins.plugins() / "haze/plugin.json").c_str(), 0600), 0);
    const Registry registry = plugins.load();
    ASSERT_EQ(registry.broken().size(), 1u);
    EXPECT_EQ(plugins.relative(registry.broken()[0].error),
              "plugin: plugins/haze/plugin.json: cannot be read, it is not a regular file");
}

TEST(Manifest, LongGlslIsRefused) {
    const Plugins plugins;
    plugins.add("haze", "", kHook + std::string(1 << 20, '\n'));
    EXPECT_EQ(plugins.relative(
                  error_of([&] { load_effect(plugins.plugins() / "haze", plugins.data()); })),
              "exit 3: plugin: plugins/haze/haze.glsl: expected at most 1024 KiB but got "
              "1025");
}

/// What the globals of core's own shaders begin with, "sun" of sun_light.
std::set<std::string> core_prefixes() {
    std::set<std::string> names, prefixes;
    const std::filesystem::path folder = relevo::test::source_dir() / "shaders";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string file = entry.path().filename().string();
        // Compute programs are whole: no plugin's text is stitched into them.
        if (entry.path().extension() != ".glsl" || file.ends_with(".comp.glsl")) continue;
        const auto kind = file.ends_with(".vert.glsl")   ? shader::SourceKind::VertexMain
                          : file.ends_with(".frag.glsl") ? shader::SourceKind::FragmentMain
                                                         : shader::SourceKind::Lib;
        const shader::Source source =
            shader::parse_source(kind, "core", file, read_text(entry.path(), "test"));
        for (const shader::Item& item : source.items)
            names.insert(item.names.begin(), item.names.end());
        for (const shader::Sampler& sampler : source.samplers)
            names.insert(sampler.name);
        for (const shader::Varying& varying : source.varyings)
            names.insert(varying.name);
    }
    for (const shader::Hook& hook : shader::hooks())
        names.insert(std::string(hook.name));
    for (const std::string& name : names) {
        const std::size_t end = name.find('_');
        const bool id = end != std::string::npos && end > 0 && name[0] >= 'a' && name[0] <= 'z' &&
                        std::all_of(name.begin(), name.begin() + static_cast<std::ptrdiff_t>(end),
                                    [](char c) { return std::islower(c) || std::isdigit(c); });
        if (id) prefixes.insert(name.substr(0, end));
    }
    return prefixes;
}

TEST(Manifest, NoIdIsWhatCoresNamesBeginWith) {
    std::set<std::string> words = core_prefixes();
    EXPECT_EQ(words.count("background"), 1u);
    // Passes and stages of a frame, and words of the command line.
    words.insert({"select", "footprint", "geometry", "terrain", "post", "copy", "edges",
                  "antialias", "all", "none"});
    const std::string guide =
        read_text(relevo::test::source_dir() / "docs/plugin-guide.md", "test");
    const std::size_t list = guide.find("`id` cannot be a word that core uses");
    ASSERT_NE(list, std::string::npos);
    std::string listed = guide.substr(list, guide.find("\n\n", list) - list);
    std::replace(listed.begin(), listed.end(), '\n', ' ');
    for (const std::string& word : words) {
        const Plugins plugins;
        plugins.add(word);
        EXPECT_EQ(plugins.relative(
                      error_of([&] { load_manifest(plugins.plugins() / word, plugins.data()); })),
                  fmt::format("exit 3: plugin: plugins/{0}/plugin.json:1: id: {0} is a word "
                              "of core's; choose another",
                              word));
        EXPECT_NE(listed.find(" " + word), std::string::npos) << word;
    }
}

}  // namespace
}  // namespace relevo::effect::test::test_manifest
