#include "scene/scene.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/contains.h"
#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "json/object_reader.h"
#include "scene/options.h"
#include "scene/scene_reader.h"
#include "scene/scene_words.h"

namespace relevo::scene {
namespace {

namespace fs = std::filesystem;
using json::ObjectReader;
using nlohmann::ordered_json;

constexpr std::string_view kSceneWho = "scene";
constexpr int kFormat = 1;

/// Instead of a folder, which no folder is called: names are written as they are.
constexpr std::string_view kAsTheyAre = "//as they are";

/// A path as a file in `folder` names it.
std::string from_folder(const std::string& name, const fs::path& folder) {
    if (folder.native() == kAsTheyAre) return name;
    std::error_code unknown;
    if (!fs::exists(name, unknown)) return name;
    const fs::path whole = fs::weakly_canonical(name, unknown);
    const fs::path base = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, unknown);
    const fs::path below = whole.lexically_relative(base);
    return below.empty() || *below.begin() == ".." ? whole.string() : below.string();
}

/// The same of a file where a bare name is something else: "./viridis".
std::string path_from_folder(const std::string& path, const fs::path& folder) {
    std::string name = from_folder(path, folder);
    return name.find_first_of("/.") == std::string::npos ? "./" + name : name;
}

ordered_json json_of(const Standpoint& at) {
    return {written_deg(at.place.lat_rad), written_deg(at.place.lon_rad), at.place.height_m};
}

enum class Defaults { Written, Skipped };

/// Adds the options that the table has for an object.
void add_options(const Scene& scene, std::string_view object, Defaults defaults,
                 ordered_json& json) {
    for (const Option& option : options()) {
        if (option.object != object || text_of(option, scene).empty()) continue;
        if (defaults == Defaults::Skipped && is_default(option, scene)) continue;
        const json::Value value = option.get(scene);
        ordered_json& member = json[std::string(option.key)];
        if (option.kind == Option::Kind::Number)
            member = value.number;
        else if (option.kind == Option::Kind::Whole)
            member = static_cast<std::int64_t>(value.number);
        else if (option.kind == Option::Kind::Flag)
            member = value.boolean;
        else
            member = value.text;
    }
}

ordered_json dem_json(const Scene& scene, const fs::path& folder) {
    const dem::LoadOptions& options = scene.dem;
    ordered_json json;
    json["files"] = ordered_json::array();
    for (const std::string& name : scene.dems)
        json["files"].push_back(from_folder(name, folder));
    add_options(scene, "dem", Defaults::Skipped, json);
    if (options.nodata) json["nodata"] = *options.nodata;
    if (options.no_nodata) json["nodata"] = "none";
    if (options.bounds) {
        const dem::Bounds& b = *options.bounds;
        json["bounds"] = {b.west_deg, b.south_deg, b.east_deg, b.north_deg};
    }
    return json;
}

ordered_json camera_json(const Scene& scene) {
    const View& view = scene.view;
    ordered_json json;
    if (view.eye) {
        json["eye"] = json_of(*view.eye);
        json["eye_above_ground"] = view.eye->above_ground;
        if (view.look_at) {
            json["look_at"] = json_of(*view.look_at);
            json["look_at_above_ground"] = view.look_at->above_ground;
        } else {
            json["heading"] = view.heading_deg;
            json["pitch"] = view.pitch_deg;
        }
    } else {
        if (view.orbit.azimuth_deg) json["orbit"]["azimuth"] = *view.orbit.azimuth_deg;
        if (view.orbit.elevation_deg) json["orbit"]["elevation"] = *view.orbit.elevation_deg;
        json["orbit"]["zoom"] = view.orbit.zoom;
        const bool has_angle = view.orbit.azimuth_deg || view.orbit.elevation_deg;
        if (view.orbit.aerial == has_angle) json["orbit"]["aerial"] = view.orbit.aerial;
    }
    add_options(scene, "camera", Defaults::Skipped, json);
    return json;
}

ordered_json effects_json(const Effects& effects, const fs::path& folder) {
    ordered_json json = ordered_json::object();
    if (effects.switches.only) json["only"] = *effects.switches.only;
    if (!effects.switches.enable.empty()) json["enable"] = effects.switches.enable;
    if (!effects.switches.disable.empty()) json["disable"] = effects.switches.disable;
    if (!effects.switches.order.empty()) json["order"] = effects.switches.order;
    for (const std::string& preset : effects.presets)
        json["presets"].push_back(effect::is_preset_file(preset) ? path_from_folder(preset, folder)
                                                                 : preset);
    for (const effect::Setting& setting : effects.settings)
        json["set"][setting.address] = setting.text;
    for (const std::string& path : effects.plugin_path)
        json["plugin_path"].push_back(from_folder(path, folder));
    return json;
}

ordered_json overlay_json(const Scene& scene, const fs::path& folder) {
    const Overlay& overlay = *scene.overlay;
    ordered_json json;
    json["file"] = from_folder(overlay.file, folder);
    add_options(scene, "overlay", Defaults::Written, json);
    if (!overlay.colours.empty())
        json["colours"] = names_file(overlay.colours) ? path_from_folder(overlay.colours, folder)
                                                      : overlay.colours;
    if (overlay.range) json["range"] = {overlay.range->first, overlay.range->second};
    return json;
}

ordered_json stamps_json(const Scene& scene) {
    ordered_json json;
    json["show"] = ordered_json::array();
    for (const auto& [word, member] : stamp_words())
        if (scene.stamps.*member) json["show"].push_back(word);
    add_options(scene, "stamps", Defaults::Written, json);
    return json;
}

ordered_json json_of(const Scene& scene, const fs::path& folder) {
    ordered_json json;
    json["format"] = kFormat;
    json["dem"] = dem_json(scene, folder);
    if (!scene.time.at.empty()) {
        json["time"]["at"] = scene.time.at;
        if (!scene.time.date.empty()) json["time"]["date"] = scene.time.date;
        if (!scene.time.zone.empty()) json["time"]["zone"] = scene.time.zone;
    }
    json["refraction"];  // before the camera: --resume compares texts with those of older files
    json["camera"] = camera_json(scene);
    add_options(scene, "", Defaults::Written, json);
    if (!scene.forecast.empty()) json["weather"] = from_folder(scene.forecast, folder);
    if (!scene.land_cover.file.empty())
        json["land_cover"] = from_folder(scene.land_cover.file, folder);
    if (names_file(scene.land_cover.classes))
        json["land_cover_classes"] = from_folder(scene.land_cover.classes, folder);
    json["effects"] = effects_json(scene.effects, folder);
    if (scene.overlay) json["overlay"] = overlay_json(scene, folder);
    if (scene.stamps != Stamps()) json["stamps"] = stamps_json(scene);
    json["picture"]["size"] = {scene.width_px, scene.height_px};
    add_options(scene, "picture", Defaults::Written, json["picture"]);
    return json;
}

std::string text_of(const ordered_json& json, int indent) {
    return json.dump(indent, ' ', false, ordered_json::error_handler_t::replace);
}

void remove(const std::vector<std::string>& ids, std::vector<std::string>& from) {
    for (const std::string& id : ids)
        from.erase(std::remove(from.begin(), from.end(), id), from.end());
}

void add(const std::vector<std::string>& ids, std::vector<std::string>& to) {
    for (const std::string& id : ids)
        if (!contains(to, id)) to.push_back(id);
}

}  // namespace

