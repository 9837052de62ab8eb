#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The functions by which core's programs call a plugin's GLSL (docs/plugin-guide.md, Hooks).
namespace relevo::shader {

/// The shader stage that calls a hook. Post is the fragment stage of the last, full-screen
/// program. Any: services, which both stages and plugins may call.
enum class HookStage { Vertex, Fragment, Post, Any };

/// A chain calls every provider in order. An exclusive hook has one provider, or core's default. A
/// service is exclusive, and is called by its own name instead of `hook_<name>`.
enum class HookKind { Chain, Exclusive, Service };

struct Hook {
    std::string_view name;  ///< "albedo": plugin haze registers by defining `haze_on_albedo`
    HookStage stage;
    HookKind kind;
    std::string_view signature;   ///< exact GLSL, "void albedo(inout Surface s)"
    std::string_view modifies{};  ///< of a chain: the service whose result it changes
};

/// All hooks, in the order in which a frame runs them. Append-only: plugins depend on names and
/// signatures.
std::span<const Hook> hooks();

/// Null if there is no such hook.
const Hook* find_hook(std::string_view name);

/// One parameter of a GLSL function. Its default qualifier is `in`.
struct Argument {
    std::string qualifier;  ///< "in", "out" or "inout"
    std::string type;       ///< "vec3"; an array's has its brackets, "float[3]"
    std::string name;       ///< may be empty
};

/// The head of a GLSL function.
struct Signature {
    std::string type;  ///< return type
    std::string name;
    std::vector<Argument> arguments;

    /// "void haze_on_albedo(inout Surface)": the parts that must match, without argument names.
    std::string text() const;
    /// Whether the return type and the types and qualifiers of all arguments are equal.
    bool matches(const Signature& other) const;
};

/// Reads a function's head, `type name(arguments)`.
/// @pre the text is a whole head: a row of the table of hooks, or one from the parser
Signature parse_signature(std::string_view head);

}  // namespace relevo::shader
