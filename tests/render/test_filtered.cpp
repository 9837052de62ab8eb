// Filters that programs compute, against sums in double: shaders/lib/filtered.glsl.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <epoxy/gl.h>
#include <glm/vec4.hpp>
#include <gtest/gtest.h>

#include "base/text.h"
#include "gl/context.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::render::test_filtered {
namespace {

constexpr int kColumns = 64, kRows = 48;
constexpr gl::Extent kSides{5, 4, 3};

/// A texture of kSides with random values, and them.
struct Random {
    gl::Texture texture;
    std::vector<float> values;

    explicit Random(gl::TextureKind kind) : texture(kind, gl::Format::R32F, kSides, 1, "random") {
        std::mt19937 random(7);
        std::uniform_real_distribution<float> value(-1, 1);
        values.resize(static_cast<std::size_t>(kSides.width * kSides.height * kSides.depth));
        std::ranges::generate(values, [&] { return value(random); });
        texture.write(0, {0, 0, 0}, kSides, std::as_bytes(std::span(values)));
        texture.set_sampling(gl::Filter::Linear, gl::Wrap::Clamp);
    }

    double at(int x, int y, int z) const {
        const auto inside = [](int i, int count) { return std::clamp(i, 0, count - 1); };
        return values[static_cast<std::size_t>(
            (inside(z, kSides.depth) * kSides.height + inside(y, kSides.height)) * kSides.width +
            inside(x, kSides.width))];
    }

    /// @param x, y, z  in texels, whole numbers in their middles
    double filtered(double x, double y, double z) const {
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const auto part = [&](double place, int bit) {
                const double low = std::floor(place), weight = place - low;
                return std::pair(static_cast<int>(low) + (corner >> bit & 1),
                                 (corner >> bit & 1) != 0 ? weight : 1 - weight);
            };
            const auto [i, wx] = part(x, 0);
            const auto [j, wy] = part(y, 1);
            const auto [k, wz] = part(z, 2);
            sum += wx * wy * wz * at(i, j, k);
        }
        return sum;
    }
};

/// Filters at places a little beyond every side of a texture.
std::vector<float> filtered(const Random& from, const char* sampler, const char* place,
                            const char* define) {
    const std::string text = std::string("#version 450 core\n") + define +
                             read_text(test::source_dir() / "shaders/lib/filtered.glsl", "test") +
                             "layout(binding = 0) uniform " + sampler +
                             " from;\nlayout(location = 0) out vec4 result;\n"
                             "void main() { vec2 at = gl_FragCoord.xy / vec2(64.0, 48.0);\n"
                             "    result = filtered(from, " +
                             place + "); }\n";
    gl::Program::Failure failure;
    const auto program = gl::Program::build(
        "#version 450 core\nvoid main() {\n"
        "    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.5, "
        "1.0); }\n",
        text, "filtered", failure);
    if (!program) throw std::runtime_error(failure.log);
    const gl::Texture target(gl::TextureKind::D2, gl::Format::RGBA32F, {kColumns, kRows, 1}, 1,
                             "results");
    const gl::Framebuffer framebuffer({&target}, nullptr, "results");
    const gl::VertexArray no_inputs;
    no_inputs.bind();
    framebuffer.bind();
    program->use();
    from.texture.bind(0);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    std::vector<glm::vec4> results(kColumns * kRows);
    target.read(0, std::as_writable_bytes(std::span(results)));
    std::vector<float> first;
    for (const glm::vec4& result : results)
        first.push_back(result.x);
    return first;
}

/// The largest error of all pixels. @param reference  at a pixel's middle, 0 to 1
template <typename Reference>
double worst(const std::vector<float>& found, const Reference& reference) {
    double most = 0;
    for (int y = 0; y < kRows; ++y)
        for (int x = 0; x < kColumns; ++x)
            most = std::max(most, std::abs(found[static_cast<std::size_t>(y * kColumns + x)] -
                                           reference((x + 0.5) / kColumns, (y + 0.5) / kRows)));
    return most;
}

TEST(Filtered, HasExactWeightsOnEveryDevice) {
    const gl::Context context({.device = test::gl_device(), .debug = true});
    const Random volume(gl::TextureKind::D3), array(gl::TextureKind::D2Array);
    const auto in_volume = [&](double u, double v) {
        const double x = 1.2 * u - 0.1, y = 1.2 * v - 0.1, z = x * y;
        return volume.filtered(x * kSides.width - 0.5, y * kSides.height - 0.5,
                               z * kSides.depth - 0.5);
    };
    const auto in_array = [&](double u, double v) {
        return array.filtered((1.2 * u - 0.1) * kSides.width - 0.5,
                              (1.2 * v - 0.1) * kSides.height - 0.5, 2);
    };
    const char* const in_space = "vec3(1.2 * at - 0.1, (1.2 * at.x - 0.1) * (1.2 * at.y - 0.1))";
    const char* const in_layer = "vec3(1.2 * at - 0.1, 2.0)";
    for (const char* const define : {"", "#define EXACT_FILTERS\n"}) {
        if (*define && !context.info().device.software) continue;  // filters of GPUs have 8 bits
        EXPECT_LT(worst(filtered(volume, "sampler3D", in_space, define), in_volume), 2e-6);
        EXPECT_LT(worst(filtered(array, "sampler2DArray", in_layer, define), in_array), 2e-6);
    }
}

}  // namespace
}  // namespace relevo::render::test_filtered
