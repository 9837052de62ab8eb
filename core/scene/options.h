#pragma once

#include <span>
#include <string>
#include <string_view>

#include "json/value.h"
#include "scene/scene.h"

namespace relevo::scene {

/// An option of a scene that is one value. The command line, scene and job files, their schema and
/// the window's copied command all take it from options(). Its default is that of Scene.
struct Option {
    enum class Kind { Number, Whole, Word, Text, Flag };

    std::string_view object;  ///< of JSON that has it, "picture"; empty: the scene itself
    std::string_view key;     ///< in that object, "pixel_error"
    std::string_view flag;    ///< of the command line; one of Kind::Flag sets what is no default
    std::string_view group;   ///< of --help
    std::string_view help;    ///< with the unit; also the schema's description
    Kind kind;
    /// Of numbers, both included. A value outside is written nowhere: the scene has none.
    double min = 0, max = 0;
    std::span<const std::string_view> words = {};  ///< of Kind::Word
    json::Value (*get)(const Scene&) = nullptr;
    void (*set)(Scene&, const json::Value&) = nullptr;
};

/// All of them, in the order of --help and of files.
std::span<const Option> options();

/// The one with a flag, which there must be.
const Option& option(std::string_view flag);

/// The value that a word of the command line means; a text where a number should be stays one.
json::Value value_of(const Option& option, const std::string& word);

/// "expected a number in [0.1, 170] but got 500", of numbers and words; empty if nothing is wrong.
std::string fault_of(const Option& option, const json::Value& value);

/// A scene's value as the command line writes it; empty if the scene has none.
std::string text_of(const Option& option, const Scene& scene);

/// Whether a scene has the value that it has where nothing is said.
bool is_default(const Option& option, const Scene& scene);

}  // namespace relevo::scene
