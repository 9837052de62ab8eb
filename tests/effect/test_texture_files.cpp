// What a plugin brings as a texture is checked before a device sees it.
#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "effect/loaded_selection.h"
#include "effect/plugins.h"
#include "image/image.h"

namespace relevo::effect::test::test_texture_files {
namespace {

using image::TextureData;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A plugin `haze` with one texture `noise`.
class Textured : public Plugins {
  public:
    explicit Textured(const std::string& texture, const std::string& sampler = "sampler2D",
                      const std::string& members = "") {
        std::filesystem::create_directories(own());
        members_ = R"("textures": {"noise": {)" + texture + "}}" + members;
        sampler_ = sampler;
    }
    std::filesystem::path own() const { return plugins() / "haze"; }
    void ktx(const std::string& name, const TextureData& data) const {
        image::write_ktx(own() / name, data);
    }
    Registry load_all() const {
        add("haze", members_,
            "uniform " + sampler_ + " haze_noise;\nvoid haze_on_albedo(inout Surface s) {}\n");
        Registry registry = load();
        EXPECT_THAT(registry.broken(), IsEmpty()) << registry.broken()[0].error;
        return registry;
    }
    std::string error() const {
        const Registry registry = load_all();
        return relative(relevo::test::error_of(
            [&] { load_texture(registry.effect("haze", "test").manifest.textures[0]); }));
    }

