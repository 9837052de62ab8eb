#include "scene/scene_reader.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "scene/options.h"
#include "scene/panorama.h"
#include "scene/scene_words.h"
#include "sun/event_time.h"
#include "sun/zone_of_place.h"

namespace relevo::scene {
namespace {

namespace fs = std::filesystem;
using json::ObjectReader;

/// Numbers in a list of so many.
std::vector<double> numbers(const ObjectReader& object, const json::Value& value, const char* key,
                            std::size_t least, std::size_t most, const char* what) {
    std::vector<double> result;
    if (value.kind == json::Value::Kind::Array)
        for (const json::Value& item : value.items)
            if (item.kind == json::Value::Kind::Number && std::isfinite(item.number))
                result.push_back(item.number);
    if (value.kind != json::Value::Kind::Array || result.size() != value.items.size() ||
        result.size() < least || result.size() > most)
        object.fail(value.line, key,
                    fmt::format("expected {} but got {}", what, json::describe(value)));
    return result;
}

/// What `parse` refuses is the fault of a member.
template <typename Parse>
void check(const ObjectReader& object, const char* key, const Parse& parse) {
    try {
        parse();
    } catch (const Error& error) {
        const std::string_view what = error.what();
        object.fail(object.line_of(key), key, what.substr(what.find(": ") + 2));
    }
}

void set_size(Scene& scene, const glm::ivec2& size_px) {
    scene.width_px = size_px.x;
    scene.height_px = size_px.y;
}

std::string joined(std::string_view path, const char* key) {
    return path.empty() ? key : fmt::format("{}.{}", path, key);
}

}  // namespace

bool is_clock(std::string_view text) {
    const std::vector<std::string> parts = split(text, ':');
    if (parts.size() < 2 || parts.size() > 3) return false;
    return std::ranges::all_of(parts, [&](const std::string& part) {
        const bool hour = &part == &parts.front();
        return (part.size() == 2 || (hour && part.size() == 1)) &&
               part.find_first_not_of("0123456789") == std::string::npos;
    });
}

SceneReader::SceneReader(std::string_view who, std::string file, fs::path folder, Dates dates)
    : who_(who), file_(std::move(file)), folder_(std::move(folder)), dates_(dates) {}

void SceneReader::take(ObjectReader& object, std::string_view path, Scene& scene) const {
    if (const json::Value* const value = object.take("dem"))
        dem(*value, joined(path, "dem"), scene);
    if (const json::Value* const value = object.take("time"))
        time(*value, joined(path, "time"), scene.time);
    take_options(object, "", scene);
    const Panorama before = scene.view.panorama;
    if (const json::Value* const value = object.take("camera"))
        take_camera(*value, joined(path, "camera"), scene);
    if (const json::Value* const value = object.take("effects"))
        take_effects(*value, joined(path, "effects"), scene.effects);
    if (const json::Value* const value = object.take("overlay"))
        overlay(*value, joined(path, "overlay"), scene);
    if (const json::Value* const value = object.take("stamps"))
        stamps(*value, joined(path, "stamps"), scene);
    bool sized = false;
    if (const json::Value* const value = object.take("picture"))
        sized = picture(*value, joined(path, "picture"), scene);
    if (scene.view.panorama != before && scene.view.panorama != Panorama::None && !sized)
        set_size(scene, default_panorama_px(scene.view));
}

void SceneReader::take_options(ObjectReader& object, std::string_view name, Scene& scene) const {
    for (const Option& option : options()) {
        if (option.object != name) continue;
        const std::string key(option.key);
        const json::Value* const value = object.take(key);
        if (!value) continue;
        if (option.kind == Option::Kind::Text) object.string(key);
        if (option.kind == Option::Kind::Flag) object.boolean(key, false);
        if (const std::string fault = fault_of(option, *value); !fault.empty())
            object.fail(value->line, key, fault);
        if (option.key == "weather")
            check(object, "weather", [&] { option.set(scene, whole_report(*value)); });
        else
            option.set(scene, *value);
        if (option.key == "land_cover") scene.land_cover.file = beside(scene.land_cover.file);
        if (option.key == "land_cover_classes" && names_file(scene.land_cover.classes))
            scene.land_cover.classes = beside(scene.land_cover.classes);
    }
}

json::Value SceneReader::whole_report(json::Value value) const {
    std::error_code unknown;
    if (!value.text.empty() &&
        (value.text.find(' ') == std::string::npos || fs::exists(folder_ / value.text, unknown)))
        value.text = beside(value.text);
    return value;
}

ObjectReader SceneReader::inside(const json::Value& value, const std::string& path) const {
    return {who_, file_, path, value};
}

std::string SceneReader::beside(const std::string& name) const {
    if (fs::path(name).is_absolute()) return name;
    std::error_code unknown;
    const fs::path path = folder_ / name;
    const bool may_be_gdals = name.find(':') != std::string::npos;
    return may_be_gdals && !fs::exists(path, unknown) ? name : path.string();
}

void SceneReader::overlay(const json::Value& value, const std::string& path, Scene& scene) const {
    ObjectReader object = inside(value, path);
    Overlay& overlay = scene.overlay.emplace();
    overlay.file = beside(object.string("file"));
    overlay.colours = object.string("colours", "");
    if (names_file(overlay.colours)) overlay.colours = beside(overlay.colours);
    if (const json::Value* const range = object.take("range")) {
        const std::vector<double> v =
            numbers(object, *range, "range", 2, 2, "the values of the first and the last colour");
        if (!(v[1] > v[0]))
            object.fail(range->line, "range", "expected a second value over the first one");
        overlay.range = {v[0], v[1]};
    }
    take_options(object, "overlay", scene);
    object.finish();
}

void SceneReader::dem(const json::Value& value, const std::string& path, Scene& scene) const {
    ObjectReader object = inside(value, path);
    scene.dems.clear();
    scene.dem = {};
    scene.holes = {};
    for (const std::string& name : object.strings("files"))
        scene.dems.push_back(beside(name));
    if (scene.dems.empty())
        object.fail(object.line_of("files"), "files", "expected a list of DEMs");
    dem::LoadOptions& options = scene.dem;
    take_options(object, "dem", scene);
    if (const json::Value* const nodata = object.take("nodata")) {
        options.no_nodata = nodata->kind == json::Value::Kind::String && nodata->text == "none";
        if (nodata->kind == json::Value::Kind::Number)
            options.nodata = nodata->number;
        else if (!options.no_nodata)
            object.fail(
                nodata->line, "nodata",
                fmt::format("expected a number or \"none\" but got {}", json::describe(*nodata)));
    }
    if (const json::Value* const bounds = object.take("bounds")) {
        const std::vector<double> v =
            numbers(object, *bounds, "bounds", 4, 4, "west, south, east, north in degrees");
        check(object, "bounds", [&] {
            options.bounds =
                dem::parse_bounds(fmt::format("{},{},{},{}", v[0], v[1], v[2], v[3]), "bounds");
        });
    }
    object.finish();
}

void SceneReader::time(const json::Value& value, const std::string& path, TimeSpec& spec) const {
    ObjectReader object = inside(value, path);
    // A new time replaces the date, too.
    const bool timed = object.take("at") != nullptr;
    if (timed || spec.at.empty()) {
        spec.at = object.string("at");
        spec.date.clear();
    }
    spec.date = object.string("date", spec.date);
    spec.zone = object.string("zone", spec.zone);
    object.finish();
    check_time(object, spec);
}

void SceneReader::check_time(const ObjectReader& object, const TimeSpec& spec) const {
    const bool event = sun::is_event_time(spec.at);
    const bool clock = dates_ == Dates::Later && is_clock(spec.at);
    if (!spec.date.empty() && !event && !clock)
        object.fail(object.line_of("date"), "date",
                    "needs an event in time.at, such as sunset-30min");
    std::optional<sun::Zone> zone;
    std::optional<sun::Date> date;
    check(object, "zone", [&] {
        // The zone of a place needs the DEM; any zone finds the other errors.
        zone = sun::is_zone_by_place(spec.zone) ? sun::Zone() : sun::Zone::named(spec.zone);
    });
    check(object, "date", [&] {
        if (!spec.date.empty()) date = sun::parse_date(spec.date);
    });
    check(object, "at", [&] {
        if (clock) {
            sun::parse_time("2026-01-01T" + padded_clock(spec.at) + "Z");
        } else if (event) {
            const sun::EventTime parsed = sun::parse_event_time(spec.at);
            if (dates_ == Dates::Needed || date || parsed.date) sun::day_of(parsed, date, zone);
        } else if (!sun::is_zone_by_place(spec.zone) || sun::is_wall_time(spec.at)) {
            sun::parse_time(spec.at, zone);
        }
    });
}

Standpoint SceneReader::standpoint(const ObjectReader& object, const json::Value& value,
                                   const char* key, double height_agl_m) const {
    const std::vector<double> v =
        numbers(object, value, key, 2, 3, "latitude, longitude and perhaps a height");
    if (std::abs(v[0]) > 90 || std::abs(v[1]) > 360)
        object.fail(value.line, key,
                    fmt::format("expected a latitude of -90 to 90 and a longitude of -360 to "
                                "360 but got {} and {}",
                                v[0], v[1]));
    const bool has_height = v.size() == 3;
    return {geo::geodetic_deg(v[0], v[1], has_height ? v[2] : height_agl_m), !has_height};
}

void SceneReader::take_camera(const json::Value& value, const std::string& path,
                              Scene& scene) const {
    ObjectReader object = inside(value, path);
    View& view = scene.view;
    const json::Value* const orbit = object.take("orbit");
    const json::Value* const eye = object.take("eye");
    if (orbit && eye) object.fail(eye->line, "eye", "expected an orbit or an eye but got both");
    if (orbit || eye) {
        const View before = std::exchange(view, {});
        if (orbit && !before.eye) view.orbit = before.orbit;
        view.take_lens_of(before);
    }
    if (orbit) {
        ObjectReader of = inside(*orbit, path + ".orbit");
        const auto take_angle = [&](const char* key, double most, std::optional<double>& angle) {
            if (of.take(key)) angle = of.number(key, 0, -most, most, false);
        };
        take_angle("azimuth", 360, view.orbit.azimuth_deg);
        take_angle("elevation", 90, view.orbit.elevation_deg);
        view.orbit.zoom = of.number("zoom", view.orbit.zoom, kMinZoom, kMaxZoom, false);
        const bool gives_angle = of.has("azimuth") || of.has("elevation");
        view.orbit.aerial = of.boolean("aerial", view.orbit.aerial && !gives_angle);
        of.finish();
    }
    if (eye) view.eye = standpoint(object, *eye, "eye", kEyeHeight_m);
    if (view.eye) {
        view.eye->above_ground = object.boolean("eye_above_ground", view.eye->above_ground);
        if (const json::Value* const target = object.take("look_at"))
            view.look_at = standpoint(object, *target, "look_at", 0);
        if (view.look_at && !object.has("heading") && !object.has("pitch")) {
            view.look_at->above_ground =
                object.boolean("look_at_above_ground", view.look_at->above_ground);
        } else if (!object.has("look_at")) {
            view.look_at.reset();
            view.heading_deg = object.number("heading", view.heading_deg, -360, 360, false);
            view.pitch_deg = object.number("pitch", view.pitch_deg, -90, 90, false);
        }
    }
    take_options(object, "camera", scene);
    if (object.has("fov") && object.has("focal_length"))
        object.fail(object.line_of("focal_length"), "focal_length",
                    "expected it or fov but got both");
    object.finish();
}

void SceneReader::take_effects(const json::Value& value, const std::string& path,
                               Effects& effects) const {
    ObjectReader object = inside(value, path);
    Effects change;
    if (object.take("only")) change.switches.only = object.strings("only");
    change.switches.enable = object.strings("enable");
    change.switches.disable = object.strings("disable");
    change.switches.order = object.strings("order");
    for (const std::string& preset : object.strings("presets"))
        change.presets.push_back(effect::is_preset_file(preset) ? beside(preset) : preset);
    change.settings = effect::read_settings(object, "set", folder_.string());
    for (const std::string& folder : object.strings("plugin_path"))
        change.plugin_path.push_back(beside(folder));
    object.finish();
    effects = merge(std::move(effects), change);
}

void SceneReader::stamps(const json::Value& value, const std::string& path, Scene& scene) const {
    ObjectReader object = inside(value, path);
    Stamps& stamps = scene.stamps;
    take_options(object, "stamps", scene);
    if (object.take("show"))
        check(object, "show", [&] { show_stamps(object.strings("show"), "show", stamps); });
    if (stamps.attribution && stamps.attribution_text.empty())
        object.fail(object.line_of("show"), "attribution",
                    "expected the words that name the data's source, which show asks for");
    object.finish();
}

bool SceneReader::picture(const json::Value& value, const std::string& path, Scene& scene) const {
    ObjectReader object = inside(value, path);
    const json::Value* const size = object.take("size");
    if (size) {
        const std::vector<double> v =
            numbers(object, *size, "size", 2, 2, "a width and a height in pixels");
        for (const double side : v)
            if (side != std::floor(side) || side < 1 || side > kMaxSide_px)
                object.fail(size->line, "size",
                            fmt::format("expected 1 to {} but got {}", kMaxSide_px, side));
        set_size(scene, {static_cast<int>(v[0]), static_cast<int>(v[1])});
    }
    take_options(object, "picture", scene);
    object.finish();
    return size != nullptr;
}

}  // namespace relevo::scene
