#include "support/gpu_snippet.h"

#include <optional>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/paths.h"
#include "base/text.h"
#include "effect/manifest.h"
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

/// Whether a plugin's folder has more than one file of GLSL, which its manifest then orders.
bool effect_has_several(const std::filesystem::path& folder) {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        files += entry.path().extension() == ".glsl" ? 1 : 0;
    return files > 1;
}

/// The plugin's GLSL: one file, or those that its manifest names.
std::vector<shader::Snippet> read_snippets(const std::string& plugin) {
    const std::filesystem::path folder = source_dir() / "plugins" / plugin;
    std::vector<std::filesystem::path> files{folder / fmt::format("{}.glsl", plugin)};
    std::vector<shader::Snippet> snippets;
    if (effect_has_several(folder)) {
        const effect::Manifest manifest = effect::load_manifest(folder, share_dir() / "data");
        files = manifest.glsl;
        for (const effect::FieldSpec& field : manifest.fields)
            snippets.push_back(
                shader::parse_snippet(plugin, "fields", effect::field_glsl(field, plugin)));
    }
    for (const std::filesystem::path& file : files)
        snippets.push_back(shader::parse_snippet(plugin, file.string(), read_text(file, "test")));
    return snippets;
}

}  // namespace

GpuSnippet::GpuSnippet(const std::string& plugin, const std::string& include)
    : plugin_(plugin), include_(include) {
    if (plugin.empty()) return;
    std::vector<shader::Param> params;
    for (const shader::Snippet& snippet : read_snippets(plugin))
        params.insert(params.end(), snippet.source.params.begin(), snippet.source.params.end());
    values_.declare(params);
}

std::vector<glm::vec4> GpuSnippet::run(const std::string& body, int columns, int rows) {
    std::vector<shader::Snippet> snippets;
    if (!plugin_.empty()) snippets = read_snippets(plugin_);
    const TextsWithTest texts(source_dir() / "shaders",
                              (include_.empty() ? "" : fmt::format("//@ include {}\n", include_)) +
                                  "layout(location = 0) out vec4 result;\n"
                                  "void main() {\n"
                                  "    int x = int(gl_FragCoord.x), y = int(gl_FragCoord.y);\n" +
                                  body + "\n}\n");
    shader::StitchInput input;
    for (const shader::Snippet& snippet : snippets)
        input.snippets.push_back(&snippet);
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
