#include "session/scene_state.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/log.h"
#include "geo/format.h"
#include "light/point/refraction_at.h"
#include "scene/exaggeration.h"
#include "scene/map_view.h"
#include "scene/sheet.h"
#include "scene/stereo.h"
#include "session/active_effects.h"
#include "session/climate_words.h"
#include "session/overlay.h"
#include "session/stamps.h"
#include "session/standing.h"
#include "session/words.h"
#include "sun/celestial.h"
#include "sun/eclipse.h"
#include "sun/moon.h"

namespace relevo::session {

void SceneState::take_dem(std::shared_ptr<const LoadedDem> dem) {
    dem_ = std::move(dem);
    ground_ = ground_of(*dem_);
}

void SceneState::choose_exaggeration(const LoadedDem& dem) {
    if (!std::exchange(scene.chooses_exaggeration, false)) return;
    constexpr int kLeast_px = 320;  // that words have room in
    const render::Ground ground = ground_of(dem);
    const double chosen = scene::chosen_exaggeration(dem.to_frame().height_m,
                                                     ground.north_east_m - ground.south_west_m);
    // Steeper ground needs finer tiles.
    if (chosen != 1 && scene.dem.memory.mib() < MemoryBudget::kDefault_mib) {
        log::info(
            fmt::format("heights are drawn as they are, not {:.3g} times, with a --memory "
                        "below {} MiB; --exaggerate {:.3g} draws them so",
                        chosen, MemoryBudget::kDefault_mib, chosen));
        return;
    }
    scene.exaggeration = chosen;
    scene.stamps.exaggeration = scene.exaggeration != 1 && scene.width_px >= kLeast_px;
}

void SceneState::take_shape(bool other) {
    inputs.exaggeration = scene.exaggeration;
    inputs.exposure_ev = scene.exposure_ev;
    inputs.ev100 = scene.ev100;
    inputs.seconds = scene.seconds;
    if (!other) return;
    to_show_ = render::ground_to_show(dem_->to_frame(), *ground_, scene.exaggeration);
    moved_.reset();
    day_.emplace(ground_->frame.origin(), ground_->block_m <= 0);
}

void SceneState::set_time(sun::Instant utc) {
    if (weather) weather->set_time(utc.unix_us() / 1'000'000);
    utc_ = utc;
    const geo::Geodetic place = ground_->frame.origin();
    position_ = sun::position(utc, place);
    const auto measured = weather ? weather->air : std::nullopt;
    const Air asked{
        scene.refraction, {place.lat_rad, place.lon_rad, ground_->air_height_m()}, measured};
    if (air_of_ != asked) air_ = light::refraction_at(asked.model, asked.place, measured);
    air_of_ = asked;
    inputs.sun = render::make_sun_light(position_, air_, *ground_, dem_->field.grid);
    if (air_.bends())
        inputs.sun.air = [model = scene.refraction, measured](const geo::Geodetic& at) {
            return light::refraction_at(model, at, measured);
        };
    inputs.stars = sun::celestial_frame(sun::Epoch::at(utc), place);
    const sun::MoonPosition moon = sun::moon_position(utc, place);
    inputs.moon = render::make_moon(moon, position_, inputs.stars);
    inputs.sun_visible = sun::sun_visible_fraction(position_, moon);
    inputs.sun.strength = glm::dvec3(inputs.sun_visible);
    render::choose_direct_light(inputs,
                                render::make_sun_light(moon, air_, *ground_, dem_->field.grid));
    inputs.unix_s = static_cast<double>(utc.unix_us()) * 1e-6;
}

sun::Instant SceneState::default_time() {
    if (const std::optional<sun::Instant> of_overlay = instant_of_overlay(scene)) {
        time_reason_ = fmt::format("time: {}, that of the overlay; --time sets another",
                                   sun::to_iso(*of_overlay));
        return *of_overlay;
    }
    const scene::DefaultTime chosen =
        day_->time(is_map() ? scene::kMapSide_deg : scene::side_of_deg(inputs.camera));
    time_reason_ = chosen.reason();
    return chosen.utc;
}

void SceneState::look(scene::View view, const DrawnShape& shape) {
    if (is_map()) {
        const dem::Grid& grid = dem_->source->grid();
        framing_.reset();
        inputs.in_the_air = false;
        scene.view = view;
        const glm::ivec2 size_px(scene.width_px, scene.height_px);
        const scene::Sheet& sheet = scene.sheet;
        const auto on_sheet = [&] {
            const double scale =
                sheet.scale > 0 ? sheet.scale : scene::fitting_scale(grid, sheet.dpi, size_px);
            return scene::sheet_area(grid, scale, sheet.dpi, size_px);
        };
        inputs.camera = scene::map_camera(
            grid, ground_->frame,
            sheet.is_on() ? on_sheet() : scene::map_area(grid, scene.resolution, size_px));
        return;
    }
    if (!view.eye && (!view.orbit.azimuth_deg || !view.orbit.elevation_deg)) {
        framing_ = scene::frame_ground(view.orbit, to_show_.net, to_show_.true_aerial, *day_);
        view.orbit = framing_->orbit;
    }
    const auto camera_of = [&](const scene::View& of) {
        return scene::make_camera(of, heights_to_aim_at(dem_, shape.displacement), ground_->frame,
                                  of.eye ? scene::Outline() : outline(shape),
                                  scene::view_aspect(scene), scene.exaggeration);
    };
    inputs.in_the_air =
        shape.has_air && scene::backdrop_of(scene.backdrop, view) == scene::Backdrop::Horizon;
    inputs.camera = standing(view, {ground_->frame, scene.exaggeration, shape.height_m, camera_of},
                             keep_above_m);
    scene.view = view;
}

void SceneState::warn_of_eye(const DrawnShape& shape) const {
    const std::optional<double> height_m = shape.height_m(inputs.camera);
    if (!height_m) return;  // the eye is above all ground, or outside the DEM
    const auto drawn_m = [&](const geo::Geodetic&) { return *height_m / scene.exaggeration; };
    scene::warn_of_eye_below_ground(scene.view, drawn_m, ground_->frame, scene.exaggeration);
}

scene::Outline SceneState::outline(const DrawnShape& shape) {
    scene::Outline outline{to_show_.points, moved_points(shape.displacement), to_show_.aerial};
    if (shape.shows_block) {
        const auto base = render::block_below(to_show_.rim, *ground_, scene.exaggeration);
        outline.points.insert(outline.points.end(), base.begin(), base.end());
    }
    return outline;
}

const std::vector<glm::dvec3>& SceneState::moved_points(const render::Displacement& displacement) {
    if (!moved_ || moved_->by != displacement)
        moved_ = {displacement, render::points_moved_to(to_show_.points, *ground_,
                                                        scene.exaggeration, displacement)};
    return moved_->points;
}

std::optional<geo::Geodetic> SceneState::eye() const {
    if (!scene.view.eye) return std::nullopt;
    return observer_of(ground_->frame, inputs.camera, scene.exaggeration);
}

geo::Geodetic SceneState::middle() const {
    geo::Geodetic middle = ground_->frame.origin();
    middle.height_m = middle_height_m(ground_->lowest_m, ground_->highest_m);
    return middle;
}

std::optional<double> SceneState::nearest_ground_m() const {
    const glm::dvec3& eye_m = inputs.camera.eye_m;
    if (inputs.in_the_air) {
        const glm::dvec3 low(ground_->south_west_m, scene.exaggeration * ground_->lowest_m),
            high(ground_->north_east_m, scene.exaggeration * ground_->highest_m);
        return length(eye_m - clamp(eye_m, low, high));
    }
    const std::optional<geo::Geodetic> from = eye();
    if (!from) return std::nullopt;
    const double above_m = (from->height_m - dem_->height_m(*from)) * scene.exaggeration;
    return std::isnan(above_m) ? std::nullopt : std::optional(above_m);
}

std::vector<std::string> SceneState::synthetic_detail(const ActiveEffects& effects,
                                                      glm::dvec2 post_spacing_m) const {
    std::vector<std::string> notes;
    const std::optional<double> nearest_m = nearest_ground_m();
    if (!nearest_m) return notes;
    const double pixel_rad = 2 * std::tan(inputs.camera.fov_y_rad / 2) / scene.height_px;
    const double post_m = std::sqrt(post_spacing_m.x * post_spacing_m.y);
    const double pixel_posts = *nearest_m * pixel_rad / post_m;
    for (const effect::Effect* const effect : effects.loaded.selection.effects) {
        const auto& invents = effect->manifest.invents;
        if (!invents || pixel_posts >= invents->pixel_posts || post_m < invents->post_m) continue;
        if (effects.values.value(invents->address)[0] > 0)
            notes.push_back(fmt::format("{}: {}; --set {}=0 removes it", effect->manifest.id,
                                        invents->what, invents->address));
    }
    return notes;
}

std::string SceneState::place_text() const {
    const std::optional<geo::Geodetic> from = eye();
    return from ? geo::degrees_text(*from) + " (the eye)"
                : geo::degrees_text(ground_->frame.origin());
}

std::string SceneState::sun_text() const {
    const std::optional<geo::Geodetic> from = eye();
    if (!from) return session::sun_text(position_, air_);
    return session::sun_text(sun::position(utc_, *from), refraction(*from));
}

sun::Refraction SceneState::refraction(const geo::Geodetic& place) const {
    return light::refraction_at(scene.refraction, place, weather ? weather->air : std::nullopt);
}

}  // namespace relevo::session
