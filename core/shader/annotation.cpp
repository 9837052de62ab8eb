#include "shader/annotation.h"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/text.h"
#include "shader/tokenizer.h"

namespace relevo::shader {
namespace {

constexpr std::array kTypes = {ParamType::Float, ParamType::Int,  ParamType::Bool,
                               ParamType::Vec2,  ParamType::Vec3, ParamType::Vec4};

/// "Noise scale" for haze_noise_scale.
std::string label_of(std::string_view name) {
    std::string label(name.substr(name.find('_') + 1));
    std::ranges::replace(label, '_', ' ');
    if (!label.empty() && label[0] >= 'a' && label[0] <= 'z')
        label[0] = static_cast<char>(label[0] - 'a' + 'A');
    return label;
}

/// A number of a GLSL default: sign, decimals, exponent, suffix f.
std::optional<double> parse_literal(std::string_view text) {
    std::string_view digits = trimmed(text);
    const bool negative = !digits.empty() && digits.front() == '-';
    if (negative || (!digits.empty() && digits.front() == '+')) digits = trimmed(digits.substr(1));
    if (!digits.empty() && (digits.back() == 'f' || digits.back() == 'F')) digits.remove_suffix(1);
    if (digits.empty() || digits.front() == '-' || digits.front() == '+') return std::nullopt;
    const std::optional<double> number = parse_number(digits);
    if (!number) return std::nullopt;
    return negative ? -*number : *number;
}

class ParamReader {
  public:
    ParamReader(Param& param, std::string_view file, int line)
        : param_(param), file_(file), line_(line) {}

    void annotation(const std::vector<AnnotationWord>& words) {
        std::vector<std::string> seen;
        for (const AnnotationWord& word : words) {
            if (contains(seen, word.name)) fail("{} is given twice", word.name);
            seen.push_back(word.name);
            apply(word);
        }
        check_together();
    }

    void initial(std::string_view text) {
        const std::optional<ParamValue> value = read_initial(trimmed(text));
        if (!value)
            fail("expected a {} literal as its default but got {}", glsl_name(param_.type),
                 trimmed(text));
        param_.initial = *value;
        if (!param_.is_host && !is_valid(param_, *value))
            fail("expected a default that is {} but got {}", expected_values(param_, *value),
                 trimmed(text));
    }

  private:
    template <typename... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> message, Args&&... args) const {
        source_error(
            file_, line_,
            fmt::format("{}: {}", param_.name, fmt::format(message, std::forward<Args>(args)...)));
    }

    bool is_vec() const { return component_count(param_.type) > 1; }

    void role(ParamRole role, bool fits, std::string_view types, const AnnotationWord& word) {
        if (!fits) fail("{} is for {}, not for a {}", word.name, types, glsl_name(param_.type));
        if (param_.role != ParamRole::Plain)
            fail("it can be only one of colour, angle and direction");
        param_.role = role;
    }

    struct Row {
        std::string_view name, form;
        std::size_t arguments;  ///< that `form` has
        void (*apply)(ParamReader& reader, const AnnotationWord& word);
    };
    void apply(const AnnotationWord& given) {
        constexpr std::size_t kAny = 100;
        static constexpr std::array<Row, 10> kRows = {{
            {"range", "range(min, max)", 2, [](auto& self, auto& word) { self.range(word); }},
            {"unit", "unit(1/km)", 1,
             [](auto& self, auto& word) { self.param_.unit = word.arguments[0]; }},
            {"label", "label(\"Text\")", 1,
             [](auto& self, auto& word) { self.param_.label = word.arguments[0]; }},
            {"description", "description(\"Text\")", 1,
             [](auto& self, auto& word) { self.param_.description = word.arguments[0]; }},
            {"enum", "", kAny, [](auto& self, auto& word) { self.enumeration(word); }},
            {"colour", "", kAny, [](auto& self, auto& word) { self.colour(word); }},
            {"angle", "angle", 0,
             [](auto& self, auto& word) {
                 self.role(ParamRole::Angle, self.param_.type == ParamType::Float, "float", word);
             }},
            {"direction", "direction", 0,
             [](auto& self, auto& word) {
                 self.role(ParamRole::Direction, self.param_.type == ParamType::Vec3, "vec3", word);
             }},
            {"static", "static", 0, [](auto& self, auto&) { self.param_.is_static = true; }},
            {"host", "host", 0, [](auto& self, auto&) { self.param_.is_host = true; }},
        }};

        const auto row = std::ranges::find(kRows, given.name, &Row::name);
        if (row == kRows.end()) {
            std::vector<std::string> names;
            for (const Row& known : kRows)
                names.emplace_back(known.name);
            const std::optional<std::string> near = nearest(given.name, names);
            fail("unknown annotation {}; {}", given.name,
                 near ? fmt::format("did you mean {}?", *near)
                      : fmt::format("there are {}", fmt::join(names, ", ")));
        }
        if (row->arguments != kAny && given.arguments.size() != row->arguments)
            fail("expected {} but got {}", row->form, given.written());
        row->apply(*this, given);
    }

