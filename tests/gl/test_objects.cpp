#include <algorithm>
#include <array>
#include <chrono>
#include <numeric>
#include <set>
#include <thread>
#include <type_traits>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "gl/buffer.h"
#include "gl/context.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/ring_buffer.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "support/support.h"

namespace relevo::gl {
namespace {

class GlObjects : public testing::Test {
  protected:
    void TearDown() override { context_.check_errors(); }
    Context context_{{.debug = true}};
};

TEST_F(GlObjects, AreMoveOnlyAndGoWithTheirOwner) {
    static_assert(!std::is_copy_constructible_v<Buffer>);
    static_assert(!std::is_copy_constructible_v<Texture>);
    unsigned name = 0;
    {
        Buffer first(16, "first");
        name = first.name();
        const Buffer second(std::move(first));
        EXPECT_EQ(first.name(), 0u);
        EXPECT_EQ(second.name(), name);
        EXPECT_TRUE(glIsBuffer(name));
    }
    EXPECT_FALSE(glIsBuffer(name));
}

TEST_F(GlObjects, BuffersKeepTheirBytes) {
    const std::array numbers{1.0f, 2.0f, 3.0f};
    const std::array five{5.0f};
    Buffer buffer(std::as_bytes(std::span(numbers)), "numbers");
    buffer.write(std::as_bytes(std::span(five)), sizeof(float));
    std::array<float, 3> back{};
    buffer.read(std::as_writable_bytes(std::span(back)));
    EXPECT_EQ(back, (std::array{1.0f, 5.0f, 3.0f}));
}

TEST_F(GlObjects, RingsKeepTheLastWritesAndReuseTheirMemory) {
    RingBuffer ring("ring");
    const std::size_t alignment = RingBuffer::uniform_alignment();
    std::vector<std::pair<RingBuffer::Place, std::vector<int>>> last;
    std::size_t bytes = 0, farthest = 0;
    std::set<unsigned> buffers;
    for (int i = 0; i < 9000; ++i) {
        // Of many sizes; one is larger than a part of the ring.
        const std::size_t count = i == 1000 ? 9000 : 1 + static_cast<std::size_t>(i % 137);
        std::vector<int> numbers(count, i);
        const RingBuffer::Place place =
            ring.write(std::as_bytes(std::span(numbers)), i % 2 == 0 ? alignment : sizeof(int));
        EXPECT_EQ(place.offset % (i % 2 == 0 ? alignment : sizeof(int)), 0U);
        if (!buffers.insert(place.buffer).second && last.size() >= 8) last.erase(last.begin());
        std::erase_if(last, [&](const auto& each) { return each.first.buffer != place.buffer; });
        last.emplace_back(place, std::move(numbers));
        bytes += place.size;
        farthest = std::max(farthest, place.offset);
        for (const auto& [at, written] : last) {
            std::vector<int> back(written.size());
            glGetNamedBufferSubData(at.buffer, static_cast<GLintptr>(at.offset),
                                    static_cast<GLsizeiptr>(at.size), back.data());
            ASSERT_EQ(back, written) << i;
        }
    }
    EXPECT_GT(buffers.size(), 1U);
    EXPECT_GT(bytes, std::size_t{2} << 20);
    EXPECT_LT(farthest, std::size_t{1200} << 10);  // it has gone round
}

TEST_F(GlObjects, FencesPassWhenTheDeviceHasFinished) {
    EXPECT_TRUE(Fence().has_passed());
    const Fence fence = Fence::insert();
    fence.wait_on_device();
    EXPECT_TRUE(fence.wait(std::chrono::seconds(10)));
    EXPECT_TRUE(fence.has_passed());
}

TEST_F(GlObjects, ContextsThatShareHaveEachOthersTextures) {
    Texture texture(TextureKind::D2, Format::RG32F, {1, 1, 1}, 1, "shared");
    const std::array<float, 2> texel{-12.5f, 4807.0f};
    texture.write(0, {0, 0, 0}, {1, 1, 1}, std::as_bytes(std::span(texel)));
    const Fence written = Fence::insert();
    std::thread([&] {
        const Context other = Context::sharing(context_);
        EXPECT_EQ(other.info().renderer, context_.info().renderer);
        EXPECT_TRUE(other.is_on_device_of(context_));
        written.wait_on_device();
        std::array<float, 2> back{};
        texture.read(0, std::as_writable_bytes(std::span(back)));
        EXPECT_EQ(back, texel);
    }).join();
}

TEST_F(GlObjects, TexturesKeepTheirTexels) {
    Texture texture(TextureKind::D2, Format::RG32F, {2, 1, 1}, 1, "heights");
    const std::array<float, 4> texels{-12.5f, 1.0f, 4807.0f, 0.0f};
    texture.write(0, {0, 0, 0}, {2, 1, 1}, std::as_bytes(std::span(texels)));
    std::array<float, 4> back{};
    texture.read(0, std::as_writable_bytes(std::span(back)));
    EXPECT_EQ(back, texels);
}

TEST_F(GlObjects, TexturesHaveNoMoreLevelsThanTheirSides) {
    EXPECT_EQ(Texture(TextureKind::D2, Format::R8, {8, 3, 1}, 4, "small").levels(), 4);
    EXPECT_EQ(test::error_of([] {
                  Texture(TextureKind::D2, Format::R8, {8, 3, 1}, 5, "small");
              }),
              "exit 1: texture: small: expected at most 4 levels of 8 x 3 x 1 texels but got 5");
}

TEST(Texture, LargerThanTheDevicesMemorySaysHowLarge) {
    const Context context{ContextOptions{}};
    const int layers = context.info().max_array_layers;
    const auto too_large = [&] {
        Texture(TextureKind::D2Array, Format::RGBA32F, {16384, 16384, layers}, 1, "sky");
    };
    EXPECT_EQ(test::error_of(too_large),
              fmt::format("exit 1: texture: sky: the device has no {} MiB for 16384 x 16384 x "
                          "{} texels; take a smaller picture or a device with more",
                          4096 * layers, layers));
}

TEST(Texture, LargerThanTheDeviceTakesIsAMessage) {
    const Context context{ContextOptions{}};
    const int side = context.info().max_texture_size;
    const auto refused = [](TextureKind kind, Extent extent, int levels) {
        return test::error_of([&] { Texture(kind, Format::R8, extent, levels, "sky"); });
    };
    EXPECT_EQ(refused(TextureKind::D2, {side + 1, 4, 1}, 1),
              fmt::format("exit 1: texture: sky: expected a texture of up to {0} x {0} texels "
                          "and a whole chain of levels but got {1} x 4 x 1 texels in 1 levels "
                          "(GL_INVALID_VALUE)",
                          side, side + 1));
    EXPECT_EQ(
        refused(TextureKind::D2Array, {4, 4, context.info().max_array_layers + 1}, 1),
        fmt::format("exit 1: texture: sky: expected a texture of up to {0} x {0} texels in "
                    "{1} layers and a whole chain of levels but got 4 x 4 x {2} texels in 1 "
                    "levels (GL_INVALID_VALUE)",
                    side, context.info().max_array_layers, context.info().max_array_layers + 1));
    // More levels than there are halvings.
    EXPECT_EQ(refused(TextureKind::D2, {8, 8, 1}, 99),
              "exit 1: texture: sky: expected at most 4 levels of 8 x 8 x 1 texels but got 99");
}

TEST(Texture, DoesNotTakeAnEarlierErrorForItsOwn) {
    const Context context{ContextOptions{}};
    glEnable(GL_TEXTURE_WRAP_S);
    EXPECT_EQ(test::error_of([] {
                  Texture(TextureKind::D2, Format::R8, {4, 4, 1}, 1, "sky");
              }),
              "exit 1: gl: before sky: GL_INVALID_ENUM");
    const Texture good(TextureKind::D2, Format::R8, {4, 4, 1}, 1, "sky");
}

TEST(Texture, IsReadInPiecesThatGlCanCount) {
    // Of 16 bytes a texel, 134 million texels are more than 31 bits count.
    for (const Extent extent : {Extent{16384, 16384, 1}, Extent{16384, 9000, 3}, Extent{1, 1, 1}}) {
        for (const std::size_t most : {std::size_t{1} << 28, std::size_t{1000}}) {
            const std::size_t row_bytes = std::size_t{16} * static_cast<unsigned>(extent.width);
            int layer = 0, row = 0;
            for (const TexelBand& band : bands_of(extent, row_bytes, most)) {
                if (row == extent.height) {
                    row = 0;
                    ++layer;
                }
                EXPECT_EQ(band.layer, layer);
                EXPECT_EQ(band.row, row);
                EXPECT_GT(band.rows, 0);
                EXPECT_LE(static_cast<std::size_t>(band.rows) * row_bytes,
                          std::max(most, row_bytes));
                row += band.rows;
            }
            EXPECT_EQ(layer, extent.depth - 1);
            EXPECT_EQ(row, extent.height);
        }
    }
}

TEST_F(GlObjects, EveryLevelAndLayerIsRead) {
    for (const TextureKind kind : {TextureKind::D2Array, TextureKind::D3}) {
        Texture texture(kind, Format::R32F, {6, 4, 4}, 2, "layers");
        const Extent half = texture.level_extent(1);
        EXPECT_EQ(half.width, 3);
        EXPECT_EQ(half.height, 2);
        EXPECT_EQ(half.depth, kind == TextureKind::D3 ? 2 : 4);
        std::vector<float> texels(static_cast<std::size_t>(half.width * half.height * half.depth));
        std::iota(texels.begin(), texels.end(), 1.0f);
        texture.write(1, {0, 0, 0}, half, std::as_bytes(std::span(texels)));
        std::vector<float> back(texels.size());
        texture.read(1, std::as_writable_bytes(std::span(back)));
        EXPECT_EQ(back, texels);
    }
}

TEST_F(GlObjects, MayHaveAnyName) {
    const Texture texture(TextureKind::D2, Format::R8, {1, 1, 1}, 1, std::string(5000, 'n'));
    const Buffer buffer(16, std::string(5000, 'n'));
}

TEST(Buffer, LargerThanTheDevicesMemorySaysHowLarge) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the sanitizer ends the program for such a request";
#endif
    const Context context{ContextOptions{}};
    const std::string message = test::error_of([] { Buffer(std::size_t{1} << 52, "everything"); });
    EXPECT_EQ(message,
              "exit 1: GL buffer: everything: the device has no 4294967296.0 MiB for it "
              "(GL_OUT_OF_MEMORY); take a device with more");
}

constexpr const char* kFullscreen =
    "#version 450 core\n"
    "void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : "
    "-1.0, "
    "0.0, 1.0); }\n";

TEST_F(GlObjects, ADrawReachesItsFramebuffer) {
    const Texture target(TextureKind::D2, Format::RGBA32F, {4, 4, 1}, 1, "target");
    const Framebuffer framebuffer({&target}, nullptr, "framebuffer");
    Program::Failure failure;
    const auto program =
        Program::build(kFullscreen,
                       "#version 450 core\n"
                       "layout(location = 0) out vec4 colour;\n"
                       "void main() { colour = vec4(gl_FragCoord.xy, 0.25, 1.0); }\n",
                       "corner", failure);
    ASSERT_TRUE(program) << failure.log;
    const VertexArray no_inputs;
    no_inputs.bind();
    framebuffer.bind();
    program->use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    std::array<float, 64> back{};
    target.read(0, std::as_writable_bytes(std::span(back)));
    EXPECT_EQ(back[0], 0.5f);  // the first texel is the lower left one
    EXPECT_EQ(back[1], 0.5f);
    EXPECT_EQ(back[2], 0.25f);
    EXPECT_EQ(back[60], 3.5f);
}

TEST_F(GlObjects, ABrokenProgramSaysWhichStageAndWhy) {
    Program::Failure failure;
    EXPECT_FALSE(Program::build(kFullscreen, "#version 450 core\nvoid main() { colour = 1; }\n",
                                "broken", failure));
    EXPECT_EQ(failure.stage, Program::Failure::Stage::Fragment);
    EXPECT_NE(failure.log.find("colour"), std::string::npos);
}

}  // namespace
}  // namespace relevo::gl
