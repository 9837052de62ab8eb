#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/text.h"
#include "shader/stitch.h"
#include "support/support.h"

namespace relevo::shader::test {

inline std::filesystem::path shader_tests() {
    return relevo::test::source_dir() / "tests" / "shader";
}

/// The small core of tests/shader/fixtures/shaders.
inline FolderTexts fixture_core() {
    return FolderTexts(shader_tests() / "fixtures" / "shaders");
}

/// A plugin of tests/shader/fixtures/plugins.
inline Snippet fixture_snippet(const std::string& id) {
    const std::string file = id + ".glsl";
    return parse_snippet(
        id, file,
        read_text(shader_tests() / "fixtures" / "plugins" / id / file, "fixture_snippet"));
}

inline ProgramRecipe terrain_program() {
    return {.vertex_main = "terrain.vert.glsl", .fragment_main = "terrain.frag.glsl"};
}
inline ProgramRecipe geometry_program() {
    return {.vertex_main = "terrain.vert.glsl",
            .fragment_main = "geometry.frag.glsl",
            .shaded_by = "deferred.frag.glsl"};
}
inline ProgramRecipe shading_program() {
    return {.vertex_main = "fullscreen.vert.glsl",
            .fragment_main = "deferred.frag.glsl",
            .geometry_of = "terrain.vert.glsl"};
}
inline ProgramRecipe depth_program() {
    return {.vertex_main = "terrain.vert.glsl",
            .fragment_main = "depth.frag.glsl",
            .defines = {{"DEPTH_ONLY", "1"}}};
}
inline ProgramRecipe sky_program() {
    return {.vertex_main = "fullscreen.vert.glsl", .fragment_main = "sky.frag.glsl"};
}
inline ProgramRecipe post_program() {
    return {.vertex_main = "fullscreen.vert.glsl", .fragment_main = "post.frag.glsl"};
}

/// A selection that owns its snippets; each provides its own id.
struct Selection {
    explicit Selection(const std::vector<std::string>& ids) {
        for (const std::string& id : ids)
            snippets.push_back(fixture_snippet(id));
        capabilities = ids;
    }
    StitchInput input() const {
        StitchInput result;
        for (const Snippet& snippet : snippets)
            result.snippets.push_back(&snippet);
        result.capabilities = capabilities;
        return result;
    }
    std::vector<Snippet> snippets;
    std::vector<std::string> capabilities;
};

inline std::vector<std::string> lines_of(const std::string& text) {
    return split(text, '\n');
}

}  // namespace relevo::shader::test
