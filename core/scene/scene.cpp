#include "scene/scene.h"

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "effect/json.h"
#include "sun/event_time.h"
#include "sun/zone_of_place.h"

namespace relevo::scene {
namespace {

namespace fs = std::filesystem;
using effect::Json;
using effect::ObjectReader;
using nlohmann::ordered_json;

constexpr std::string_view kWho = "scene";
constexpr int kFormat = 1;

const std::vector<std::string>& refractions() {
    static const std::vector<std::string> names = {"standard", "saemundsson", "none"};
    return names;
}

const std::vector<std::string>& encodings() {
    static const std::vector<std::string> names = {"none", "terrain-rgb", "terrarium"};
    return names;
}

/// Reads a scene's file, member by member.
class SceneReader {
  public:
    explicit SceneReader(const fs::path& path)
        : file_(path.string()), folder_(path.parent_path()) {}

    Scene run() {
        const Json json = effect::parse_json(kWho, file_, read_text(file_, kWho));
        ObjectReader object(kWho, file_, "", json);
        const Json& format = object.need("format");
        if (format.kind != Json::Kind::Number || format.number != kFormat)
            object.fail(format.line, "format",
                        fmt::format("expected {}, the format that this program reads, but got {}",
                                    kFormat, effect::describe(format)));
        dem(object);
        moment(object);
        scene_.refraction = refractions()[object.choice("refraction", refractions(), 0)];
        camera(object);
        scene_.exaggeration = object.number("exaggeration", 1, 0.01, 1000, false);
        effects(object);
        overlay(object);
        picture(object);
        object.finish();
        return std::move(scene_);
    }

  private:
    ObjectReader inside(const Json& value, const char* path) const {
        return {kWho, file_, path, value};
    }

    /// A path that counts from the file's folder; what is no path of this machine stays.
    std::string beside(const std::string& name) const {
        if (fs::path(name).is_absolute()) return name;
        std::error_code unknown;
        const fs::path path = folder_ / name;
        const bool may_be_gdals = name.find(':') != std::string::npos;
        return may_be_gdals && !fs::exists(path, unknown) ? name : path.string();
    }

    /// Numbers in a list of so many.
    std::vector<double> numbers(const ObjectReader& object, const Json& value, const char* key,
                                std::size_t least, std::size_t most, const char* what) const {
        std::vector<double> result;
        if (value.kind == Json::Kind::Array)
            for (const Json& item : value.items)
                if (item.kind == Json::Kind::Number && std::isfinite(item.number))
                    result.push_back(item.number);
        if (value.kind != Json::Kind::Array || result.size() != value.items.size() ||
            result.size() < least || result.size() > most)
            object.fail(value.line, key,
                        fmt::format("expected {} but got {}", what, effect::describe(value)));
        return result;
    }

    void dem(ObjectReader& top) {
        ObjectReader object = inside(top.need("dem"), "dem");
        for (const std::string& name : object.strings("files"))
            scene_.dems.push_back(beside(name));
        if (scene_.dems.empty())
            object.fail(object.line_of("files"), "files", "expected a list of DEMs");
        dem::LoadOptions& options = scene_.dem;
        options.crs = object.string("crs", "");
        options.band =
            static_cast<int>(object.number("band", 0, 1, std::numeric_limits<int>::max(), true));
        options.unit = object.string("unit", "");
        if (const Json* const nodata = object.take("nodata")) {
            options.no_nodata = nodata->kind == Json::Kind::String && nodata->text == "none";
            if (nodata->kind == Json::Kind::Number)
                options.nodata = nodata->number;
            else if (!options.no_nodata)
                object.fail(nodata->line, "nodata",
                            fmt::format("expected a number or \"none\" but got {}",
                                        effect::describe(*nodata)));
        }
        options.encoding =
            static_cast<dem::Encoding>(object.choice("encoding", encodings(), std::size_t{0}));
        if (const Json* const bounds = object.take("bounds")) {
            const std::vector<double> v =
                numbers(object, *bounds, "bounds", 4, 4, "west, south, east, north in degrees");
            check(object, "bounds", [&] {
                options.bounds =
                    dem::parse_bounds(fmt::format("{},{},{},{}", v[0], v[1], v[2], v[3]), "bounds");
            });
        }
        if (const auto mib =
                static_cast<std::int64_t>(object.number("memory_mib", 0, 1, 1 << 20, true)))
            options.max_posts = dem::posts_in_mib(mib);
        scene_.holes = static_cast<dem::Holes>(object.choice("holes", {"fill", "cut", "mark"}, 0));
        object.finish();
    }

