#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Reads JSON files that people write: scenes, jobs, presets and plugin manifests. Every value
/// knows its line, for messages. JSON is written with nlohmann/json directly.
namespace relevo::json {

struct Value {
    enum class Kind { Null, Bool, Number, String, Array, Object };
    Kind kind = Kind::Null;
    bool boolean = false;
    double number = 0;
    std::string text;
    std::vector<Value> items;                            ///< of an array
    std::vector<std::pair<std::string, Value>> members;  ///< of an object, in the file's order
    int line = 0;                                        ///< of a member: its key's
};

/// What a value is, for messages: `"text"`, `12`, `a list`, `an object`.
std::string describe(const Value& value);

/// Longer files are not written by people [bytes].
inline constexpr std::size_t kMaxBytes = std::size_t{1} << 20;

/// @param who   as messages begin: "effect::load"
/// @param file  as messages name it
/// @throws Error (BadInput) `who: file:line: ...` for a mistake in the syntax, bytes that
///         are no UTF-8, a key given twice, and a text of more than kMaxBytes
Value parse(std::string_view who, std::string_view file, std::string_view text);

}  // namespace relevo::json
