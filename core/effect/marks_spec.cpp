#include "effect/marks_spec.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace relevo::effect {
namespace {

std::string describe(const MarkKey& key) {
    switch (key.kind) {
        case MarkKey::Kind::Number:
            return fmt::format("a number in [{:g}, {:g}]", key.min, key.max);
        case MarkKey::Kind::Colour:
            return "a colour such as \"#ff8800\"";
        default:
            return fmt::format("one of {}", fmt::join(key.words, ", "));
    }
}

shader::ParamValue initial(const MarkKey& key) {
    if (key.kind == MarkKey::Kind::Colour) return *shader::parse_hex_colour(key.colour, 3);
    return {key.initial};
}

MarkValue read_value(json::ObjectReader& object, const MarkKey& key, const std::string& id) {
    const std::string name(key.key);
    const json::Value* const value = object.take(name);
    if (!value) return {initial(key), {}};
    if (value->kind == json::Value::Kind::Number && key.kind == MarkKey::Kind::Number &&
        value->number >= key.min && value->number <= key.max)
        return {{value->number}, {}};
    if (value->kind == json::Value::Kind::String) {
        const auto word = std::ranges::find(key.words, value->text);
        if (word != key.words.end()) return {{static_cast<double>(word - key.words.begin())}, {}};
        if (key.kind == MarkKey::Kind::Colour)
            if (const auto colour = shader::parse_hex_colour(value->text, 3)) return {*colour, {}};
        if (value->text.starts_with(id + '.')) return {{}, value->text};
    }
    object.fail(value->line, name,
                fmt::format("expected {}, or a parameter such as \"{}.{}\", but got {}",
                            describe(key), id, key.key, json::describe(*value)));
}

/// What is wrong with a parameter as the value of a key; empty if nothing is.
std::string fault_of(const MarkKey& key, const shader::Param& param) {
    using shader::ParamType;
    switch (key.kind) {
        case MarkKey::Kind::Number: {
            const bool number = param.type == ParamType::Float || param.type == ParamType::Int;
            if (!number || param.is_host || !param.words.empty())
                return "expected a float or an int that is not host";
            if (!param.range || param.range->min < key.min || param.range->max > key.max)
                return fmt::format("expected a range within [{:g}, {:g}]", key.min, key.max);
            return {};
        }
        case MarkKey::Kind::Colour:
            return param.type == ParamType::Vec3 && param.role == shader::ParamRole::ColourSrgb
                       ? ""
                       : "expected a vec3 with colour(srgb)";
        default:
            return param.words == key.words
                       ? ""
                       : fmt::format("expected an int with enum({})", fmt::join(key.words, ", "));
    }
}

}  // namespace

const std::vector<MarkKey>& mark_keys() {
    using Kind = MarkKey::Kind;
    static const std::vector<MarkKey> keys = {
        {"size", &MarksSpec::size_px, Kind::Number, 13, 4, 200},
        {"colour", &MarksSpec::colour, Kind::Colour, 0, 0, 1, "#202020"},
        {"halo", &MarksSpec::halo, Kind::Colour, 0, 0, 1, "#ffffff"},
        {"symbol", &MarksSpec::symbol, Kind::Word, 0, 0, 0, "", {"none", "dot", "triangle"}},
        {"leader", &MarksSpec::leader_px, Kind::Number, 0, 0, 1000},
        {"above", &MarksSpec::above_m, Kind::Number, 0, 0, 10000},
        {"distance", &MarksSpec::distance_px, Kind::Number, 4, 0, 1000},
        {"repeat", &MarksSpec::repeat_px, Kind::Number, 0, 0, 10000},
        {"order", &MarksSpec::order, Kind::Word, 0, 0, 0, "", {"rank", "nearest", "highest"}},
        {"most", &MarksSpec::most, Kind::Number, 200, 0, 2000}};
    return keys;
}

MarksSpec read_marks(json::ObjectReader& object, const std::string& id, const std::string& name) {
    MarksSpec marks;
    marks.name = name;
    marks.line = object.line();
    if (const std::string from = object.string("from", ""); !from.empty())
        marks.from = id + '.' + from;
    marks.summits = object.boolean("known_summits", false);
    for (const MarkKey& key : mark_keys())
        marks.*key.member = read_value(object, key, id);
    return marks;
}

std::string fault_of(const MarksSpec& marks, const std::vector<shader::Param>& params,
                     const std::vector<shader::TextParam>& texts, bool has_module) {
    if (marks.from.empty() && !marks.summits && !has_module)
        return fmt::format(
            "marks.{}: expected a member \"from\" or \"known_summits\", or a \"module\" of the "
            "plugin "
            "that "
            "sets the marks",
            marks.name);
    if (!marks.from.empty() && marks.summits)
        return fmt::format("marks.{}: has both \"from\" and \"known_summits\"; make two lists",
                           marks.name);
    const auto text = std::ranges::find(texts, marks.from, &shader::TextParam::address);
    if (!marks.from.empty() && (text == texts.end() || !text->is_file))
        return fmt::format(
            "marks.{0}.from: expected a text of kind file but got \"{1}\"; add \"texts\": "
            "{{\"{1}\": {{\"kind\": \"file\"}}}}",
            marks.name, marks.from.substr(marks.from.find('.') + 1));
    for (const MarkKey& key : mark_keys()) {
        const std::string& address = (marks.*key.member).address;
        if (address.empty()) continue;
        const auto param = std::ranges::find(params, address, &shader::Param::address);
        const std::string fault =
            param == params.end() ? "the plugin has no such parameter" : fault_of(key, *param);
        if (!fault.empty())
            return fmt::format("marks.{}.{}: {}: {}", marks.name, key.key, address, fault);
    }
    return {};
}

}  // namespace relevo::effect
