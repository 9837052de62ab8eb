#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
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

/// A parameter, sampler or varying: the stitcher declares those of all files at once.
struct Lifted {
    std::string name, owner, file;
    int line = 0;
    const Sampler* sampler = nullptr;
    const Varying* varying = nullptr;
};

struct Include {
    std::string name;  ///< "lib/noise.glsl"
    int line = 0;
};

/// Macros that snippets test by #if begin with this.
inline constexpr std::string_view kHasPrefix = "HAS_";

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

    bool is_snippet() const { return kind == SourceKind::Snippet; }
    std::string_view str(const Token& token) const { return text_of(text, token); }
    /// The text of the token `i`; empty beyond the last.
    std::string_view str(std::size_t i) const { return i < tokens.size() ? str(tokens[i]) : ""; }
    bool is(std::size_t i, std::string_view word) const { return str(i) == word; }
    bool is_word(std::size_t i) const {
        return i < tokens.size() && tokens[i].kind == TokenKind::Word;
    }
    /// The token after `i`; after an opening bracket, that after its closing one.
    std::size_t next(std::size_t i) const { return std::max(i, tokens[i].partner) + 1; }
    /// The first token from `i` that is one of these marks and not in brackets; or the end.
    std::size_t until(std::size_t i, std::string_view marks) const;
    /// The token after the statement that begins at `i`.
    std::size_t after_statement(std::size_t i) const;
    /// The operator that writes to the variable whose last name is the token `i`, or to a part of
    /// it: "=", "+=", "++"; empty if none does.
    std::string_view writes(std::size_t i) const;
    /// The first word of a directive, "if"; empty for other tokens and for a # alone.
    std::string_view directive(std::size_t i) const {
        return tokens[i].words.empty() ? "" : str(tokens[i].words[0]);
    }
    /// Calls a function with each token, and with those of a directive in its place.
    template <typename Visit>
    void each(const Visit& visit) const {
        for (const Token& token : tokens)
            if (token.kind == TokenKind::Directive)
                for (const Token& word : token.words)
                    visit(word);
            else
                visit(token);
    }
    /// The parameters, samplers and varyings.
    std::vector<Lifted> lifted() const;
    /// The head of a function or prototype.
    Signature signature(const Item& item) const;
    /// The function of that name, not a prototype; null without one.
    const Item* function(std::string_view name) const;
};

/// The text of tokens with spaces between them.
std::string joined(const Source& source, std::span<const Token> tokens);

/// Parses a file.
/// @param owner  a snippet's plugin id, with which its globals must begin (`<owner>_`); else "core"
/// @throws Error (BadInput) `shader: file:line: ...`
Source parse_source(SourceKind kind, std::string_view owner, std::string_view file,
                    std::string_view text);

}  // namespace relevo::shader
