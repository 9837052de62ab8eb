#include "session/scene_inputs.h"

#include <algorithm>
#include <iterator>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/sha256.h"
#include "dem/files_of.h"
#include "dem/remote.h"
#include "dem/tile_index.h"
#include "effect/instance_reader.h"
#include "effect/native_module.h"
#include "effect/selection.h"

namespace relevo::session {
namespace {

namespace fs = std::filesystem;

/// Digits of a digest; enough against accidental collisions.
constexpr std::size_t kDigits = 32;

/// Key of the plugins and presets that effects are read from.
std::string installed_key(const scene::Effects& effects) {
    return fmt::format("{}\n\n{}", fmt::join(effects.presets, "\n"),
                       fmt::join(effects.plugin_path, "\n"));
}

/// All files below a folder, sorted: a module may read any of them.
std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        std::error_code ignored;
        if (entry->is_regular_file(ignored)) files.push_back(entry->path());
    }
    std::ranges::sort(files);
    return files;
}

std::vector<fs::path> files_of(const effect::Effect& effect) {
    const effect::Manifest& manifest = effect.manifest;
    std::vector<fs::path> files{manifest.file};
    files.insert(files.end(), manifest.glsl.begin(), manifest.glsl.end());
    for (const effect::TextureSpec& texture : manifest.textures)
        files.insert(files.end(), texture.files.begin(), texture.files.end());
    const std::vector<fs::path> meshes = effect::mesh_files(manifest);
    files.insert(files.end(), meshes.begin(), meshes.end());
    if (manifest.module.empty()) return files;
    try {
        files.push_back(effect::module_file(manifest));
    } catch (const Error&) {
        // Reported when the module is loaded.
    }
    const std::vector<fs::path> own = files_in(manifest.folder);
    files.insert(files.end(), own.begin(), own.end());
    return files;
}

/// Size and time of a file, as a substitute for its digest.
std::string stamp_of(const fs::path& file) {
    std::error_code size_error, time_error;
    const auto bytes = fs::file_size(file, size_error);
    const auto written = fs::last_write_time(file, time_error).time_since_epoch();
    return size_error || time_error ? "unreadable" : fmt::format("{} {}", bytes, written.count());
}

std::uintmax_t bytes_of(const std::vector<fs::path>& files) {
    std::uintmax_t sum = 0;
    for (const fs::path& file : files) {
        std::error_code error;
        const auto bytes = fs::file_size(file, error);
        if (!error) sum += bytes;
    }
    return sum;
}

}  // namespace

std::string effects_key(const scene::Effects& effects) {
    scene::Scene only;
    only.effects = effects;
    std::string key = scene::scene_line(only);
    // File names in settings are relative to this folder.
    for (const effect::Setting& setting : effects.settings)
        key += "\n" + setting.folder;
    return key;
}

struct SceneInputs::OfEffects {
    scene::Effects settled;
    /// Plugins that may be on; which of them are also depends on the DEM.
    std::vector<std::pair<std::string, std::vector<fs::path>>> plugins;
    std::vector<fs::path> presets, values;
    const InstalledEffects* installed = nullptr;
};

SceneInputs::SceneInputs(std::string version) : version_(std::move(version)) {}
SceneInputs::~SceneInputs() = default;

const SceneInputs::OfEffects& SceneInputs::of(const scene::Effects& effects) {
    std::unique_ptr<OfEffects>& known = effects_[effects_key(effects)];
    if (known) return *known;
    std::unique_ptr<InstalledEffects>& plugins = installed_[installed_key(effects)];
    if (!plugins) plugins = std::make_unique<InstalledEffects>(effects);
    auto fresh = std::make_unique<OfEffects>();
    fresh->installed = plugins.get();
    const effect::Selection selection =
        effect::select(plugins->registry, plugins->presets, effects.switches);
    shader::ParamStore values = plugins->values;
    effect::apply_settings(values, plugins->registry, selection, plugins->presets,
                           effects.settings);
    fresh->settled = effects;
    fresh->settled.settings =
        effect::with_absolute_files(std::move(fresh->settled.settings), plugins->values);
    for (const effect::Effect* effect : selection.effects)
        fresh->plugins.emplace_back(effect->id(), files_of(*effect));
    for (const effect::Preset& preset : plugins->presets)
        fresh->presets.emplace_back(preset.file);
    for (const InstalledEffects::ChosenFile& chosen : plugins->chosen_files(values))
        fresh->values.push_back(chosen.file);
    known = std::move(fresh);
    return *known;
}

const scene::Effects& SceneInputs::settled(const scene::Effects& effects) {
    return of(effects).settled;
}

const std::vector<fs::path>& SceneInputs::raster_files(const std::vector<std::string>& names) {
    const auto [known, fresh] = rasters_.try_emplace(names);
    // Remote files and pipes are not read again.
    std::vector<std::string> local = names;
    std::erase_if(local, [](const std::string& name) {
        return is_remote(name) || name.starts_with("/vsistdin");
    });
    if (fresh && !local.empty()) known->second = dem::files_of(local);
    return known->second;
}

SceneInputs::Key SceneInputs::key_of(const scene::Scene& scene) {
    Key key{.dems = &raster_files(scene.dems), .effects = &of(scene.effects)};
    if (!scene.forecast.empty()) key.forecast = &raster_files({scene.forecast});
    for (const scene::Layer& layer : scene::layers_of(scene))
        key.layers.emplace_back(layer.role, &raster_files({layer.raster}), layer.table);
    return key;
}