    void moment(ObjectReader& top) {
        const Json* const value = top.take("time");
        if (!value) return;
        ObjectReader object = inside(*value, "time");
        Moment& moment = scene_.moment;
        moment.time = object.string("at");
        moment.date = object.string("date", "");
        moment.zone = object.string("zone", "");
        object.finish();
        const bool event = sun::is_event_time(moment.time);
        if (!moment.date.empty() && !event)
            object.fail(object.line_of("date"), "date",
                        "goes with an event in time.at, such as sunset-30min");
        std::optional<sun::Zone> zone;
        std::optional<sun::Date> date;
        check(object, "zone", [&] {
            // That of a place is known with the DEM; until then any shows what is wrong otherwise.
            zone = sun::is_zone_by_place(moment.zone) ? sun::Zone() : sun::Zone::named(moment.zone);
        });
        check(object, "date", [&] {
            if (!moment.date.empty()) date = sun::parse_date(moment.date);
        });
        check(object, "at", [&] {
            if (event)
                sun::day_of(sun::parse_event_time(moment.time), date, zone);
            else if (!sun::is_zone_by_place(moment.zone) || sun::is_wall_time(moment.time))
                sun::parse_time(moment.time, zone);
        });
    }

    /// What `parse` refuses is the fault of a member.
    template <typename Parse>
    void check(const ObjectReader& object, const char* key, const Parse& parse) const {
        try {
            parse();
        } catch (const Error& error) {
            const std::string_view what = error.what();
            object.fail(object.line_of(key), key, what.substr(what.find(": ") + 2));
        }
    }

