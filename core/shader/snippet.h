#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "shader/hooks.h"
#include "shader/plugin_pass.h"
#include "shader/source.h"

namespace relevo::shader {

/// A hook function that a snippet defines.
struct HookFunction {
    const Hook* hook;
    std::string name;  ///< "haze_on_atmosphere"
    int line = 0;
};

/// A function `<id>_pass_<name>` that a snippet defines, for PluginPass.
struct PassFunction {
    std::string name;  ///< "blur"
    int line = 0;
    PluginPass::Kind kind = PluginPass::Kind::Full;  ///< that has its signature
};

/// A function `<id>_place_<name>` that a snippet defines, for InstanceSet.
struct PlaceFunction {
    std::string name;  ///< "stone"
    int line = 0;
};

/// A capability word that a snippet uses as the macro `HAS_<word>`: 1 if an enabled effect provides
/// it, else 0.
struct Wanted {
    std::string word;
    int line = 0;
};

/// One GLSL file of a plugin, parsed and checked. A plugin with several files has consecutive
/// snippets with the same id.
struct Snippet {
    std::string id;
    std::string file;
    std::vector<HookFunction> hooks;  ///< in the order of the file
    std::vector<PassFunction> passes;
    std::vector<PlaceFunction> places;
    std::vector<Wanted> wanted;  ///< each word once
    Source source;               ///< text, parameters, samplers, varyings, includes

    const HookFunction* find(std::string_view hook_name) const;  ///< or null
};

/// Whether a hook function may change its arguments where a capability word is provided, or not:
/// whether the code that `#if HAS_<word>` and `#if !HAS_<word>` in it leave names one of them, but
/// for a call of core's own function. Functions with a result, and other conditions, are taken to.
bool changes_arguments(const Snippet& snippet, const HookFunction& function, std::string_view word,
                       bool is_provided);

/// Reads a plugin's GLSL. The rules are docs/plugin-guide.md's; in short:
/// - every global (function, constant, struct, macro, variable) begins with `<id>_`;
/// - `<id>_on_<hook>` with the hook's exact types is the registration;
/// - `vec4 <id>_pass_<name>(in Texel t)`, `(in Voxel v)` or `void ...(in Invocation i)` computes
/// the
///   pass `name`;
/// - `void <id>_place_<name>(in InstanceSite at, inout Instance it)` places the instances `name`;
/// - `uniform` is a parameter (`= default; //@ annotation`) or a sampler, `out` a varying: one a
///   line, never under #if;
/// - `//@ include lib/NAME.glsl` includes core's shared functions.
/// @param id    `[a-z][a-z0-9]*`
/// @param file  its name for messages
/// @throws Error (BadInput) `shader: file:line: what is wrong`
Snippet parse_snippet(std::string_view id, std::string_view file, std::string_view text);

}  // namespace relevo::shader
