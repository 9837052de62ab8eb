#include "viewer/document.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"
#include "base/units.h"
#include "scene/options.h"
#include "scene/scene_words.h"
#include "session/unseen_effects.h"

namespace relevo::viewer {
std::string quoted(const std::string& word) {
    const bool plain = !word.empty() && std::ranges::all_of(word, [](unsigned char c) {
        return std::isalnum(c) ||
               std::string_view("-_./,:=+@%").find(static_cast<char>(c)) != std::string_view::npos;
    });
    if (plain) return word;
    std::string text = "'";
    for (const char c : word)
        text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

namespace {

bool is_of(const std::string& address, const std::string& of) {
    return address == of || address.starts_with(of + ".");
}

/// Options of a verb, word by word.
class CommandLine {
  public:
    explicit CommandLine(std::string verb) : text_(std::move(verb)) {}
    void word(const std::string& value) { text_ += " " + quoted(value); }
    void option(std::string_view name, const std::string& value) {
        // A value that begins with a dash would be taken for an option.
        if (value.starts_with('-'))
            text_ += fmt::format(" {}={}", name, quoted(value));
        else
            text_ += fmt::format(" {} {}", name, quoted(value));
    }
    void list(const char* name, const std::vector<std::string>& values) {
        if (!values.empty()) option(name, fmt::format("{}", fmt::join(values, ",")));
    }
    std::string take() { return std::move(text_); }

  private:
    std::string text_;
};

void add_dem(CommandLine& command, const scene::Scene& scene) {
    for (const std::string& dem : scene.dems)
        command.word(dem);
    const dem::LoadOptions& dem = scene.dem;
    if (dem.no_nodata)
        command.option("--nodata", "none");
    else if (dem.nodata)
        command.option("--nodata", fmt::format("{}", *dem.nodata));
    if (dem.bounds)
        command.option("--bounds",
                       fmt::format("{},{},{},{}", dem.bounds->west_deg, dem.bounds->south_deg,
                                   dem.bounds->east_deg, dem.bounds->north_deg));
}

void add_view(CommandLine& command, const scene::View& view) {
    const auto place = [](const scene::Standpoint& at) {
        // A millimetre, and a tenth of one on the Earth.
        return fmt::format("{:.9f},{:.9f},{:.3f}{}", degrees(at.place.lat_rad),
                           degrees(at.place.lon_rad), at.place.height_m,
                           at.above_ground ? "agl" : "");
    };
    if (view.eye) {
        command.option("--eye", place(*view.eye));
        if (view.look_at) {
            command.option("--look-at", place(*view.look_at));
        } else {
            command.option("--heading", fmt::format("{:.6f}", view.heading_deg));
            command.option("--pitch", fmt::format("{:.6f}", view.pitch_deg));
        }
    } else {
        std::string orbit = fmt::format("zoom={}", view.orbit.zoom);
        if (view.orbit.elevation_deg)
            orbit = fmt::format("el={},{}", *view.orbit.elevation_deg, orbit);
        if (view.orbit.azimuth_deg) orbit = fmt::format("az={},{}", *view.orbit.azimuth_deg, orbit);
        orbit.insert(0, view.orbit.aerial ? "aerial," : "whole,");
        command.option("--view", orbit);
    }
}

/// The options of the table that the scene has otherwise than by default.
void add_options(CommandLine& command, scene::Scene scene) {
    // A title on the command line is shown, and so is an attribution.
    if (!scene.stamps.title) scene.stamps.title_text.clear();
    if (!scene.stamps.attribution) scene.stamps.attribution_text.clear();
    const std::string fov_deg = fmt::format("{:.6g}", degrees(scene.view.fov_y_rad));
    scene.view.fov_y_rad = radians(parse_number(fov_deg).value_or(0));
    for (const scene::Option& option : scene::options()) {
        if (is_default(option, scene)) continue;
        if (option.kind == scene::Option::Kind::Flag)
            command.word(std::string(option.flag));
        else
            command.option(option.flag, text_of(option, scene));
    }
}

void add_overlay(CommandLine& command, const scene::Overlay& overlay) {
    command.option("--overlay", overlay.file);
    if (!overlay.colours.empty()) command.option("--overlay-colours", overlay.colours);
    if (overlay.range)
        command.option("--overlay-range",
                       fmt::format("{},{}", overlay.range->first, overlay.range->second));
}

void add_stamps(CommandLine& command, const scene::Stamps& stamps) {
    std::vector<std::string> words;
    for (const auto& [word, member] : scene::stamp_words())
        if (member != &scene::Stamps::legend && stamps.*member) words.emplace_back(word);
    command.list("--stamp", words);
}

}  // namespace

OverlayChoice choice_of(const scene::Overlay& overlay) {
    OverlayChoice choice{.kind = OverlayKind::File};
    choice.opacity = overlay.opacity;
    choice.lit = overlay.lit;
    choice.shadows = overlay.shadows;
    return choice;
}

scene::Scene Document::whole(const Land& land) const {
    scene::Scene result = scene;
    result.view = view_of(pose, land);
    const int decimals = utc.unix_us() % 1'000'000 == 0 ? 0 : 6;
    result.time = {.at = sun::to_iso(utc, zone, decimals), .date = "", .zone = ""};
    return result;
}

SavedView saved_view(const Document& document, const Land& land, std::string name) {
    const Pose& pose = document.pose;
    return {.name = std::move(name),
            .eye = view_of(pose, land).eye->place,
            .heading_deg = pose.heading_deg,
            .pitch_deg = pose.pitch_deg,
            .fov_y_rad = pose.fov_y_rad,
            .utc = document.utc};
}

Pose pose_of(const SavedView& view, const Land& land) {
    return {.eye_m = land.frame->to_local(
                {view.eye.lat_rad, view.eye.lon_rad, view.eye.height_m * land.exaggeration}),
            .heading_deg = view.heading_deg,
            .pitch_deg = view.pitch_deg,
            .fov_y_rad = view.fov_y_rad};
}

std::unique_ptr<EffectsModel> EffectsModel::of(const scene::Effects& effects,
                                               const effect::GroundWords& ground) {
    auto model = std::make_unique<EffectsModel>(effects);
    model->selection =
        effect::select(model->registry, model->presets, effects.switches, {}, ground);
    effect::apply_settings(model->values, model->registry, model->selection, model->presets,
                           effects.settings);
    const std::vector<const effect::Effect*>& on = model->selection.effects;
    const bool has_block = session::have_block(on);
    for (const effect::Effect* const effect : on) {
        if (!session::is_seen(*effect, false)) model->unseen_within.push_back(effect->id());
        if (!session::is_seen(*effect, has_block)) model->unseen_outside.push_back(effect->id());
    }
    return model;
}

scene::Effects switched(scene::Effects effects, const std::string& id, bool on) {
    effect::Switches& switches = effects.switches;
    const auto set = [&](std::vector<std::string>& list, bool has) {
        std::erase(list, id);
        if (has) list.push_back(id);
    };
    if (switches.only) {
        set(*switches.only, on);
        set(switches.enable, false);
    } else {
        set(switches.enable, on);
    }
    set(switches.disable, !on);
    return effects;
}

scene::Effects with_value(scene::Effects effects, const std::string& address,
                          const std::string& value) {
    effects = without_values(std::move(effects), address);
    effects.settings.push_back({address, value});
    return effects;
}

bool has_values(const scene::Effects& effects, const std::string& of) {
    return std::ranges::any_of(effects.settings, [&](const effect::Setting& setting) {
        return is_of(setting.address, of);
    });
}

scene::Effects without_values(scene::Effects effects, const std::string& of) {
    std::erase_if(effects.settings,
                  [&](const effect::Setting& setting) { return is_of(setting.address, of); });
    return effects;
}

namespace {

void add_effects(CommandLine& command, const scene::Effects& effects) {
    if (effects.switches.only)
        command.option("--only", fmt::format("{}", fmt::join(*effects.switches.only, ",")));
    command.list("--enable", effects.switches.enable);
    command.list("--disable", effects.switches.disable);
    command.list("--order", effects.switches.order);
    for (const std::string& preset : effects.presets)
        command.option("--preset", preset);
    for (const std::string& folder : effects.plugin_path)
        command.option("--plugin-path", folder);
    for (const effect::Setting& setting : effects.settings)
        command.option("--set", setting.address + "=" + setting.text);
}

void add_time(CommandLine& command, const scene::TimeSpec& time) {
    if (time.at.empty()) return;
    command.option("--time", time.at);
    if (!time.date.empty()) command.option("--date", time.date);
    if (!time.zone.empty()) command.option("--tz", time.zone);
}

/// The rest of a scene, for any verb that draws it.
void add_scene(CommandLine& command, const scene::Scene& scene) {
    if (!scene.ortho) add_view(command, scene.view);
    add_stamps(command, scene.stamps);
    add_options(command, scene);
    if (scene.overlay) add_overlay(command, *scene.overlay);
    add_effects(command, scene.effects);
    if (!scene.sheet.is_on() && (!scene.ortho || scene.resolution == 0))
        command.option("--size", fmt::format("{}x{}", scene.width_px, scene.height_px));
}

/// What moves: --motion and its options.
void add_motion(CommandLine& command, const scene::FilmJob& film) {
    std::vector<std::string> motions;
    if (film.day) motions.emplace_back("day");
    if (film.year) motions.emplace_back("year");
    if (film.orbit) motions.emplace_back("orbit");
    if (film.flight) motions.emplace_back("flight");
    command.list("--motion", motions);
    const auto number = [&](const char* flag, const std::optional<double>& value) {
        if (value) command.option(flag, fmt::format("{}", *value));
    };
    bool ease = false;
    if (film.orbit) {
        number("--turns", film.orbit->turns);
        ease = film.orbit->ease;
    }
    if (film.flight) {
        command.option("--along", film.flight->along);
        number("--above", film.flight->height_m);
        number("--look-ahead", film.flight->look_ahead_m);
        number("--speed", film.flight->speed_m_s);
        ease = film.flight->ease;
    }
    if (film.orbit && ease) command.word("--ease");
    if (film.flight && !ease) command.word("--no-ease");
    if (film.value)
        command.option("--vary", fmt::format("{}={},{}", film.value->address, film.value->from,
                                             film.value->to));
    number("--duration", film.duration_s);
    number("--fps", film.film.fps);
    if (film.film.quality) command.option("--quality", fmt::format("{}", *film.film.quality));
}

}  // namespace

std::string capture_command(const scene::Scene& scene, const std::string& output) {
    CommandLine command("relevo capture");
    add_dem(command, scene);
    add_time(command, scene.time);
    add_scene(command, scene);
    command.option("-o", output);
    return command.take();
}

std::string mesh_command(scene::Scene scene, const std::string& output, double error_m,
                         bool is_solid) {
    if (scene.holes == dem::Holes::Mark) scene.holes = dem::Holes::Fill;  // as pictures have them
    CommandLine command("relevo export mesh");
    add_dem(command, scene);
    for (const scene::Option& option : scene::options())
        if ((option.group == "DEM" || option.flag == "--holes" || option.flag == "--exaggerate") &&
            !is_default(option, scene))
            command.option(option.flag, text_of(option, scene));
    command.option("--error", fmt::format("{}", error_m));
    if (is_solid) command.option("--base", "auto");
    command.option("-o", output);
    return command.take();
}

std::string film_command(const scene::Scene& scene, const scene::FilmJob& film) {
    CommandLine command("relevo film");
    add_dem(command, scene);
    if (film.day) {
        command.option("--date", film.day->date);
        if (!film.day->zone.empty()) command.option("--tz", film.day->zone);
        command.option("--span", film.day->from + "," + film.day->to);
    } else if (film.year) {
        const scene::FilmJob::Year& year = *film.year;
        add_time(command, {fmt::format("{}-06-21T{}", year.year, year.at), "", year.zone});
    } else {
        add_time(command, scene.time);
    }
    add_motion(command, film);
    add_scene(command, scene);
    command.option("-o", film.output);
    return command.take();
}

}  // namespace relevo::viewer
