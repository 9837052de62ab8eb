#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Reads JSON files that people write: scenes, jobs, presets and plugin manifests. Every value
/// knows its line, for messages. JSON is written with nlohmann/json directly.
namespace relevo::json {

struct Member;

struct Value {
    enum class Kind { Null, Bool, Number, String, Array, Object };
    Kind kind = Kind::Null;
    bool boolean = false;
    double number = 0;
    std::string text;
    std::vector<Value> items;     ///< of an array
    std::vector<Member> members;  ///< of an object, in the file's order
    int line = 0;                 ///< of a member: its key's
};

/// A pair would do, but not for clang with this library: it needs a whole type sooner.
struct Member {
    std::string name;
    Value value;
};

/// A value for messages: `"text"`, `12`, `a list`, `an object`.
std::string describe(const Value& value);

/// Limit of a file, longer than people write [bytes].
inline constexpr std::size_t kMaxBytes = std::size_t{1} << 20;

/// @param who   begins messages: "scene"
/// @param file  its name for messages
/// @param most  bytes of a text
/// @throws Error (BadInput) `who: file:line: ...` for a syntax error, bytes that are not UTF-8, a
///         duplicate key, and a longer text
Value parse(std::string_view who, std::string_view file, std::string_view text,
            std::size_t most = kMaxBytes);

}  // namespace relevo::json
