#include "support/gpu_snippet.h"

#include <optional>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/text.h"
#include "gl/buffer.h"
#include "gl/framebuffer.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "render/programs.h"
#include "shader/snippet.h"
#include "support/support.h"

namespace relevo::test {
namespace {

/// Core's files, and the test's own fragment main.
class TextsWithTest : public shader::CoreTexts {
  public:
    TextsWithTest(std::filesystem::path folder, std::string main)
        : core_(std::move(folder)), main_(std::move(main)) {}

    std::optional<std::string> text(std::string_view name) const override {
        return name == "test.frag.glsl" ? main_ : core_.text(name);
    }
    std::string file(std::string_view name) const override { return core_.file(name); }

  private:
    shader::FolderTexts core_;
    std::string main_;
};

shader::Snippet read_snippet(const std::string& plugin) {
    const std::filesystem::path file =
        source_dir() / "plugins" / plugin / fmt::format("{}.glsl", plugin);
    return shader::parse_snippet(plugin, file.string(), read_text(file, "test"));
}

}  // namespace

GpuSnippet::GpuSnippet(const std::string& plugin, const std::string& include)
    : plugin_(plugin), include_(include) {
    if (!plugin.empty()) values_.declare(read_snippet(plugin).source.params);
}

std::vector<glm::vec4> GpuSnippet::run(const std::string& body, int columns, int rows) {
    std::optional<shader::Snippet> snippet;
    if (!plugin_.empty()) snippet = read_snippet(plugin_);
    const TextsWithTest texts(source_dir() / "shaders",
                              (include_.empty() ? "" : fmt::format("//@ include {}\n", include_)) +
                                  "layout(location = 0) out vec4 result;\n"
                                  "void main() {\n"
                                  "    int x = int(gl_FragCoord.x), y = int(gl_FragCoord.y);\n" +
                                  body + "\n}\n");
    shader::StitchInput input;
    if (snippet) input.snippets = {&*snippet};
    input.values = &values_;
    const shader::Stitched stitched = shader::stitch(
        texts, {.vertex_main = "fullscreen.vert.glsl", .fragment_main = "test.frag.glsl"}, input);
    const gl::Program program = render::link_program(render::ProgramText::of("test", stitched));

    const gl::Texture target(gl::TextureKind::D2, gl::Format::RGBA32F, {columns, rows, 1}, 1,
                             "results");
    const gl::Framebuffer framebuffer({&target}, nullptr, "results");
    const gl::Buffer frame(std::as_bytes(std::span(&frame_, 1)), "frame block");
    frame.bind_uniform(0);
    const std::vector<std::byte> bytes = shader::pack(stitched.params, values_);
    std::optional<gl::Buffer> params;
    if (!bytes.empty()) params.emplace(bytes, "parameters").bind_uniform(1);
    for (const shader::TextureUnit& unit : stitched.textures)
        if (const auto bound = textures_.find(unit.name); bound != textures_.end())
            bound->second->bind(static_cast<unsigned>(unit.unit));
    const gl::VertexArray no_inputs;
    no_inputs.bind();
    framebuffer.bind();
    program.use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    std::vector<glm::vec4> results(static_cast<std::size_t>(columns * rows));
    target.read(0, std::as_writable_bytes(std::span(results)));
    context_.check_errors();
    return results;
}

}  // namespace relevo::test
