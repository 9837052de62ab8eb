#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The places where a plugin's GLSL enters core's programs (docs/plugin-guide.md, Hooks).
namespace relevo::shader {

/// The programs' side that calls a hook. Post is the fragment side of the last, full-screen
/// program; Any are services, which both sides and plugins themselves may call.
enum class HookStage { Vertex, Fragment, Post, Any };

/// A chain calls every provider in order; an exclusive hook has one provider, or core's default;
/// a service is exclusive, and is called by its own name instead of `hook_<name>`.
enum class HookKind { Chain, Exclusive, Service };

struct Hook {
    std::string_view name;  ///< "albedo": plugin haze registers by defining `haze_on_albedo`
    HookStage stage;
    HookKind kind;
    std::string_view signature;  ///< exact GLSL, "void albedo(inout Surface s)"
};

/// All hooks, in the order in which a frame runs them. Append-only: names and signatures are a
/// promise to plugin authors.
std::span<const Hook> hooks();

/// The hook of that name, or null.
const Hook* find_hook(std::string_view name);

/// One parameter of a GLSL function; `in` where no qualifier is written.
struct Argument {
    std::string qualifier;  ///< "in", "out" or "inout"
    std::string type;       ///< "vec3"; of an array with its brackets, "float[3]"
    std::string name;       ///< may be empty
};

/// The head of a GLSL function.
struct Signature {
    std::string type;  ///< of what it returns
    std::string name;
    std::vector<Argument> arguments;

    /// "void haze_on_albedo(inout Surface)": what has to match, without the arguments' names.
    std::string text() const;
    /// Whether return type, and types and qualifiers of all arguments, are the same.
    bool matches(const Signature& other) const;
};

/// Reads a function's head, `type name(arguments)`, with nothing behind its closing parenthesis.
/// @pre the text is one; used on the table of hooks and on heads that the parser has cut out
Signature parse_signature(std::string_view head);

}  // namespace relevo::shader
