// The declarations that are lifted out of a file.
#include <array>
#include <optional>

#include <fmt/format.h>

#include "base/contains.h"
#include "shader/annotation.h"
#include "shader/source_cursor.h"

namespace relevo::shader {
namespace {

constexpr std::array<std::string_view, 14> kVaryingTypes = {
    "float", "vec2", "vec3",  "vec4",  "int",   "ivec2", "ivec3",
    "ivec4", "uint", "uvec2", "uvec3", "uvec4", "mat3",  "mat4"};

bool is_sampler(std::string_view type) {
    if (!type.empty() && (type[0] == 'i' || type[0] == 'u')) type.remove_prefix(1);
    return type.substr(0, 7) == "sampler";
}

bool is_integer(std::string_view type) {
    return type == "int" || type == "uint" || type.substr(0, 4) == "ivec" ||
           type.substr(0, 4) == "uvec";
}

/// Moves after the `;`. The declaration must be the only one on its line.
void end_lifted(SourceCursor& cursor, std::size_t first, std::size_t name) {
    const int line = cursor.tokens[first].line;
    while (!cursor.at_end() && cursor.tokens[cursor.at].line == line && !cursor.is(cursor.at, ";"))
        ++cursor.at;
    if (!cursor.is(cursor.at, ";") || cursor.tokens[cursor.at].line != line)
        cursor.fail(line,
                    fmt::format("{}: expected ; before the end of the line", cursor.str(name)));
    ++cursor.at;
    const bool alone = (first == 0 || cursor.end_line(first - 1) < line) &&
                       (cursor.at_end() || cursor.tokens[cursor.at].line > line);
    if (!alone)
        cursor.fail(line, fmt::format("{}: expected one uniform or varying, alone on its line",
                                      cursor.str(name)));
    cursor.check_unconditional(line, cursor.str(name));
}

void add_sampler(SourceCursor& cursor, std::string_view type, std::size_t name) {
    const std::string& file = cursor.file;
    const int line = cursor.tokens[name].line;
    Sampler sampler{std::string(cursor.str(name)), std::string(type), "", file, line};
    sampler.resource = cursor.is_snippet() ? address_of(sampler.name) : sampler.name;
    if (const auto annotation = cursor.annotation_after(cursor.at - 1)) {
        for (const AnnotationWord& word : parse_annotation(*annotation, file, line)) {
            if (word.name != "from" || word.arguments.size() != 1 ||
                word.arguments[0].find('.') == std::string::npos)
                cursor.fail(line, fmt::format("{}: a sampler's only annotation is from(name.word), "
                                              "for a texture of another plugin",
                                              sampler.name));
            sampler.resource = word.arguments[0];
        }
    }
    cursor.samplers.push_back(std::move(sampler));
}

}  // namespace

void read_uniform(SourceCursor& cursor, std::size_t first, std::size_t type, std::size_t name) {
    const std::string_view type_name = cursor.str(type), name_text = cursor.str(name);
    const int line = cursor.tokens[name].line;
    cursor.check_name(name, name_text);
    const std::size_t after_name = cursor.at;
    end_lifted(cursor, first, name);
    if (cursor.is(after_name, ",") || cursor.is(type + 1, "[") || cursor.is(after_name, "["))
        cursor.fail(line, fmt::format("{}: expected one {} without brackets and commas", name_text,
                                      type_name));
    if (is_sampler(type_name)) {
        if (!cursor.is(after_name, ";"))
            cursor.fail(line, fmt::format("{}: expected ; but got {}", name_text,
                                          cursor.written(after_name)));
        add_sampler(cursor, type_name, name);
        return;
    }
    if (!cursor.is_snippet())
        cursor.fail(line, fmt::format("{}: core's uniforms are samplers and blocks", name_text));
    if (!param_type(type_name))
        cursor.fail(line, fmt::format("{}: expected a parameter of type float, int, bool, vec2, "
                                      "vec3 or vec4, or a sampler, but got {}",
                                      name_text, type_name));
    if (!cursor.is(after_name, "="))
        cursor.fail(line, fmt::format("{}: a parameter has a default; expected = after it but got "
                                      "{}",
                                      name_text, cursor.written(after_name)));
    const std::string_view initial = cursor.between(after_name, cursor.at - 1);
    const std::string_view annotation = cursor.annotation_after(cursor.at - 1).value_or("");
    cursor.params.push_back(
        parse_param(type_name, name_text, initial, annotation, cursor.file, line));
}

void read_varying(SourceCursor& cursor, std::size_t first, std::size_t type, std::size_t name,
                  const Qualifiers& qualifiers) {
    const int line = cursor.tokens[name].line;
    Varying varying;
    varying.name = cursor.str(name);
    varying.type = cursor.str(type);
    varying.is_input = qualifiers.count("in") > 0;
    varying.file = cursor.file;
    varying.line = line;
    cursor.check_name(name, varying.name);
    for (const std::string_view word : {"flat", "smooth", "noperspective"})
        if (qualifiers.count(word) > 0) varying.interpolation = word;
    if (!cursor.is(cursor.at, ";"))
        cursor.fail(line, fmt::format("{}: expected ; after the varying but got {}", varying.name,
                                      cursor.written(cursor.at)));
    end_lifted(cursor, first, name);
    const bool is_array = cursor.is(type + 1, "[");
    if (is_array || !contains(kVaryingTypes, varying.type))
        cursor.fail(line, fmt::format("{}: expected a varying of type float, int or uint, a vector "
                                      "of them, mat3 or mat4, but got {}{}",
                                      varying.name, varying.type, is_array ? "[]" : ""));
    if (is_integer(varying.type) && varying.interpolation != "flat")
        cursor.fail(line, fmt::format("{}: whole numbers are not interpolated; expected flat out "
                                      "{} but got out {}",
                                      varying.name, varying.type, varying.type));
    const bool is_fragment = cursor.kind == SourceKind::FragmentMain;
    if (!cursor.is_snippet() && varying.is_input != is_fragment)
        cursor.fail(line, fmt::format("{}: inputs of a vertex main and outputs of a fragment main "
                                      "have a layout(location = N)",
                                      varying.name));
    cursor.varyings.push_back(std::move(varying));
}

void read_ramp(SourceCursor& cursor, std::size_t first, std::size_t name, std::size_t names) {
    const std::optional<std::string_view> annotation = cursor.annotation_after(cursor.at - 1);
    if (!annotation) return;
    const std::string_view name_text = cursor.str(name);
    const int line = cursor.tokens[name].line;
    std::size_t equals = name + 1;
    while (equals < cursor.at && !cursor.is(equals, "="))
        ++equals;
    if (cursor.str(first) != "const" || cursor.str(first + 1) != "vec3" || names != 1 ||
        equals == cursor.at)
        cursor.fail(line, fmt::format("{}: an annotation after a variable is for a legend of "
                                      "colours, const vec3 {}[N] = vec3[](...);",
                                      name_text, name_text));
    cursor.ramps.push_back(parse_ramp(cursor.owner, name_text,
                                      cursor.between(equals, cursor.at - 1), *annotation,
                                      cursor.file, line));
}

}  // namespace relevo::shader
