#include "cli/effects.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/log.h"

namespace relevo::cli {

namespace {

void say(const effect::Selection& selection) {
    for (const std::string& warning : selection.warnings)
        log::warning(warning);
    for (const std::string& notice : selection.notices)
        log::info(notice);
}

}  // namespace

void ActiveEffects::fit(const gl::DeviceInfo& device, bool aloud) {
    const std::size_t unusable = loaded.unusable.size();
    loaded = effect::select_and_load(
        registry, presets, switches, values,
        effect::TextureLimits{device.max_texture_size, device.max_volume_size,
                              device.max_array_layers},
        std::move(loaded));
    if (aloud && loaded.unusable.size() > unusable) say(loaded.selection);
}

render::EffectInputs ActiveEffects::inputs() const {
    render::EffectInputs inputs;
    inputs.stitch.snippets = loaded.selection.snippets();
    inputs.stitch.capabilities = loaded.selection.capabilities;
    inputs.stitch.values = &values;
    for (const effect::Effect* effect : loaded.selection.effects)
        if (effect->manifest.displaces) inputs.displaces.push_back(*effect->manifest.displaces);
    for (const effect::LoadedTexture& texture : loaded.textures)
        inputs.textures.push_back(&texture);
    for (const effect::NativeModule& module : loaded.modules)
        inputs.modules.push_back(&module);
    return inputs;
}

void ActiveEffects::add_inputs(FilesInUse& files) const {
    for (const effect::Preset& preset : presets)
        files.add_input(preset.file, "the preset");
    for (const effect::Effect& effect : registry.effects()) {
        const effect::Manifest& manifest = effect.manifest;
        const std::string what = fmt::format("a file of the plugin {},", effect.id());
        files.add_input(manifest.file, what);
        for (const std::filesystem::path& glsl : manifest.glsl)
            files.add_input(glsl, what);
        for (const effect::TextureSpec& texture : manifest.textures)
            for (const std::filesystem::path& file : texture.files)
                files.add_input(file, what);
    }
    for (const shader::TextParam* text : values.texts())
        if (const std::string file = values.text(text->address); text->is_file && !file.empty())
            files.add_input(file, fmt::format("the file {},", text->address));
    for (const effect::NativeModule& module : loaded.modules)
        files.add_input(module.library(), fmt::format("the module of the plugin {},", module.id()));
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
    // What is shown says which effects are on, whatever was asked for.
    changed.enable.clear();
    changed.disable.clear();
    changed.exactly.emplace();
    for (const effect::Effect* effect : shown.loaded.selection.effects)
        changed.exactly->push_back(effect->id());
    move_to(ids, *changed.exactly, changed.disable);
    return changed;
}

std::unique_ptr<ActiveEffects> EffectArguments::active(bool aloud) const {
    auto active = std::make_unique<ActiveEffects>();
    active->registry = effect::Registry::load_installed({plugin_path.begin(), plugin_path.end()});
    for (const std::string& preset : presets)
        active->presets.push_back(effect::load_preset(preset));
    if (only_option && only_option->count() > 0) {
        active->switches.only.emplace();
        for (const std::string& id : only)
            if (!id.empty()) active->switches.only->push_back(id);
    }
    if (exactly) active->switches.only = exactly;
    active->switches.enable = enable;
    active->switches.disable = disable;
    std::vector<shader::Param> params = active->registry.params();
    for (const shader::Param& param : render::core_params())
        params.push_back(param);
    active->values.declare(params, active->registry.texts());
    active->loaded = effect::select_and_load(active->registry, active->presets, active->switches,
                                             active->values);
    std::vector<effect::Setting> given;
    for (const std::string& setting : settings)
        given.push_back(effect::parse_setting(setting));
    const std::vector<std::string> notices = effect::apply_settings(
        active->values, active->registry, active->loaded.selection, active->presets, given);
    if (!aloud) return active;
    for (const effect::BrokenEffect& broken : active->registry.broken())
        if (std::find(disable.begin(), disable.end(), broken.id) == disable.end())
            log::warning(fmt::format("{}; --disable {} leaves it out", broken.error, broken.id));
    say(active->loaded.selection);
    for (const std::string& notice : notices)
        log::info(notice);
    return active;
}

}  // namespace relevo::cli
