#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "shader/core_texts.h"
#include "shader/driver_log.h"
#include "shader/instance_set.h"
#include "shader/param_store.h"
#include "shader/plugin_pass.h"
#include "shader/snippet.h"

namespace relevo::shader {

struct Define {
    std::string name;
    std::string value;
};

/// One of core's programs: two mains, or that of a compute program, and the macros that they are
/// compiled with.
struct ProgramRecipe {
    std::string vertex_main;    ///< "terrain.vert.glsl"
    std::string fragment_main;  ///< "depth.frag.glsl"
    std::vector<Define> defines{};

    /// Deferred shading splits a program in two. The geometry program stores the plugins' varyings.
    /// The shading program, which is drawn over the whole image, loads them for each pixel. Set on
    /// the geometry program: the fragment main of the shading program. Its own fragment main then
    /// calls `store_varyings()`, which writes the outputs at location 1 and up.
    std::string shaded_by{};
    /// Set on the shading program: the vertex main of the geometry program. Its fragment main then
    /// calls `load_varyings(pixel)` before any hook.
    std::string geometry_of{};

    /// Main of a compute program, which has no other stage: "bloom.blur.comp.glsl".
    std::string compute_main{};
    /// Its work group and what it writes, lines before the plugins' text.
    std::vector<std::string> declarations{};
    std::string output{};  ///< name among these that the plugin uses; empty: none
};

struct StitchInput {
    std::vector<const Snippet*> snippets;   ///< of the enabled plugins, in calling order
    std::vector<std::string> capabilities;  ///< that they provide: HAS_<word> is 1
    std::vector<PluginPass> passes{};       ///< of the enabled plugins
    std::vector<InstanceSet> instances{};   ///< of the enabled plugins
    const ParamStore* values = nullptr;     ///< of constant parameters; null: their defaults
    /// Parameters are constants, as static ones always are, unless modules write them or they are
    /// 0: a division by 0 is infinite on devices, but compilers may make anything of it.
    bool constants = false;
    /// Ids of plugins that draw over the scene's overlay. nullopt: all that have the hook display
    /// do, and a lit overlay is over the materials of all.
    std::optional<std::vector<std::string>> over_overlay{};
    bool lit_overlay_is_over_all = true;  ///< whatever `over_overlay` says
    int max_texture_units = 16;           ///< GL_MAX_TEXTURE_IMAGE_UNITS
    /// Textures equal to another one, with the name of that one on the device.
    std::map<std::string, std::string> same_textures{};
};

/// The text of one stage, which is compiled as one string, and the sources of its lines.
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
    /// Other names of the same texture. They share its unit.
    std::vector<std::string> also;
};

/// A hook that a program calls, and its providers.
struct HookUse {
    const Hook* hook;
    std::vector<std::string>
        providers;  ///< plugin ids in calling order; empty: core's default only
};

struct Stitched {
    // Either the first two, or the last.
    StageText vertex;
    StageText fragment;
    StageText compute;
    std::vector<TextureUnit> textures;
    BlockLayout params;  ///< block `Params` at binding 1: the same for all programs of a selection
    bool uses_params = false;  ///< whether this program has the block
    std::vector<HookUse> hooks;
    std::vector<std::string> plugins;  ///< ids of those whose text it has, each once
    std::vector<std::string> names;    ///< of all globals of the plugins, for suggestions
    std::vector<std::string> values;   ///< of their parameters that are not constants
    /// Number of RGBA32F targets with the stored varyings of a geometry or shading program. The
    /// shading program reads them as the layers of `varyings`.
    int varying_targets = 0;

    std::array<const StageText*, 3> stages() const { return {&vertex, &fragment, &compute}; }
};

/// An error in a plugin. The frame could be drawn without that plugin.
class AuthorError : public Error {
  public:
    /// @param owner  id of the plugin
    AuthorError(std::string owner, const std::string& message)
        : Error(ErrorCode::BadInput, message), owner_(std::move(owner)) {}
    const std::string& owner() const { return owner_; }

  private:
    std::string owner_;
};

/// Stitches a program. Reads from `core` the mains, lib/types.glsl, lib/frame.glsl,
/// defaults.glsl and included files. The texts have only those items of core and snippets that the
/// `main` functions reach. Equal input gives equal bytes. The texts have no file paths.
///
/// A text is laid out as: version, a define for each capability and each word of `wants`,
/// lib/types.glsl, the frame block, the block of parameters, samplers, varyings, prototypes of
/// services, the declarations of a compute program, included files, defaults, snippets, the
/// functions `hook_<name>` that call them, main.
/// @throws AuthorError (BadInput) `shader: file:line: ...`
/// @throws Error (BadInput) for two providers of an exclusive hook
/// @throws Error (Failed) for core's own texts, and for more textures than units
Stitched stitch(const CoreTexts& core, const ProgramRecipe& program, const StitchInput& input);

}  // namespace relevo::shader
