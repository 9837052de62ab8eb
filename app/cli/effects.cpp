#include "cli/effects.h"

#include <algorithm>

#include "base/log.h"

namespace relevo::cli {

render::EffectInputs ActiveEffects::inputs() const {
    render::EffectInputs inputs;
    inputs.stitch.snippets = selection.snippets();
    inputs.stitch.capabilities = selection.capabilities;
    inputs.stitch.values = &values;
    for (const effect::Effect* effect : selection.effects) {
        const effect::Manifest& manifest = effect->manifest;
        inputs.textures.insert(inputs.textures.end(), manifest.textures.begin(),
                               manifest.textures.end());
        if (manifest.displaces) inputs.displaces.push_back(*manifest.displaces);
    }
    for (const effect::NativeModule& module : modules)
        inputs.modules.push_back(&module);
    return inputs;
}

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

/// Takes `ids` out of one list of effects and adds them to another.
void move_to(const std::vector<std::string>& ids, std::vector<std::string>& from,
             std::vector<std::string>& to) {
    for (const std::string& id : ids) {
        from.erase(std::remove(from.begin(), from.end(), id), from.end());
        if (std::find(to.begin(), to.end(), id) == to.end()) to.push_back(id);
    }
}

}  // namespace

EffectArguments EffectArguments::with(const std::vector<std::string>& ids) const {
    EffectArguments changed = *this;
    move_to(ids, changed.disable, changed.enable);
    return changed;
}

EffectArguments EffectArguments::without(const std::vector<std::string>& ids,
                                         const ActiveEffects& shown) const {
    EffectArguments changed = *this;
    changed.enable.clear();
    changed.exactly.emplace();
    for (const effect::Effect* effect : shown.selection.effects)
        changed.exactly->push_back(effect->id());
    move_to(ids, *changed.exactly, changed.disable);
    return changed;
}

std::unique_ptr<ActiveEffects> EffectArguments::active(bool aloud) const {
    auto active = std::make_unique<ActiveEffects>();
    active->registry = effect::Registry::load_installed({plugin_path.begin(), plugin_path.end()});
    std::vector<effect::Preset> loaded;
    for (const std::string& preset : presets)
        loaded.push_back(effect::load_preset(preset));
    effect::Switches switches;
    if (only_option && only_option->count() > 0) {
        switches.only.emplace();
        for (const std::string& id : only)
            if (!id.empty()) switches.only->push_back(id);
    }
    if (exactly) switches.only = exactly;
    switches.enable = enable;
    switches.disable = disable;
    effect::NativeSelection chosen = effect::select_and_load(active->registry, loaded, switches);
    active->selection = std::move(chosen.selection);
    active->modules = std::move(chosen.modules);
    std::vector<shader::Param> params = active->registry.params();
    for (const shader::Param& param : render::core_params())
        params.push_back(param);
    active->values.declare(params);
    std::vector<effect::Setting> given;
    for (const std::string& setting : settings)
        given.push_back(effect::parse_setting(setting));
    const std::vector<std::string> notices =
        effect::apply_settings(active->values, active->registry, active->selection, loaded, given);
    if (!aloud) return active;
    for (const effect::BrokenEffect& broken : active->registry.broken())
        log::warning(broken.error);
    for (const std::string& notice : active->selection.notices)
        log::info(notice);
    for (const std::string& notice : notices)
        log::info(notice);
    return active;
}

}  // namespace relevo::cli
