#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/plugin_tools.h"
#include "cli/shared.h"
#include "effect/registry.h"

namespace relevo::cli {
namespace {

/// The parameters that --set takes: not those that the plugin's own code writes.
std::vector<shader::Param> settable(const effect::Effect& effect) {
    std::vector<shader::Param> params = effect.params();
    std::erase_if(params, [](const shader::Param& param) { return param.is_host; });
    return params;
}

const char* type_of(const shader::TextParam& text) {
    return text.is_file ? "file" : "text";
}

nlohmann::ordered_json json_of(const effect::Effect& effect) {
    const effect::Manifest& manifest = effect.manifest;
    nlohmann::ordered_json params = nlohmann::ordered_json::array();
    for (const shader::Param& param : settable(effect))
        params.push_back({{"address", param.address},
                          {"type", shader::glsl_name(param.type)},
                          {"default", shader::format_value(param, param.initial)},
                          {"values", shader::describe_values(param)},
                          {"unit", param.unit},
                          {"label", param.label},
                          {"description", param.description}});
    for (const shader::TextParam& text : manifest.texts)
        params.push_back({{"address", text.address},
                          {"type", type_of(text)},
                          {"default", text.initial},
                          {"values", type_of(text)},
                          {"unit", ""},
                          {"label", text.label},
                          {"description", text.description}});
    return {{"id", manifest.id},
            {"name", manifest.name},
            {"description", manifest.description},
            {"version", manifest.version},
            {"enabled_by_default", manifest.enabled_by_default},
            {"provides", manifest.provides},
            {"requires", manifest.needs},
            {"folder", manifest.folder.string()},
            {"parameters", params}};
}

void print_list(const effect::Registry& registry, bool json) {
    if (json) {
        nlohmann::ordered_json plugins = nlohmann::ordered_json::array();
        for (const effect::Effect& effect : registry.effects())
            plugins.push_back(json_of(effect));
        nlohmann::ordered_json broken = nlohmann::ordered_json::array();
        for (const effect::BrokenEffect& effect : registry.broken())
            broken.push_back(
                {{"id", effect.id}, {"folder", effect.folder.string()}, {"error", effect.error}});
        const nlohmann::ordered_json all = {{"plugins", plugins}, {"broken", broken}};
        fmt::print("{}", json_text(with_schema("relevo-plugins-1", all)));
        return;
    }
    for (const effect::Effect& effect : registry.effects())
        fmt::print("{:<12} {:<4} {}\n", effect.id(),
                   effect.manifest.enabled_by_default ? "on" : "off", effect.manifest.description);
    for (const effect::BrokenEffect& effect : registry.broken())
        fmt::print("{:<12} {:<4} {}\n", effect.id, "-", effect.error);
}

/// @throws Error (Failed) if a plugin is broken, after the list
void list(const effect::Registry& registry, bool json) {
    print_list(registry, json);
    std::vector<std::string> broken;
    for (const effect::BrokenEffect& effect : registry.broken())
        broken.push_back(effect.id);
    if (broken.empty()) return;
    std::fflush(stdout);
    failed(fmt::format("plugins: {} of {} cannot be used: {}", broken.size(),
                       broken.size() + registry.effects().size(), fmt::join(broken, ", ")));
}

void info(const effect::Effect& effect, bool json) {
    if (json) {
        fmt::print("{}", json_text(with_schema("relevo-plugins-info-1", json_of(effect))));
        return;
    }
    const effect::Manifest& manifest = effect.manifest;
    fmt::print("{} ({} {})\n{}\n", manifest.name, manifest.id, manifest.version,
               manifest.description);
    fmt::print("folder    {}\n", manifest.folder.string());
    fmt::print("default   {}\n", manifest.enabled_by_default ? "on" : "off");
    if (!manifest.provides.empty())
        fmt::print("provides  {}\n", fmt::join(manifest.provides, ", "));
    if (!manifest.needs.empty()) fmt::print("requires  {}\n", fmt::join(manifest.needs, ", "));
    if (!manifest.wants.empty()) fmt::print("wants     {}\n", fmt::join(manifest.wants, ", "));
    for (const shader::Param& param : settable(effect)) {
        fmt::print("\n{} = {}\n    {}", param.address, shader::format_value(param, param.initial),
                   param.label);
        fmt::print("{}{}\n", param.description.empty() ? "" : ": ", param.description);
        fmt::print("    {}\n", shader::describe_values(param));
    }
    for (const shader::TextParam& text : manifest.texts) {
        fmt::print("\n{} = {}\n    {}", text.address, text.initial, text.label);
        fmt::print("{}{}\n", text.description.empty() ? "" : ": ", text.description);
        fmt::print("    a {}\n", type_of(text));
    }
}

}  // namespace

void add_plugins(Verb app) {
    struct PluginsArguments {
        std::vector<std::string> plugin_path;
        std::string id;
        bool json = false;

        effect::Registry registry() const {
            return effect::Registry::load_installed({plugin_path.begin(), plugin_path.end()});
        }
    };
    const auto arguments = std::make_shared<PluginsArguments>();
    const Verb verb =
        app.add_verb("plugins", "Lists effects and their parameters; tools for authors");
    verb.require_verb(0, 1);
    verb.add_option("--plugin-path", arguments->plugin_path, "Folder with more plugins").one_word();
    verb.add_flag("--json", arguments->json, "One JSON object on standard output");
    verb.fallthrough();
    const Verb list_verb = verb.add_verb("list", "One line for each effect");
    const Verb info_verb = verb.add_verb("info", "One effect with all its parameters");
    info_verb.add_option("ID", arguments->id, "Plugin").required();
    info_verb.callback([arguments] {
        info(arguments->registry().effect(arguments->id, "plugins"), arguments->json);
    });
    list_verb.callback([] {});
    add_plugin_tools(verb, arguments->plugin_path);
    verb.callback([arguments, verb, list_verb] {
        if (!verb.names_verb() || list_verb.count() > 0)
            list(arguments->registry(), arguments->json);
    });
}

}  // namespace relevo::cli