double written_deg(double angle_rad) {
    const double short_deg = std::round(degrees(angle_rad) * 1e10) / 1e10;
    if (radians(short_deg) == angle_rad) return short_deg;
    const double near_deg = degrees(angle_rad);
    for (const double towards : {near_deg, near_deg - 1, near_deg + 1}) {
        double other_deg = near_deg;
        for (int i = 0; i < 4; ++i, other_deg = std::nextafter(other_deg, towards))
            if (radians(other_deg) == angle_rad) return other_deg;
    }
    return short_deg;
}

const std::vector<std::pair<std::string_view, bool Stamps::*>>& stamp_words() {
    static const std::vector<std::pair<std::string_view, bool Stamps::*>> words = {
        {"title", &Stamps::title},
        {"scale", &Stamps::scale},
        {"north", &Stamps::north},
        {"graticule", &Stamps::graticule},
        {"date", &Stamps::date},
        {"sun", &Stamps::sun},
        {"exaggeration", &Stamps::exaggeration},
        {"attribution", &Stamps::attribution}};
    return words;
}

void show_stamps(const std::vector<std::string>& words, std::string_view who, Stamps& stamps) {
    for (const auto& [word, member] : stamp_words())
        stamps.*member = false;
    for (const std::string& asked : words) {
        bool known = asked == "none" && words.size() == 1;
        if (asked == "legend") known = stamps.legend = true;
        for (const auto& [word, member] : stamp_words())
            if (asked == word || asked == "all") known = stamps.*member = true;
        if (known) continue;
        std::vector<std::string_view> all;
        for (const auto& [word, member] : stamp_words())
            all.push_back(word);
        bad_input(fmt::format("{}: {}: expected all, none, or words of legend, {}", who,
                              printable(asked), fmt::join(all, ", ")));
    }
    const bool all = contains(words, "all");
    if (all && stamps.attribution_text.empty()) stamps.attribution = false;
}

