#include <epoxy/gl.h>
#include <glm/vec4.hpp>
#include <gtest/gtest.h>

#include "gl/context.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/vertex_array.h"
#include "render/effect_textures.h"
#include "support/device.h"

namespace relevo::render::test_effect_textures {
namespace {

/// The red of a texture a quarter of its side beyond its right edge.
float red_beyond_the_edge(const gl::Texture& texture) {
    gl::Program::Failure failure;
    const auto program = gl::Program::build(
        "#version 450 core\n"
        "void main() {\n"
        "    gl_Position = vec4(4.0 * (gl_VertexID & 1) - 1.0, 2.0 * (gl_VertexID & 2) - 1.0, 0.0, "
        "1.0);\n"
        "}\n",
        "#version 450 core\n"
        "layout(binding = 0) uniform sampler2D sides;\n"
        "layout(location = 0) out vec4 result;\n"
        "void main() { result = textureLod(sides, vec2(1.25, 0.5), 0.0); }\n",
        "sampled", failure);
    EXPECT_TRUE(program) << failure.log;
    const gl::Texture target(gl::TextureKind::D2, gl::Format::RGBA32F, {1, 1, 1}, 1, "result");
    const gl::Framebuffer framebuffer({&target}, nullptr, "result");
    const gl::VertexArray no_inputs;
    no_inputs.bind();
    framebuffer.bind();
    program->use();
    texture.bind(0);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glm::vec4 result{-1};
    target.read(0, std::as_writable_bytes(std::span(&result, 1)));
    return result.r;
}

TEST(EffectTextures, RepeatOrEndAsTheManifestSays) {
    // Black on the left, white on the right: beyond the right edge a repeated texture is black
    // again, one that ends stays white.
    const gl::Context context({.device = test::gl_device(), .debug = true});
    const auto beyond = [](effect::TextureSpec::Wrap wrap) {
        effect::LoadedTexture texture;
        texture.spec.resource = "probe.sides";
        texture.spec.wrap = wrap;
        texture.spec.mipmaps = false;
        image::TextureData texels(PixelFormat::R8, 4, 4, 1, 1, 1);
        for (std::size_t i = 0; i < 16; ++i)
            texels.writable_level(0)[i] = std::byte(i % 4 < 2 ? 0 : 255);
        texture.layers.push_back(std::move(texels));
        EffectTextureCache cache;
        const EffectTextures textures({&texture}, 1, cache);
        return red_beyond_the_edge(*textures.find("probe.sides"));
    };
    EXPECT_EQ(beyond(effect::TextureSpec::Wrap::Repeat), 0);
    EXPECT_EQ(beyond(effect::TextureSpec::Wrap::Clamp), 1);
}

}  // namespace
}  // namespace relevo::render::test_effect_textures
