#include "effect/preset.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/paths.h"
#include "base/text.h"
#include "json/object_reader.h"

namespace relevo::effect {
namespace {

constexpr std::string_view kPresetWho = "preset";

std::filesystem::path presets_dir() {
    return share_dir() / "presets";
}

std::filesystem::path find_preset(const std::string& name) {
    if (is_preset_file(name)) return name;
    const std::vector<std::string> names = preset_names();
    if (!contains(names, name)) {
        const std::optional<std::string> near = nearest(name, names);
        bad_input(fmt::format(
            "{}: {}: no such preset; {}", kPresetWho, name,
            near ? fmt::format("did you mean {}?", *near)
                 : fmt::format("there are {}", names.empty()
                                                   ? std::string("none")
                                                   : fmt::format("{}", fmt::join(names, ", ")))));
    }
    return presets_dir() / (name + ".json");
}

}  // namespace

std::optional<std::string> value_text(const json::Value& value) {
    switch (value.kind) {
        case json::Value::Kind::Bool:
        case json::Value::Kind::Number:
            return json::describe(value);
        case json::Value::Kind::String:
            return value.text;
        case json::Value::Kind::Array: {
            std::vector<std::string> texts;
            for (const json::Value& item : value.items) {
                if (item.kind != json::Value::Kind::Number) return std::nullopt;
                texts.push_back(json::describe(item));
            }
            return fmt::format("{}", fmt::join(texts, ","));
        }
        default:
            return std::nullopt;
    }
}

Setting parse_setting(std::string_view text) {
    const std::size_t equals = text.find('=');
    const std::size_t dot = text.find('.');
    if (equals == std::string_view::npos || dot == std::string_view::npos || dot == 0 ||
        dot > equals)
        bad_usage(fmt::format(
            "--set: expected PLUGIN.PARAMETER=VALUE without spaces but got \"{}\"", text));
    return {std::string(text.substr(0, equals)), std::string(text.substr(equals + 1)), 0};
}

std::vector<Setting> read_settings(json::ObjectReader& object, const std::string& key,
                                   const std::string& folder) {
    std::vector<Setting> settings;
    const json::Value* const set = object.take(key);
    if (!set) return settings;
    if (set->kind != json::Value::Kind::Object)
        object.fail(set->line, key,
                    fmt::format("expected an object of address and value but got {}",
                                json::describe(*set)));
    for (const auto& [address, value] : set->members) {
        const std::optional<std::string> text = value_text(value);
        if (!text)
            object.fail(value.line, key,
                        fmt::format("{}: expected a number, true or false, a text or a list of "
                                    "numbers but got {}",
                                    address, json::describe(value)));
        settings.push_back({address, *text, value.line, folder});
    }
    return settings;
}

bool is_preset_file(const std::string& name_or_path) {
    return name_or_path.find('/') != std::string::npos ||
           std::filesystem::path(name_or_path).extension() == ".json";
}

Preset load_preset(const std::string& name_or_path) {
    const std::filesystem::path path = find_preset(name_or_path);
    Preset preset;
    preset.name = path.stem().string();
    preset.file = path.string();
    const json::Value root = json::parse(kPresetWho, preset.file, read_text(path, kPresetWho));
    json::ObjectReader object(kPresetWho, preset.file, "", root);
    preset.description = object.string("description", "");
    if (object.take("only")) preset.switches.only = object.strings("only");
    preset.switches.enable = object.strings("enable");
    preset.switches.disable = object.strings("disable");
    preset.settings = read_settings(object, "set", path.parent_path().string());
    object.finish();
    return preset;
}

std::vector<std::string> preset_names() {
    std::vector<std::string> names;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(presets_dir(), ignored))
        if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
    std::ranges::sort(names);
    return names;
}

}  // namespace relevo::effect
