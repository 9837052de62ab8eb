#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "shader/core_texts.h"
#include "shader/line_map.h"
#include "shader/param_store.h"
#include "shader/snippet.h"

namespace relevo::shader {

struct Define {
    std::string name;
    std::string value;
};

/// A program of core's: two mains and the switches that they are compiled with.
struct ProgramRecipe {
    std::string vertex_main;    ///< "terrain.vert.glsl"
    std::string fragment_main;  ///< "depth.frag.glsl"
    std::vector<Define> defines{};

    /// Deferred shading splits a program in two. The geometry program stores what plugins hand from
    /// the vertex to the fragment side; the shading program, drawn later over the whole picture,
    /// loads it again for each pixel. Set on the geometry program: the fragment main of the shading
    /// program. Its own fragment main then calls `store_varyings()`, which writes to the outputs at
    /// location 1 and up.
    std::string shaded_by{};
    /// Set on the shading program: the vertex main of the geometry program. Its fragment main then
    /// calls `load_varyings(pixel)` before any hook.
    std::string geometry_of{};
};

struct StitchInput {
    std::vector<const Snippet*> snippets;   ///< of the enabled plugins, in calling order
    std::vector<std::string> capabilities;  ///< what they provide: HAS_<word> is 1 for these
    const ParamStore* values = nullptr;     ///< of static parameters; null takes their defaults
    int max_texture_units = 16;             ///< GL_MAX_TEXTURE_IMAGE_UNITS
    /// Textures that hold the same as another, by which name that one is on the device.
    std::map<std::string, std::string> same_textures{};
};

/// The text of one stage, compiled as one string, and where its lines come from.
struct StageText {
    std::string text;
    LineMap lines;
};

/// A texture unit of a program, bound by `layout(binding = unit)`.
struct TextureUnit {
    int unit = 0;
    std::string name;      ///< of the sampler in the text
    std::string type;      ///< "sampler2DArray"
    std::string resource;  ///< "haze.noise"; the sampler's own name for core's
    std::string owner;     ///< plugin id, or "core"
    /// Other names of the same texture, which need no unit of their own.
    std::vector<std::string> also;
};

/// A hook that a program calls, and who answers.
struct HookUse {
    const Hook* hook;
    std::vector<std::string> providers;  ///< plugin ids in calling order; empty: core alone
};

struct Stitched {
    StageText vertex;
    StageText fragment;
    std::vector<TextureUnit> textures;
    BlockLayout params;  ///< block `Params` at binding 1: the same for all programs of a selection
    bool uses_params = false;  ///< whether this program has the block
    std::vector<HookUse> hooks;
    /// Of a geometry or a shading program: how many RGBA32F targets hold the stored varyings, which
    /// the shading program reads as the layers of `varyings`.
    int varying_targets = 0;
};

/// What a plugin's author can mend. The others' effects could be drawn without that plugin.
class AuthorError : public Error {
  public:
    /// @param owner  id of the plugin
    AuthorError(std::string owner, const std::string& message)
        : Error(ErrorCode::BadInput, message), owner_(std::move(owner)) {}
    const std::string& owner() const { return owner_; }

  private:
    std::string owner_;
};

/// Puts a program together. Reads from `core` the two mains, lib/types.glsl, lib/frame.glsl,
/// defaults.glsl and what is included. Of all of them, and of the snippets, only what the two
/// `main` functions reach is in the texts; equal input gives equal bytes, and no path of a file is
/// in them.
///
/// A text is laid out as: version, a define for each capability and each word of `wants`,
/// lib/types.glsl, the frame block, the block of parameters, samplers, varyings, prototypes of
/// services, included files, defaults, snippets, the functions `hook_<name>` that call them, main.
/// @throws AuthorError (BadInput) `shader: file:line: ...`
/// @throws Error (BadInput) for two providers of an exclusive hook
/// @throws Error (Failed) for core's own texts, and for more textures than units
Stitched stitch(const CoreTexts& core, const ProgramRecipe& program, const StitchInput& input);

}  // namespace relevo::shader
