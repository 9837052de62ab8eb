#include "shader/params.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/srgb.h"
#include "base/text.h"
#include "base/units.h"

namespace relevo::shader {
namespace {

constexpr double kMaxFloat = static_cast<double>(std::numeric_limits<float>::max());

bool is_colour(const Param& param) {
    return param.role == ParamRole::Colour || param.role == ParamRole::ColourSrgb;
}

std::optional<ParamValue> parse_bool(std::string_view text) {
    if (text == "true" || text == "on" || text == "1") return ParamValue{1};
    if (text == "false" || text == "off" || text == "0") return ParamValue{0};
    return std::nullopt;
}

std::optional<ParamValue> parse_components(const Param& param, std::string_view text) {
    const std::vector<std::string> pieces = split(text, ',');
    if (pieces.size() != static_cast<std::size_t>(component_count(param.type))) return std::nullopt;
    ParamValue value{};
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const std::optional<double> number = parse_number(trimmed(pieces[i]));
        if (!number) return std::nullopt;
        value[i] = *number;
    }
    return value;
}

std::optional<ParamValue> read_value(const Param& param, std::string_view text) {
    if (param.type == ParamType::Bool) return parse_bool(text);
    if (const auto word = std::ranges::find(param.words, text); word != param.words.end())
        return ParamValue{static_cast<double>(word - param.words.begin())};
    if (!is_colour(param) || !text.starts_with('#')) return parse_components(param, text);
    std::optional<ParamValue> value = parse_hex_colour(text, component_count(param.type));
    if (value && param.role == ParamRole::Colour)
        std::transform(value->begin(), value->begin() + 3, value->begin(), linear_of_srgb);
    return value;
}

std::string float_literal(float value) {
    std::string text = fmt::format("{}", value);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
}

}  // namespace

std::string_view glsl_name(ParamType type) {
    constexpr std::array<std::string_view, 6> kNames = {"float", "int",  "bool",
                                                        "vec2",  "vec3", "vec4"};
    return kNames[static_cast<std::size_t>(type)];
}

int component_count(ParamType type) {
    constexpr std::array<int, 6> kCounts = {1, 1, 1, 2, 3, 4};
    return kCounts[static_cast<std::size_t>(type)];
}

std::string describe_values(const Param& param) {
    if (!param.words.empty()) return fmt::format("one of {}", fmt::join(param.words, ", "));
    if (param.type == ParamType::Bool) return "true or false";
    std::string text;
    if (param.role == ParamRole::Angle) {
        text = "an angle";
    } else if (param.role == ParamRole::Direction) {
        text = "a direction, three numbers east,north,up that are not all zero";
    } else if (is_colour(param)) {
        text = fmt::format("a colour, #rrggbb or {} numbers",
                           component_count(param.type) == 3 ? "three" : "four");
    } else if (component_count(param.type) > 1) {
        constexpr std::array<std::string_view, 3> kCounts = {"two", "three", "four"};
        text = fmt::format("{} numbers with commas between",
                           kCounts[static_cast<std::size_t>(component_count(param.type) - 2)]);
    } else {
        text = param.type == ParamType::Int ? "a whole number" : "a number";
    }
    if (param.range) text += fmt::format(" in [{}, {}]", param.range->min, param.range->max);
    if (!param.unit.empty()) text += ' ' + param.unit;
    return text;
}

std::string expected_values(const Param& param, const ParamValue& given) {
    const bool too_large =
        std::ranges::any_of(given, [](double v) { return !(std::abs(v) <= kMaxFloat); });
    std::string text = describe_values(param);
    if (too_large && !param.range) text += fmt::format(", none beyond {:.6g} in size", kMaxFloat);
    return text;
}

bool is_valid(const Param& param, const ParamValue& value) {
    const int count = component_count(param.type);
    for (int i = 0; i < count; ++i) {
        const double v = value[static_cast<std::size_t>(i)];
        if (!(std::abs(v) <= kMaxFloat)) return false;
        if (param.range && !(v >= param.range->min && v <= param.range->max)) return false;
    }
    switch (param.type) {
        case ParamType::Bool:
            return value[0] == 0 || value[0] == 1;
        case ParamType::Int:
            if (value[0] != std::floor(value[0]) || value[0] < std::numeric_limits<int>::min() ||
                value[0] > std::numeric_limits<int>::max())
                return false;
            return param.words.empty() ||
                   (value[0] >= 0 && value[0] < static_cast<double>(param.words.size()));
        default:
            return param.role != ParamRole::Direction ||
                   std::hypot(value[0], value[1], value[2]) > 0;
    }
}

std::optional<ParamValue> parse_hex_colour(std::string_view text, int components) {
    const std::size_t bytes = text.size() / 2;
    if ((text.size() != 7 && text.size() != 9) || text.front() != '#' ||
        bytes > static_cast<std::size_t>(components))
        return std::nullopt;
    ParamValue value{0, 0, 0, components == 4 ? 1.0 : 0.0};
    for (std::size_t i = 0; i < bytes; ++i) {
        int byte = 0;
        const char* const end = text.data() + 2 * i + 3;
        if (std::from_chars(end - 2, end, byte, 16).ptr != end || text[2 * i + 1] == '-')
            return std::nullopt;
        value[i] = byte / 255.0;
    }
    return value;
}

ParamValue parse_value(const Param& param, std::string_view text) {
    const std::optional<ParamValue> value = read_value(param, trimmed(text));
    if (!value || !is_valid(param, *value))
        bad_input(fmt::format("parameter: {}: expected {} but got \"{}\"", param.address,
                              expected_values(param, value.value_or(ParamValue{})), text));
    return *value;
}

std::string format_value(const Param& param, const ParamValue& value) {
    if (param.type == ParamType::Bool) return value[0] != 0 ? "true" : "false";
    if (!param.words.empty()) return param.words[static_cast<std::size_t>(value[0])];
    return fmt::format("{}",
                       fmt::join(value.begin(), value.begin() + component_count(param.type), ","));
}

std::array<float, 4> shader_value(const Param& param, const ParamValue& value) {
    ParamValue sent = value;
    if (param.role == ParamRole::Angle) sent[0] = radians(sent[0]);
    if (param.role == ParamRole::Direction) {
        const double length = std::hypot(value[0], value[1], value[2]);
        for (std::size_t i = 0; i < 3; ++i)
            sent[i] = value[i] / length;
    }
    std::array<float, 4> result{};
    std::transform(sent.begin(), sent.end(), result.begin(),
                   [](double v) { return static_cast<float>(v); });
    return result;
}

std::string glsl_value(const Param& param, const ParamValue& value) {
    if (param.type == ParamType::Bool) return value[0] != 0 ? "true" : "false";
    if (param.type == ParamType::Int) return fmt::format("{}", static_cast<long>(value[0]));
    const std::array<float, 4> sent = shader_value(param, value);
    if (param.type == ParamType::Float) return float_literal(sent[0]);
    std::string text = std::string(glsl_name(param.type)) + '(';
    for (int i = 0; i < component_count(param.type); ++i)
        text += (i > 0 ? ", " : "") + float_literal(sent[static_cast<std::size_t>(i)]);
    return text + ')';
}

}  // namespace relevo::shader
