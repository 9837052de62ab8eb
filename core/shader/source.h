#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "shader/colour_ramp.h"
#include "shader/hooks.h"
#include "shader/params.h"
#include "shader/tokenizer.h"

/// One GLSL file, parsed into items that the stitcher can omit.
namespace relevo::shader {

/// A top-level declaration or directive, which is copied into a program's text unchanged.
struct Item {
    enum class Kind {
        Function,
        Prototype,
        Declaration,  ///< constant, struct, global variable
        Interface,    ///< core only, never omitted: inputs and outputs with a layout, blocks
        Macro,        ///< #define
        Undef,
        Conditional,  ///< #if, #ifdef, #ifndef, #elif, #else, #endif
    };
    Kind kind;
    std::vector<std::string> names;  ///< globals that it declares
    std::size_t first = 0;           ///< its tokens: [first, last)
    std::size_t last = 0;
    std::size_t begin = 0;  ///< its characters, with the comments above and after it:
    std::size_t end = 0;    ///< [begin, end)
    int line = 0;           ///< of `begin`
    int name_line = 0;      ///< of the first of `names`
};

/// A sampler, lifted out of the file. Stitching assigns its texture unit.
struct Sampler {
    std::string name;      ///< in GLSL: haze_noise
    std::string type;      ///< "sampler2DArray"
    std::string resource;  ///< the texture it reads: "haze.noise", or what `//@ from(...)` names
    std::string file;
    int line = 0;
};

/// A varying from the vertex to the fragment stage, lifted out of the file.
struct Varying {
    std::string name;
    std::string type;
    std::string interpolation;  ///< "flat", "smooth", "noperspective" or empty
    bool is_input = false;      ///< declared with `in`: in fragment mains only
    std::string file;
    int line = 0;
};

struct Include {
    std::string name;  ///< "lib/noise.glsl"
    int line = 0;
};

enum class SourceKind { Snippet, Lib, Defaults, VertexMain, FragmentMain };

struct Source {
    SourceKind kind = SourceKind::Lib;
    std::string owner;  ///< plugin id, or "core"
    std::string file;   ///< its name for messages
    std::string text;
    std::vector<Token> tokens;
    std::vector<Item> items;  ///< in the order of the file
    std::vector<Param> params;
    std::vector<ColourRamp> ramps;  ///< of a snippet
    std::vector<Sampler> samplers;
    std::vector<Varying> varyings;
    std::vector<Include> includes;

    std::string_view str(const Token& token) const { return text_of(text, token); }
    /// The head of a function or prototype.
    Signature signature(const Item& item) const;
};

/// Parses a file.
/// @param owner  a snippet's plugin id, with which its globals must begin (`<owner>_`); else "core"
/// @throws Error (BadInput) `shader: file:line: ...`
Source parse_source(SourceKind kind, std::string_view owner, std::string_view file,
                    std::string_view text);

}  // namespace relevo::shader
