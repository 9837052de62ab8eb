#include "cli/effects.h"

#include <algorithm>

#include "effect/preset.h"

namespace relevo::cli {

void EffectArguments::add_to(CLI::App& verb) {
    only_option =
        verb.add_option("--only", only, "These effects and no others (an empty list: none)")
            ->delimiter(',')
            ->expected(0, CLI::detail::expected_max_vector_size)
            ->group("Effects");
    verb.add_option("--enable", enable, "Effects to switch on")->delimiter(',')->group("Effects");
    verb.add_option("--disable", disable, "Effects to switch off")
        ->delimiter(',')
        ->group("Effects");
    verb.add_option("--set", settings, "Value of a parameter: layering.texture_m=8")
        ->allow_extra_args(false)
        ->group("Effects");
    verb.add_option("--preset", presets, "File of switches and values, by name or path: paper")
        ->allow_extra_args(false)
        ->group("Effects");
    verb.add_option("--plugin-path", plugin_path, "Folder of further plugins")
        ->allow_extra_args(false)
        ->group("Effects");
}

namespace {

void remove(const std::vector<std::string>& ids, std::vector<std::string>& from) {
    for (const std::string& id : ids)
        from.erase(std::remove(from.begin(), from.end(), id), from.end());
}

}  // namespace

void EffectArguments::apply_to(scene::Effects& effects) const {
    effect::Switches& switches = effects.switches;
    if (only_option && only_option->count() > 0) {
        switches = {};
        switches.only.emplace();
        for (const std::string& id : only)
            if (!id.empty()) switches.only->push_back(id);
    } else if (switches.only) {
        remove(disable, *switches.only);
    }
    // What the command line has both on and off is an error that the selection finds.
    remove(enable, switches.disable);
    remove(disable, switches.enable);
    switches.enable.insert(switches.enable.end(), enable.begin(), enable.end());
    switches.disable.insert(switches.disable.end(), disable.begin(), disable.end());
    if (!presets.empty()) effects.presets = presets;
    for (const std::string& setting : settings)
        effects.settings.push_back(effect::parse_setting(setting));
    effects.plugin_path.insert(effects.plugin_path.end(), plugin_path.begin(), plugin_path.end());
}

}  // namespace relevo::cli
