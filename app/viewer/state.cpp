#include "viewer/state.h"

#include <cmath>
#include <utility>

#include "base/error.h"
#include "light/point/refraction_at.h"
#include "session/words.h"

namespace relevo::viewer {
void State::stand_on(const render::Ground& ground) {
    centre = ground.frame.origin();
    air = light::refraction_at(document.scene.refraction,
                               {centre.lat_rad, centre.lon_rad, ground.air_height_m()});
    day = {};
}

void State::use_dem_of(const Opened& opened) {
    const session::LoadedDem& dem = *opened.dem;
    land.frame = &opened.ground.frame;
    land.exaggeration = opened.scene.exaggeration;
    land.height_m = [dem = opened.dem](const geo::Geodetic& at) { return dem->height_m(at); };
    land.aim_m = opened.aim_m;
    is_preview = dem.is_preview;
    const dem::Grid& grid = is_preview ? dem.source->grid() : dem.field.grid;
    const glm::dvec2 sides_m = grid.post_spacing_m();
    spacing_m = std::sqrt(sides_m.x * sides_m.y);
    stand_on(opened.ground);
    ground_words = dem.ground_words(opened.scene.holes);
    effects = EffectsModel::of(document.scene.effects, ground_words);
}

void State::set_utc(sun::Instant utc) {
    const sun::Date date = document.zone.local(utc).wall.date;
    if (date.year < 1900 || date.year > 2100) return;
    document.utc = utc;
    if (day.date == date && !day.points.empty()) return;
    if (day.date.year != date.year || day.points.empty())
        extremes = {SunDay::of({date.year, 6, 21}, document.zone, centre, air),
                    SunDay::of({date.year, 12, 21}, document.zone, centre, air)};
    day = SunDay::of(date, document.zone, centre, air);
    moon.reset();
}

void State::set_date(sun::Date date) {
    const int minute = DayMinute::of(document.utc, document.zone).minute;
    set_utc(DayMinute{date, minute}.utc(document.zone));
}

void State::set_value(const shader::Param& param, const std::string& text) {
    effects->values.set(param.address, text);
    document.scene.effects = with_value(std::move(document.scene.effects), param.address, text);
    if (param.is_static || param.type == shader::ParamType::Bool || !param.words.empty())
        step = true;
}

void State::take_effects(bool is_step) {
    if (!asked_effects) return;
    const scene::Effects changed = *std::exchange(asked_effects, std::nullopt);
    try {
        effects = EffectsModel::of(changed, ground_words);
        document.scene.effects = changed;
        step = step || is_step;
    } catch (const Error& error) {
        message = error.what();
    }
}

void State::restore(const Document& restored) {
    if (restored.zone.name() != document.zone.name()) day = {};
    const bool changes_effects = restored.scene.effects != document.scene.effects;
    document = restored;
    // Until the ground is drawn anew it has the exaggeration that it has now.
    document.pose =
        exaggerated(restored.pose, land, restored.scene.exaggeration, land.exaggeration);
    set_utc(restored.utc);
    if (!changes_effects) return;
    set_effects(restored.scene.effects);
    take_effects(/*is_step=*/false);
}

}  // namespace relevo::viewer