    void colour(const AnnotationWord& word) {
        if (word.arguments.size() > 1 || (!word.arguments.empty() && word.arguments[0] != "srgb"))
            fail("expected colour or colour(srgb) but got {}", word.written());
        role(word.arguments.empty() ? ParamRole::Colour : ParamRole::ColourSrgb,
             param_.type == ParamType::Vec3 || param_.type == ParamType::Vec4, "vec3 and vec4",
             word);
    }

    void range(const AnnotationWord& word) {
        if (param_.type == ParamType::Bool) fail("a bool has no range");
        const std::optional<double> min = parse_number(word.arguments[0]);
        const std::optional<double> max = parse_number(word.arguments[1]);
        if (!min || !max || !(*min < *max))
            fail(
                "expected range(min, max), two numbers of which the first is less, "
                "but got {}",
                word.written());
        const bool whole = param_.type == ParamType::Int;
        const double most = whole ? std::numeric_limits<int>::max()
                                  : static_cast<double>(std::numeric_limits<float>::max());
        if (*min < -most || *max > most)
            fail(
                "expected a range within {0:.10g} and {1:.10g}, as {2} can hold, but "
                "got {3}",
                -most, most, whole ? "an int" : "a float", word.written());
        param_.range = ParamRange{*min, *max};
    }

    void enumeration(const AnnotationWord& word) {
        if (param_.type != ParamType::Int)
            fail("enum is for int, not for a {}", glsl_name(param_.type));
        for (const std::string& value : word.arguments) {
            if (value.empty() || !std::ranges::all_of(value, is_word_byte) ||
                (value[0] >= '0' && value[0] <= '9') ||
                std::ranges::count(word.arguments, value) > 1)
                fail("expected enum(word, word, ...), all different, but got {}", word.written());
        }
        if (word.arguments.size() < 2)
            fail("expected an enum of at least two words but got {}", word.written());
        param_.words = word.arguments;
    }

    void check_together() {
        if (param_.is_static && param_.is_host)
            fail("it cannot be both static, a constant, and host, written for every frame");
        if (param_.is_host && param_.role == ParamRole::Angle)
            fail("a host parameter is in radians; remove angle");
        if (!param_.words.empty() && param_.range) fail("an enum has its words and no range");
        if (param_.role == ParamRole::Angle && param_.unit.empty()) param_.unit = "deg";
        if (param_.role == ParamRole::Angle && param_.unit != "deg")
            fail("an angle is in deg, not in {}", param_.unit);
        if ((param_.role == ParamRole::Colour || param_.role == ParamRole::ColourSrgb) &&
            !param_.range)
            param_.range = ParamRange{0, 1};
        if (param_.role == ParamRole::Direction && param_.range) fail("a direction has no range");
        const bool number = param_.type == ParamType::Float || param_.type == ParamType::Int;
        if (number && !param_.range && param_.words.empty() && !param_.is_host)
            fail("expected a //@ after it with a range{}; add //@ range(min, max)",
                 param_.type == ParamType::Int ? " or an enum" : "");
    }