    Standpoint standpoint(const ObjectReader& object, const Json& value, const char* key,
                          double height_agl_m) const {
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

    void camera(ObjectReader& top) {
        const Json* const value = top.take("camera");
        if (!value) return;
        ObjectReader object = inside(*value, "camera");
        View& view = scene_.view;
        const Json* const orbit = object.take("orbit");
        const Json* const eye = object.take("eye");
        if (orbit && eye) object.fail(eye->line, "eye", "expected an orbit or an eye but got both");
        if (orbit) {
            ObjectReader of = inside(*orbit, "camera.orbit");
            const auto angle = [&](const char* key, double most) -> std::optional<double> {
                if (!of.take(key)) return std::nullopt;
                return of.number(key, 0, -most, most, false);
            };
            view.orbit.azimuth_deg = angle("azimuth", 360);
            view.orbit.elevation_deg = angle("elevation", 90);
            view.orbit.zoom = of.number("zoom", 1, kMinZoom, kMaxZoom, false);
            of.finish();
        }
        if (eye) {
            view.eye = standpoint(object, *eye, "eye", kEyeHeight_m);
            view.eye->above_ground = object.boolean("eye_above_ground", view.eye->above_ground);
            if (const Json* const target = object.take("look_at")) {
                view.look_at = standpoint(object, *target, "look_at", 0);
                view.look_at->above_ground =
                    object.boolean("look_at_above_ground", view.look_at->above_ground);
            } else {
                view.heading_deg = object.number("heading", 0, -360, 360, false);
                view.pitch_deg = object.number("pitch", 0, -90, 90, false);
            }
        }
        view.fov_y_rad = radians(object.number("fov", 0, 0.1, 170, false));
        view.focal_length_mm = object.number("focal_length", 0, 1, 10000, false);
        if (view.fov_y_rad > 0 && view.focal_length_mm > 0)
            object.fail(object.line_of("focal_length"), "focal_length",
                        "expected it or fov but got both");
        object.finish();
    }

    void effects(ObjectReader& top) {
        const Json* const value = top.take("effects");
        if (!value) return;
        ObjectReader object = inside(*value, "effects");
        Effects& effects = scene_.effects;
        if (object.take("only")) effects.switches.only = object.strings("only");
        effects.switches.enable = object.strings("enable");
        effects.switches.disable = object.strings("disable");
        for (const std::string& preset : object.strings("presets"))
            effects.presets.push_back(effect::is_preset_file(preset) ? beside(preset) : preset);
        effects.settings = effect::read_settings(object, "set", folder_.string());
        for (const std::string& folder : object.strings("plugin_path"))
            effects.plugin_path.push_back(beside(folder));
        object.finish();
    }

    void overlay(ObjectReader& top) {
        const Json* const value = top.take("overlay");
        if (!value) return;
        ObjectReader object = inside(*value, "overlay");
        Overlay& overlay = scene_.overlay.emplace();
        overlay.file = beside(object.string("file"));
        overlay.band =
            static_cast<int>(object.number("band", 1, 1, std::numeric_limits<int>::max(), true));
        overlay.colours = object.string("colours", "");
        if (overlay.colours.find_first_of("/.") != std::string::npos)
            overlay.colours = beside(overlay.colours);
        if (const Json* const range = object.take("range")) {
            const std::vector<double> v = numbers(object, *range, "range", 2, 2,
                                                  "the values of the first and the last colour");
            if (!(v[1] > v[0]))
                object.fail(range->line, "range", "expected a second value over the first one");
            overlay.range = {v[0], v[1]};
        }
        overlay.opacity = object.number("opacity", 1, 0, 1, false);
        overlay.title = object.string("title", "");
        object.finish();
    }

    void picture(ObjectReader& top) {
        const Json* const value = top.take("picture");
        if (!value) return;
        ObjectReader object = inside(*value, "picture");
        if (const Json* const size = object.take("size")) {
            const std::vector<double> v =
                numbers(object, *size, "size", 2, 2, "a width and a height in pixels");
            for (const double side : v)
                if (side != std::floor(side) || side < 1 || side > kMaxSide_px)
                    object.fail(size->line, "size",
                                fmt::format("expected 1 to {} but got {}", kMaxSide_px, side));
            scene_.width_px = static_cast<int>(v[0]);
            scene_.height_px = static_cast<int>(v[1]);
        }
        scene_.exposure_ev = object.number("exposure", 0, -20, 20, false);
        scene_.pixel_error = object.number("pixel_error", scene_.pixel_error, 0, 100, false);
        object.finish();
    }

    std::string file_;
    fs::path folder_;
    Scene scene_;
};

/// A path as a file in `folder` names it.
std::string from_folder(const std::string& name, const fs::path& folder) {
    std::error_code unknown;
    if (!fs::exists(name, unknown)) return name;
    const fs::path whole = fs::weakly_canonical(name, unknown);
    const fs::path base = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, unknown);
    const fs::path below = whole.lexically_relative(base);
    return below.empty() || *below.begin() == ".." ? whole.string() : below.string();
}

/// An angle as people gave it, to a hundredth of a millimetre on the Earth.
double written_deg(double angle_rad) {
    return std::round(degrees(angle_rad) * 1e10) / 1e10;
}

ordered_json json_of(const Standpoint& at) {
    return {written_deg(at.place.lat_rad), written_deg(at.place.lon_rad), at.place.height_m};
}

ordered_json dem_json(const Scene& scene, const fs::path& folder) {
    const dem::LoadOptions& options = scene.dem;
    ordered_json json;
    json["files"] = ordered_json::array();
    for (const std::string& name : scene.dems)
        json["files"].push_back(from_folder(name, folder));
    if (!options.crs.empty()) json["crs"] = options.crs;
    if (options.band > 0) json["band"] = options.band;
    if (!options.unit.empty()) json["unit"] = options.unit;
    if (options.nodata) json["nodata"] = *options.nodata;
    if (options.no_nodata) json["nodata"] = "none";
    if (options.encoding != dem::Encoding::None)
        json["encoding"] = encodings()[static_cast<std::size_t>(options.encoding)];
    if (options.bounds) {
        const dem::Bounds& b = *options.bounds;
        json["bounds"] = {b.west_deg, b.south_deg, b.east_deg, b.north_deg};
    }
    if (options.max_posts != dem::LoadOptions{}.max_posts)
        json["memory_mib"] = dem::mib_of_posts(options.max_posts);
    if (scene.holes != dem::Holes::Fill) json["holes"] = dem::name_of(scene.holes);
    return json;
}

ordered_json camera_json(const View& view) {
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
    }
    if (view.fov_y_rad > 0)
        json["fov"] = written_deg(view.fov_y_rad);
    else if (view.focal_length_mm > 0)
        json["focal_length"] = view.focal_length_mm;
    return json;
}

ordered_json effects_json(const Effects& effects, const fs::path& folder) {
    ordered_json json = ordered_json::object();
    if (effects.switches.only) json["only"] = *effects.switches.only;
    if (!effects.switches.enable.empty()) json["enable"] = effects.switches.enable;
    if (!effects.switches.disable.empty()) json["disable"] = effects.switches.disable;
    for (const std::string& preset : effects.presets)
        json["presets"].push_back(effect::is_preset_file(preset) ? from_folder(preset, folder)
                                                                 : preset);
    for (const effect::Setting& setting : effects.settings)
        json["set"][setting.address] = setting.text;
    for (const std::string& path : effects.plugin_path)
        json["plugin_path"].push_back(from_folder(path, folder));
    return json;
}

ordered_json overlay_json(const Overlay& overlay, const fs::path& folder) {
    ordered_json json;
    json["file"] = from_folder(overlay.file, folder);
    json["band"] = overlay.band;
    if (!overlay.colours.empty()) json["colours"] = from_folder(overlay.colours, folder);
    if (overlay.range) json["range"] = {overlay.range->first, overlay.range->second};
    json["opacity"] = overlay.opacity;
    if (!overlay.title.empty()) json["title"] = overlay.title;
    return json;
}

}  // namespace

Scene read_scene(const fs::path& path) {
    return SceneReader(path).run();
}

std::string scene_text(const Scene& scene, const fs::path& folder) {
    ordered_json json;
    json["format"] = kFormat;
    json["dem"] = dem_json(scene, folder);
    if (!scene.moment.time.empty()) {
        json["time"]["at"] = scene.moment.time;
        if (!scene.moment.date.empty()) json["time"]["date"] = scene.moment.date;
        if (!scene.moment.zone.empty()) json["time"]["zone"] = scene.moment.zone;
    }
    json["refraction"] = scene.refraction;
    json["camera"] = camera_json(scene.view);
    json["exaggeration"] = scene.exaggeration;
    json["effects"] = effects_json(scene.effects, folder);
    if (scene.overlay) json["overlay"] = overlay_json(*scene.overlay, folder);
    json["picture"] = {{"size", {scene.width_px, scene.height_px}},
                       {"exposure", scene.exposure_ev},
                       {"pixel_error", scene.pixel_error}};
    return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace relevo::scene
