#include "session/active_effects.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/log.h"
#include "effect/instance_reader.h"
#include "effect/weather_preset.h"

namespace relevo::session {

namespace {

void say(const effect::Selection& selection) {
    for (const std::string& warning : selection.warnings)
        log::warning(warning);
    for (const std::string& notice : selection.notices)
        log::info(notice);
}

}  // namespace

InstalledEffects::InstalledEffects(const scene::Effects& effects)
    : registry(effect::Registry::load_installed(
          {effects.plugin_path.begin(), effects.plugin_path.end()})) {
    for (const std::string& preset : effects.presets)
        presets.push_back(effect::load_preset(preset));
    // The first one, so that presets and settings replace what it has.
    if (effects.weather != weather::Facts{})
        presets.insert(presets.begin(), effect::weather_preset(registry, effects.weather));
    values = defaults();
}

shader::ParamStore InstalledEffects::defaults() const {
    std::vector<shader::Param> params = registry.params();
    for (const shader::Param& param : render::core_params())
        params.push_back(param);
    shader::ParamStore store;
    store.declare(params, registry.texts());
    return store;
}

std::vector<InstalledEffects::ChosenFile> InstalledEffects::chosen_files(
    const shader::ParamStore& set) const {
    std::vector<ChosenFile> files;
    for (const shader::TextParam* text : set.texts())
        if (const std::string file = set.text(text->address); text->is_file && !file.empty())
            files.push_back({text->address, file});
    for (const effect::Effect& effect : registry.effects())
        for (const effect::RasterSpec& raster : effect.manifest.rasters) {
            if (raster.colours.empty()) continue;
            if (const std::string colours = set.text(raster.colours); scene::names_file(colours))
                files.push_back({raster.colours, colours});
        }
    return files;
}

void ActiveEffects::fit(const gl::DeviceInfo& device, bool report) {
    const std::size_t unusable = loaded.unusable.size();
    loaded = effect::select_and_load(
        registry, presets, switches, values,
        effect::TextureLimits{device.max_texture_size, device.max_volume_size,
                              device.max_array_layers},
        std::move(loaded), ground);
    if (report && loaded.unusable.size() > unusable) say(loaded.selection);
}

void ActiveEffects::take_ground(const effect::GroundWords& words, const scene::Effects& asked,
                                bool report) {
    const std::vector<std::string> said = loaded.selection.notices;
    const effect::Selection before = std::move(loaded.selection);
    ground = words;
    loaded =
        effect::select_and_load(registry, presets, switches, values, {}, std::move(loaded), ground);
    if (!report) return;
    for (const std::string& notice : loaded.selection.notices)
        if (!contains(said, notice)) log::info(notice);
    for (const effect::Setting& setting : asked.settings) {
        const std::string id = setting.address.substr(0, setting.address.find('.'));
        if (before.has(id) && !loaded.selection.has(id))
            log::info(fmt::format(
                "{} is set, but {} is off: it does not apply to this DEM; --enable {} switches "
                "it on",
                setting.address, id, id));
    }
}

std::vector<std::string> ActiveEffects::switch_off_unasked(std::string_view word) {
    std::vector<std::string> off;
    bool any = false;
    // All providers: when one is off, another one may be selected instead.
    for (const effect::Effect& effect : registry.effects()) {
        const std::string& id = effect.id();
        if (!effect.provides(word) || contains(switches.enable, id) ||
            contains(switches.disable, id) || (switches.only && contains(*switches.only, id)))
            continue;
        if (loaded.selection.has(id)) off.push_back(id);
        switches.disable.push_back(id);
        any = true;
    }
    if (!any) return off;
    loaded =
        effect::select_and_load(registry, presets, switches, values, {}, std::move(loaded), ground);
    return off;
}

render::EffectInputs ActiveEffects::inputs() const {
    render::EffectInputs inputs;
    inputs.stitch = loaded.selection.stitch_input();
    inputs.stitch.values = &values;
    inputs.stitch.constants = constants;
    if (mapped) inputs.stitch.capabilities.emplace_back("mapped");
    if (houses) inputs.stitch.capabilities.emplace_back("houses");
    for (const effect::Effect* effect : loaded.selection.effects)
        if (effect->manifest.displaces) inputs.displaces.push_back(*effect->manifest.displaces);
    for (const effect::LoadedTexture& texture : loaded.textures) {
        const auto same =
            std::ranges::find_if(inputs.textures, [&](const effect::LoadedTexture* other) {
                return other->spec.same_texels(texture.spec);
            });
        if (same == inputs.textures.end())
            inputs.textures.push_back(&texture);
        else
            inputs.stitch.same_textures.emplace(texture.spec.resource, (*same)->spec.resource);
    }
    for (const effect::Effect* effect : loaded.selection.effects)
        for (const effect::LinesSpec& spec : effect->manifest.lines) {
            const std::string text = effect->id() + '.' + spec.attribute;
            inputs.lines.push_back({spec.resource, spec.file, values.text(spec.file),
                                    values.find_text(text) ? values.text(text) : spec.attribute});
        }
    for (const effect::NativeModule& module : loaded.modules)
        inputs.modules.push_back(&module);
    return inputs;
}

void ActiveEffects::visit_files(
    const std::function<void(const std::filesystem::path&, const std::string&)>& visit) const {
    for (const effect::Preset& preset : presets)
        if (!preset.file.empty()) visit(preset.file, "the preset");
    for (const effect::Effect& effect : registry.effects()) {
        const effect::Manifest& manifest = effect.manifest;
        const std::string what = fmt::format("a file of the plugin {},", effect.id());
        visit(manifest.file, what);
        for (const std::filesystem::path& glsl : manifest.glsl)
            visit(glsl, what);
        for (const effect::TextureSpec& texture : manifest.textures)
            for (const std::filesystem::path& file : texture.files)
                visit(file, what);
        for (const std::filesystem::path& mesh : effect::mesh_files(manifest))
            visit(mesh, what);
    }
    for (const ChosenFile& chosen : chosen_files(values))
        visit(chosen.file, fmt::format("the file {},", chosen.address));
    for (const effect::NativeModule& module : loaded.modules)
        visit(module.library(), fmt::format("the module of the plugin {},", module.id()));
}

void ActiveEffects::add_inputs(FilesInUse& files) const {
    visit_files([&](const std::filesystem::path& path, const std::string& what) {
        files.add_input(path, what);
    });
}

namespace {

/// A folder, the folders in it, and the files of these: a plugin may read any of its files, and a
/// folder may become a plugin.
void add_plugins_of(const std::filesystem::path& path, std::vector<std::filesystem::path>& to) {
    const auto add = [&](const std::filesystem::path& folder, const auto& each) {
        to.push_back(folder);
        std::error_code ignored;
        for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
            each(entry);
    };
    const auto file = [&](const std::filesystem::directory_entry& entry) {
        to.push_back(entry.path());
    };
    add(path, [&](const std::filesystem::directory_entry& entry) {
        std::error_code ignored;
        if (entry.is_directory(ignored))
            add(entry.path(), file);
        else
            file(entry);
    });
}

}  // namespace

std::vector<std::filesystem::path> ActiveEffects::files_and_folders() const {
    std::vector<std::filesystem::path> all;
    for (const std::filesystem::path& path : registry.search_paths())
        add_plugins_of(path, all);
    visit_files(
        [&](const std::filesystem::path& path, const std::string&) { all.push_back(path); });
    return all;
}

std::optional<shader::ParamStore> ActiveEffects::values_with(
    const std::vector<effect::Setting>& settings, bool report) {
    shader::ParamStore changed = defaults();
    std::vector<std::string> said =
        effect::apply_settings(changed, registry, loaded.selection, presets, settings);
    for (const shader::Param* param : changed.params())
        if (param->is_static && changed.value(param->address) != values.value(param->address))
            return std::nullopt;
    for (const shader::TextParam* text : changed.texts())
        if (changed.text(text->address) != values.text(text->address)) return std::nullopt;
    for (std::string& notice : said) {
        if (contains(notices, notice)) continue;
        if (report) log::info(notice);
        notices.push_back(std::move(notice));
    }
    return changed;
}

namespace {

/// Removes `ids` from one list and appends them to another.
void move_to(const std::vector<std::string>& ids, std::vector<std::string>& from,
             std::vector<std::string>& to) {
    for (const std::string& id : ids) {
        from.erase(std::remove(from.begin(), from.end(), id), from.end());
        if (!contains(to, id)) to.push_back(id);
    }
}

}  // namespace

scene::Effects with(scene::Effects effects, const std::vector<std::string>& ids) {
    move_to(ids, effects.switches.disable, effects.switches.enable);
    return effects;
}

scene::Effects without(scene::Effects effects, const std::vector<std::string>& ids,
                       const ActiveEffects& shown) {
    // The selection of `shown` replaces the switches that were asked for.
    effect::Switches& switches = effects.switches;
    switches.enable.clear();
    switches.disable.clear();
    switches.only.emplace();
    for (const effect::Effect* effect : shown.loaded.selection.effects)
        switches.only->push_back(effect->id());
    move_to(ids, *switches.only, switches.disable);
    return effects;
}

std::unique_ptr<ActiveEffects> ActiveEffects::of(const scene::Effects& effects, bool report,
                                                 const effect::GroundWords& ground) {
    auto active = std::make_unique<ActiveEffects>(effects);
    active->ground = ground;
    active->switches = effects.switches;
    active->loaded = effect::select_and_load(active->registry, active->presets, active->switches,
                                             active->values, {}, {}, ground);
    active->notices =
        effect::apply_settings(active->values, active->registry, active->loaded.selection,
                               active->presets, effects.settings);
    // Tables are named by settings.
    active->loaded = effect::select_and_load(active->registry, active->presets, active->switches,
                                             active->values, {}, std::move(active->loaded), ground);
    if (!report) return active;
    const std::vector<std::string>& disable = effects.switches.disable;
    for (const effect::BrokenEffect& broken : active->registry.broken())
        if (!contains(disable, broken.id))
            log::warning(fmt::format("{}; --disable {} silences this", broken.error, broken.id));
    say(active->loaded.selection);
    for (const std::string& notice : active->notices)
        log::info(notice);
    return active;
}

}  // namespace relevo::session