  private:
    std::string members_, sampler_;
};

const char* const kArray =
    R"("kind": "2d-array", "files": ["a.ktx2", "b.ktx2"], "encoding": "linear")";

TEST(TextureFiles, AnArraysLayersAreAlike) {
    const Textured plugins(kArray, "sampler2DArray");
    plugins.ktx("a.ktx2", TextureData(PixelFormat::RGBA8, 8, 8, 1, 1, 4));
    const auto error_with = [&](const TextureData& second) {
        plugins.ktx("b.ktx2", second);
        return plugins.error();
    };
    const std::string head =
        "exit 3: plugin: plugins/haze/b.ktx2: expected 8 x 8 texels of 4 "
        "bytes in 4 levels as in plugins/haze/a.ktx2 but got ";
    EXPECT_EQ(error_with(TextureData(PixelFormat::RGBA8, 8, 8, 1, 1, 4)), "no error");
    EXPECT_EQ(error_with(TextureData(PixelFormat::RGBA8, 8, 8, 1, 1, 2)),
              head + "8 x 8 texels of 4 bytes in 2 levels");
    EXPECT_EQ(error_with(TextureData(PixelFormat::RGBA8, 8, 4, 1, 1, 4)),
              head + "8 x 4 texels of 4 bytes in 4 levels");
    EXPECT_EQ(error_with(TextureData(PixelFormat::R8, 8, 8, 1, 1, 4)),
              head + "8 x 8 texels of 1 bytes in 4 levels");
}

TEST(TextureFiles, WithoutMipmapsLevelsNeedNotBeAlike) {
    const Textured plugins(std::string(kArray) + R"(, "mipmaps": false)", "sampler2DArray");
    plugins.ktx("a.ktx2", TextureData(PixelFormat::R8, 8, 8, 1, 1, 4));
    plugins.ktx("b.ktx2", TextureData(PixelFormat::R8, 8, 8, 1, 1, 1));
    EXPECT_EQ(plugins.error(), "no error");
}

TEST(TextureFiles, AreOfTheKindThatTheManifestSays) {
    const std::string flat = R"("kind": "2d", "file": "a.ktx2", "encoding": "linear")";
    const std::string volume = R"("kind": "3d", "file": "a.ktx2", "encoding": "linear")";
    const auto error_of = [](const std::string& texture, const char* sampler, TextureData data) {
        const Textured plugins(texture, sampler);
        plugins.ktx("a.ktx2", data);
        return plugins.error();
    };
    const std::string head = "exit 3: plugin: plugins/haze/a.ktx2: expected ";
    EXPECT_EQ(error_of(flat, "sampler2D", TextureData(PixelFormat::R8, 8, 4, 2, 1, 1)),
              head + "a file of kind 2d for textures.noise but got 3d, 8 x 4 x 2 texels");
    EXPECT_EQ(error_of(flat, "sampler2D", TextureData(PixelFormat::R8, 8, 4, 1, 3, 1)),
              head +
                  "a file of kind 2d for textures.noise but got 2d-array, 8 x 4 texels, 3 "
                  "layers");
    EXPECT_EQ(error_of(volume, "sampler3D", TextureData(PixelFormat::R8, 8, 4, 1, 3, 1)),
              head +
                  "a file of kind 3d for textures.noise but got 2d-array, 8 x 4 texels, 3 "
                  "layers");
    EXPECT_EQ(error_of(volume, "sampler3D", TextureData(PixelFormat::R8, 8, 4, 2, 1, 1)),
              "no error");
    EXPECT_EQ(error_of(volume + R"(, "slices": 4)", "sampler3D",
                       TextureData(PixelFormat::R8, 8, 4, 2, 1, 1)),
              head + "4 slices, as the manifest says, but got 2");
    EXPECT_EQ(error_of(flat, "sampler2D", TextureData(PixelFormat::Srgb8A8, 8, 4, 1, 1, 1)),
              head + "texels of encoding linear for textures.noise but got srgb");
}

TEST(TextureFiles, APicturesRowsRunUpAndItsSlicesLieBelowEachOther) {
    const Textured plugins(R"("kind": "3d", "file": "a.png", "slices": 2, "encoding": "srgb")",
                           "sampler3D");
    image::Image8 picture(1, 4, 3);
    for (int y = 0; y < 4; ++y)
        picture.row(y)[0] = static_cast<std::uint8_t>(10 * y);
    image::write(plugins.own() / "a.png", picture);
    const Registry registry = plugins.load_all();
    const LoadedTexture texture =
        load_texture(registry.effect("haze", "test").manifest.textures[0]);
    const TextureData& data = texture.layers.at(0);
    EXPECT_EQ(data.format(), PixelFormat::Srgb8A8);
    ASSERT_EQ(data.depth(), 2);
    const auto red = [&](std::size_t texel) {
        return std::to_integer<int>(data.level(0)[4 * texel]);
    };
    EXPECT_THAT((std::array{red(0), red(1), red(2), red(3)}), ElementsAre(10, 0, 30, 20));
    EXPECT_EQ(std::to_integer<int>(data.level(0)[3]), 255);
    EXPECT_FALSE(texture.has_mipmaps());
}

TEST(TextureFiles, SlicesDivideThePicture) {
    const Textured plugins(R"("kind": "3d", "file": "a.png", "slices": 3, "encoding": "linear")",
                           "sampler3D");
    image::write(plugins.own() / "a.png", image::Image8(2, 4, 1));
    EXPECT_EQ(plugins.error(), "exit 3: plugin: plugins/haze/a.png: 4 rows do not make 3 slices");
}

TEST(TextureFiles, ABrokenOneLeavesItsEffectOutAndWhatRequiresIt) {
    const Textured plugins(R"("kind": "2d", "file": "a.png", "encoding": "srgb")", "sampler2D",
                           R"(, "provides": ["air"])");
    plugins.write("plugins/haze/a.png", "no picture");
    plugins.add("glow", R"("requires": ["air"])");
    plugins.add("plain");
    const Registry registry = plugins.load_all();
    const LoadedSelection chosen = select_and_load(registry, {}, {}, {});
    EXPECT_THAT(ids(chosen.selection), ElementsAre("plain"));
    EXPECT_THAT(chosen.textures, IsEmpty());
    ASSERT_EQ(chosen.selection.warnings.size(), 2u);
    EXPECT_EQ(
        plugins.relative(chosen.selection.warnings[0]),
        "haze is off: image: plugins/haze/a.png: Not a PNG file; --disable haze silences this");
    EXPECT_EQ(chosen.selection.warnings[1],
              "glow is off: it requires air, haze is off; --disable glow silences this");
    EXPECT_EQ(plugins.relative(relevo::test::error_of(
                  [&] { select_and_load(registry, {}, {.enable = {"haze"}}, {}); })),
              "exit 3: effects: haze: it cannot be switched on: image: "
              "plugins/haze/a.png: Not a PNG file; take it out of --enable");
}

TEST(TextureFiles, LargerThanTheDeviceTakesLeavesTheEffectOut) {
    const Textured plugins(R"("kind": "2d", "file": "a.png", "encoding": "linear")");
    image::write(plugins.own() / "a.png", image::Image8(40, 3, 1));
    plugins.add("plain");
    const Registry registry = plugins.load_all();
    LoadedSelection chosen = select_and_load(registry, {}, {}, {});
    ASSERT_EQ(chosen.textures.size(), 1u);
    chosen = select_and_load(registry, {}, {}, {}, TextureLimits{40, 1, 1}, std::move(chosen));
    EXPECT_THAT(ids(chosen.selection), ElementsAre("haze", "plain"));
    EXPECT_EQ(chosen.textures.size(), 1u);
    chosen = select_and_load(registry, {}, {}, {}, TextureLimits{39, 99, 99}, std::move(chosen));
    EXPECT_THAT(ids(chosen.selection), ElementsAre("plain"));
    ASSERT_EQ(chosen.selection.warnings.size(), 1u);
    EXPECT_EQ(plugins.relative(chosen.selection.warnings[0]),
              "haze is off: plugin: plugins/haze/a.png: expected at most 39 texels a side, as this "
              "device takes, but got 2d, 40 x 3 texels; --disable haze silences this");
}

TEST(TextureFiles, VolumesAndLayersHaveLimitsOfTheirOwn) {
    const TextureSpec flat{
        .name = "n", .resource = "h.n", .kind = TextureSpec::Kind::D3, .files = {"v.ktx2"}};
    LoadedTexture volume{flat, {}};
    volume.layers.emplace_back(PixelFormat::R8, 4, 4, 9, 1, 1);
    EXPECT_EQ(relevo::test::error_of([&] {
                  check_limits(volume, {99, 8, 99});
              }),
              "exit 3: plugin: v.ktx2: expected at most 8 texels a side, as this device "
              "takes, but got 3d, 4 x 4 x 9 texels");
    LoadedTexture array{flat, {}};
    array.spec.kind = TextureSpec::Kind::D2Array;
    for (int i = 0; i < 3; ++i)
        array.layers.emplace_back(PixelFormat::R8, 4, 4, 1, 1, 1);
    EXPECT_EQ(relevo::test::error_of([&] {
                  check_limits(array, {99, 99, 2});
              }),
              "exit 3: plugin: v.ktx2: expected at most 2 layers, as this device takes, but "
              "got 3");
    EXPECT_EQ(relevo::test::error_of([&] { check_limits(array, {4, 1, 3}); }), "no error");
}

}  // namespace
}  // namespace relevo::effect::test::test_texture_files