void SceneInputs::add_to(FilesInUse& files, const scene::Scene& scene) {
    if (!added_.insert(key_of(scene)).second) return;
    for (const fs::path& file : raster_files(scene.dems))
        files.add_input(file, "the DEM");
    if (!scene.weather_file.empty()) files.add_input(scene.weather_file, "the weather");
    if (!scene.forecast.empty())
        for (const fs::path& file : raster_files({scene.forecast}))
            files.add_input(file, "the weather");
    for (const scene::Layer& layer : scene::layers_of(scene)) {
        for (const fs::path& file : raster_files({layer.raster}))
            files.add_input(file, layer.role);
        if (!layer.table.empty()) files.add_input(layer.table, layer.role_of_table);
    }
    const OfEffects& effects = of(scene.effects);
    for (const fs::path& file : effects.presets)
        files.add_input(file, "the preset");
    for (const effect::Effect& effect : effects.installed->registry.effects())
        for (const fs::path& file : files_of(effect))
            files.add_input(file, fmt::format("a file of the plugin {},", effect.id()));
    for (const fs::path& file : effects.values)
        files.add_input(file, "a file of --set,");
}

const std::string& SceneInputs::sha256(const fs::path& path) {
    const auto [known, fresh] = hashes_.try_emplace(path);
    if (!fresh) return known->second;
    try {
        known->second = sha256_of_file(path, "inputs");
    } catch (const Error&) {
        known->second = "unreadable";  // reported where the digest is needed
    }
    return known->second;
}

std::string SceneInputs::digest_of_rasters(const std::vector<std::string>& names) {
    // Takes about one second to hash.
    constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 30;
    const std::vector<fs::path>& files = raster_files(names);
    const bool has_index =
        std::ranges::any_of(names, [this](const std::string& name) { return is_index(name); });
    if (!has_index && bytes_of(files) <= kMostBytes) return digest(files);
    std::string stamps;
    for (const std::string& name : names)
        if (is_index(name)) stamps += sha256(name) + "\n";
    for (const fs::path& file : files)
        if (!is_index(file.string())) stamps += stamp_of(file) + "\n";
    return sha256_of_text(stamps).substr(0, kDigits);
}

bool SceneInputs::is_index(const std::string& name) {
    if (!dem::is_index_name(name) || is_remote(name)) return false;
    const auto [known, fresh] = indexes_.try_emplace(name);
    if (fresh) known->second = dem::is_tile_index(name);
    return known->second;
}

std::string SceneInputs::digest(const std::vector<fs::path>& files) {
    std::string sums;
    for (const fs::path& file : files)
        sums += sha256(file) + "\n";
    return sha256_of_text(sums).substr(0, kDigits);
}

std::string SceneInputs::record(const scene::Scene& scene) {
    std::string& known = records_[key_of(scene)];
    if (known.empty()) known = record_of(scene);
    return known;
}

std::string SceneInputs::record_of(const scene::Scene& scene) {
    nlohmann::ordered_json json{{"relevo", version_}, {"dem", digest_of_rasters(scene.dems)}};
    if (scene.overlay) {
        json["overlay"] = digest_of_rasters({scene.overlay->file});
        if (scene::names_file(scene.overlay->colours))
            json["colours"] = digest({scene.overlay->colours});
    }
    if (!scene.forecast.empty()) json["weather"] = digest_of_rasters({scene.forecast});
    if (!scene.land_cover.file.empty()) {
        json["land_cover"] = digest_of_rasters({scene.land_cover.file});
        if (scene::names_file(scene.land_cover.classes))
            json["land_cover"] =
                json["land_cover"].get<std::string>() + digest({scene.land_cover.classes});
    }
    const OfEffects& effects = of(scene.effects);
    if (!effects.presets.empty()) json["presets"] = digest(effects.presets);
    std::string plugins;
    for (const auto& [id, files] : effects.plugins)
        plugins += id + " " + digest(files) + "\n";
    json["plugins"] = sha256_of_text(plugins).substr(0, kDigits);
    if (!effects.values.empty()) json["files"] = digest(effects.values);
    return json.dump();
}

std::vector<HashedFile> SceneInputs::hashed_dem(const scene::Scene& scene) {
    std::vector<HashedFile> result;
    std::error_code ignored;
    std::vector<fs::path> paths;
    for (const std::string& name : scene.dems)
        if (is_index(name))
            paths.emplace_back(name);  // its tiles may be a country
        else
            std::ranges::copy(raster_files({name}), std::back_inserter(paths));
    for (const fs::path& path : paths) {
        if (!fs::is_regular_file(path, ignored)) continue;
        std::string& known = hashes_[path];
        if (known.empty() || known == "unreadable") known = sha256_of_file(path, "--sidecar");
        result.push_back({path.string(), known});
    }
    return result;
}

std::vector<std::string> SceneInputs::remote_names(const scene::Scene& scene) {
    std::vector<std::string> names = scene.dems, remote;
    for (const scene::Layer& layer : scene::layers_of(scene))
        names.push_back(layer.raster);
    for (const std::string& name : names)
        if (raster_files({name}).empty()) remote.push_back(name);
    return remote;
}

}  // namespace relevo::session