    std::optional<ParamValue> read_initial(std::string_view text) const {
        if (param_.type == ParamType::Bool) {
            if (text == "true") return ParamValue{1};
            if (text == "false") return ParamValue{0};
            return std::nullopt;
        }
        if (!is_vec()) {
            const std::optional<double> number = parse_literal(text);
            if (!number) return std::nullopt;
            return ParamValue{*number};
        }
        const std::string_view constructor = glsl_name(param_.type);
        if (text.substr(0, constructor.size()) != constructor) return std::nullopt;
        text = trimmed(text.substr(constructor.size()));
        if (text.size() < 2 || text.front() != '(' || text.back() != ')') return std::nullopt;
        const std::vector<std::string> pieces = split(text.substr(1, text.size() - 2), ',');
        const auto count = static_cast<std::size_t>(component_count(param_.type));
        if (pieces.size() != 1 && pieces.size() != count) return std::nullopt;
        ParamValue value{};
        for (std::size_t i = 0; i < count; ++i) {
            const std::optional<double> number = parse_literal(pieces[pieces.size() == 1 ? 0 : i]);
            if (!number) return std::nullopt;
            value[i] = *number;
        }
        return value;
    }

    Param& param_;
    std::string_view file_;
    int line_;
};

}  // namespace

std::string AnnotationWord::written() const {
    return arguments.empty() ? name : fmt::format("{}({})", name, fmt::join(arguments, ", "));
}

std::vector<AnnotationWord> parse_annotation(std::string_view text, std::string_view file,
                                             int line) {
    std::vector<AnnotationWord> words;
    std::size_t at = 0;
    const auto skip_blanks = [&] {
        while (at < text.size() && (text[at] == ' ' || text[at] == '\t'))
            ++at;
    };
    const auto fail = [&](const std::string& message) {
        source_error(file, line, fmt::format("//@{}: {}", printable(text), message));
    };
    // Tabs count as spaces.
    std::string plain(text);
    std::ranges::replace(plain, '\t', ' ');
    if (plain != printable(plain)) fail("expected UTF-8 without control characters");
    for (skip_blanks(); at < text.size(); skip_blanks()) {
        AnnotationWord word;
        while (at < text.size() && is_word_byte(text[at]))
            word.name += text[at++];
        if (word.name.empty()) fail(fmt::format("expected a word but got {}", text.substr(at)));
        skip_blanks();
        if (at < text.size() && text[at] == '(') {
            ++at;
            int depth = 1;
            std::string argument;
            bool quoted = false;
            for (; at < text.size() && depth > 0; ++at) {
                const char c = text[at];
                if (c == '"') {
                    const std::size_t end = text.find('"', at + 1);
                    if (end == std::string_view::npos) fail("a quotation mark is never closed");
                    argument = text.substr(at + 1, end - at - 1);
                    quoted = true;
                    at = end;
                } else if (c == ',' && depth == 1) {
                    word.arguments.emplace_back(quoted ? argument : trimmed(argument));
                    argument.clear();
                    quoted = false;
                } else {
                    depth += (c == '(') - (c == ')');
                    if (depth > 0 && !quoted) argument += c;
                }
            }
            if (depth > 0) fail(fmt::format("the ( after {} is never closed", word.name));
            word.arguments.emplace_back(quoted ? argument : trimmed(argument));
        }
        words.push_back(std::move(word));
    }
    return words;
}

Param parse_param(std::string_view type, std::string_view name, std::string_view initial,
                  std::string_view annotation, std::string_view file, int line) {
    Param param;
    param.name = name;
    param.address = address_of(name);
    param.type = *param_type(type);
    param.label = label_of(name);
    param.file = file;
    param.line = line;
    ParamReader reader(param, file, line);
    reader.annotation(parse_annotation(annotation, file, line));
    reader.initial(initial);
    return param;
}

std::optional<ParamType> param_type(std::string_view name) {
    const auto found = std::ranges::find(kTypes, name, glsl_name);
    if (found == kTypes.end()) return std::nullopt;
    return *found;
}

std::string address_of(std::string_view name) {
    std::string address(name);
    const std::size_t underscore = address.find('_');
    if (underscore != std::string::npos) address[underscore] = '.';
    return address;
}

}  // namespace relevo::shader