std::string padded_clock(const std::string& clock) {
    return clock.find(':') == 1 ? "0" + clock : clock;
}

Effects merge(Effects effects, const Effects& change) {
    effect::Switches& switches = effects.switches;
    if (change.switches.only) {
        switches = {.only = change.switches.only, .order = std::move(switches.order)};
    } else if (switches.only) {
        remove(change.switches.disable, *switches.only);
    }
    // What a change has both on and off is an error that the selection finds.
    remove(change.switches.enable, switches.disable);
    remove(change.switches.disable, switches.enable);
    add(change.switches.enable, switches.enable);
    add(change.switches.disable, switches.disable);
    if (!change.switches.order.empty()) switches.order = change.switches.order;
    if (!change.presets.empty()) effects.presets = change.presets;
    for (const effect::Setting& setting : change.settings) {
        std::erase_if(effects.settings, [&](const effect::Setting& other) {
            return other.address == setting.address;
        });
        effects.settings.push_back(setting);
    }
    add(change.plugin_path, effects.plugin_path);
    return effects;
}

Scene read_scene(const fs::path& path) {
    return read_scene_text(read_text(path, kSceneWho), path.string(), path.parent_path());
}

Scene read_scene_text(const std::string& text, const std::string& file, const fs::path& folder) {
    const json::Value root = json::parse(kSceneWho, file, text);
    ObjectReader object(kSceneWho, file, "", root);
    const json::Value& format = object.need("format");
    if (format.kind != json::Value::Kind::Number || format.number != kFormat)
        object.fail(format.line, "format",
                    fmt::format("expected {}, the format that this program reads, but got {}",
                                kFormat, json::describe(format)));
    object.need("dem");
    object.string("$schema", "");  // which editors look for
    Scene scene;
    SceneReader(kSceneWho, file, folder).take(object, "", scene);
    object.finish();
    return scene;
}

std::string scene_text(const Scene& scene, const fs::path& folder) {
    return text_of(json_of(scene, folder), 2) + "\n";
}

bool names_file(std::string_view name_or_path) {
    return name_or_path.find_first_of("/.") != std::string_view::npos;
}

std::vector<Layer> layers_of(const Scene& scene) {
    const auto file = [](const std::string& table) { return names_file(table) ? table : ""; };
    std::vector<Layer> layers;
    if (const LandCover& cover = scene.land_cover; !cover.file.empty())
        layers.push_back({cover.file, file(cover.classes), "the land cover", "the classes"});
    if (const std::optional<Overlay>& overlay = scene.overlay)
        layers.push_back({overlay->file, file(overlay->colours), "the overlay", "the colours"});
    return layers;
}

std::string scene_line(const Scene& scene) {
    return whole_scene_line(with_absolute_paths(scene));
}

std::string whole_scene_line(const Scene& scene) {
    return text_of(json_of(scene, kAsTheyAre), -1);
}

Scene with_absolute_paths(Scene scene) {
    const auto whole = [](std::string& name) {
        std::error_code unknown;
        if (fs::exists(name, unknown)) name = fs::weakly_canonical(name, unknown).string();
    };
    for (std::string& name : scene.dems)
        whole(name);
    whole(scene.forecast);
    whole(scene.land_cover.file);
    if (names_file(scene.land_cover.classes)) whole(scene.land_cover.classes);
    if (scene.overlay) {
        whole(scene.overlay->file);
        if (names_file(scene.overlay->colours)) whole(scene.overlay->colours);
    }
    for (std::string& preset : scene.effects.presets)
        if (effect::is_preset_file(preset)) whole(preset);
    for (std::string& folder : scene.effects.plugin_path)
        whole(folder);
    return scene;
}

}  // namespace relevo::scene
