#include "viewer/film_choice.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "scene/name_template.h"
#include "session/film_day.h"
#include "viewer/export.h"
#include "viewer/export_choice.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

/// The angles of a view of the whole DEM from where a camera stands.
scene::View around_dem(const scene::View& view) {
    scene::View orbit;
    orbit.orbit.aerial = false;
    orbit.orbit.azimuth_deg = std::remainder(view.heading_deg + 180, 360.0);
    orbit.orbit.elevation_deg = std::clamp(-view.pitch_deg, 10.0, 80.0);
    orbit.fov_y_rad = view.fov_y_rad;
    return orbit;
}

/// A scene on one line, with another view.
std::string line_of(scene::Scene scene, const scene::View& view) {
    scene.view = view;
    return scene::scene_line(scene);
}

scene::FilmJob::Flight flight_of(const FilmWish& wish) {
    const FilmChoice& choice = wish.choice;
    scene::FilmJob::Flight flight;
    flight.ease = choice.ease;
    if (choice.camera == FilmChoice::Camera::Views) {
        flight.views = wish.views;
        return flight;
    }
    flight.along = choice.track;
    flight.height_m = choice.height_m;
    if (choice.look_ahead_m > 0) flight.look_ahead_m = choice.look_ahead_m;
    if (choice.can_have_speed() && choice.speed_m_s > 0) flight.speed_m_s = choice.speed_m_s;
    return flight;
}

/// The year of a film at the hour that the sun's clock shows now: clocks of the place are changed
/// in spring.
scene::FilmJob::Year year_of(const FilmWish& wish, session::SceneTimes& times) {
    const int year = wish.zone.local(wish.utc).wall.date.year;
    scene::Scene noon = wish.scene;
    noon.time = {"noon", fmt::format("{}-06-21", year), "solar"};
    const sun::CivilTime wall = times.of(noon).zone.local(wish.utc).wall;
    return {
        .year = year, .at = fmt::format("{:02}:{:02}", wall.hour, wall.minute), .zone = "solar"};
}

std::string output_of(const FilmWish& wish) {
    const std::string dem = std::filesystem::path(wish.scene.dems.front()).stem().string();
    const std::string stem =
        scene::NameTemplate(wish.file.name, {})
            .name({.number = 1, .dem = dem, .utc = wish.utc, .zone = wish.zone});
    return free_name(path_in(wish.folder, stem), wish.file.ending);
}

}  // namespace

const std::vector<FilmPreset>& film_presets() {
    using Time = FilmChoice::Time;
    using Camera = FilmChoice::Camera;
    static const std::vector<FilmPreset> kPresets = {
        {tr_later("A day in 10 s"), {}},
        {tr_later("A year in 12 s, at this hour"), {.time = Time::Year, .duration_s = 12}},
        {tr_later("Once around in 12 s"),
         {.time = Time::Still, .camera = Camera::AroundMiddle, .duration_s = 12}},
        {tr_later("A day, half-way around"),
         {.camera = Camera::AroundMiddle, .turns = 0.5, .duration_s = 15}},
        {tr_later("Through the saved views in 15 s"),
         {.time = Time::Still, .camera = Camera::Views, .ease = true, .duration_s = 15}},
        {tr_later("Along a track in 30 s"),
         {.time = Time::Still, .camera = Camera::Track, .ease = true, .duration_s = 30}}};
    return kPresets;
}

bool FilmWish::operator==(const FilmWish& other) const {
    const auto same = [](const scene::View& a, const scene::View& b) {
        return line_of({}, a) == line_of({}, b);
    };
    return utc == other.utc && zone.name() == other.zone.name() && choice == other.choice &&
           file == other.file && folder == other.folder &&
           std::ranges::equal(views, other.views, same) &&
           line_of(scene, scene.view) == line_of(other.scene, other.scene.view);
}

std::string film_problem(const FilmChoice& choice, std::size_t saved_views) {
    using Camera = FilmChoice::Camera;
    if (choice.time == FilmChoice::Time::Still && choice.camera == Camera::Still &&
        choice.value.empty())
        return tr("nothing moves: choose what the time, the camera or a parameter does");
    if (choice.camera == Camera::Views && saved_views < 2)
        return saved_views == 0 ? tr("a flight needs two saved views or more, this DEM has none; "
                                     "go to a view and press B")
                                : tr("a flight needs two saved views or more, this DEM has one; go "
                                     "to a view and press B");
    if (choice.camera == Camera::Track && choice.track.empty())
        return tr("a flight along a track needs its file: GPX, CSV or GeoJSON");
    if (!choice.value.empty() && choice.from == choice.to)
        return tr_format("{}: does not change, its first and last value are equal", choice.value);
    return {};
}

scene::Scene film_scene(const FilmWish& wish) {
    scene::Scene scene = wish.scene;
    scene.width_px = wish.file.size_px.x;
    scene.height_px = wish.file.size_px.y;
    scene.samples = wish.file.samples;
    scene.transparent = false;
    scene.stamps.margin = false;  // its size could differ from frame to frame
    scene.stamps.date = scene.stamps.date || wish.file.has_date;
    if (const std::string& zone = wish.zone.name(); !zone.starts_with("LMT"))
        scene.time.zone = zone;  // so that the job says it
    if (wish.choice.camera == FilmChoice::Camera::AroundDem) scene.view = around_dem(scene.view);
    return scene;
}

scene::FilmJob film_job(const FilmWish& wish, session::SceneTimes& times, std::string& note) {
    const FilmChoice& choice = wish.choice;
    scene::FilmJob job{.film = {.fps = choice.fps, .quality = {}, .loop = {}},
                       .duration_s = choice.duration_s,
                       .output = output_of(wish)};
    if (wish.file.has_quality()) job.film.quality = wish.file.quality;
    film::check(job.output, wish.file.size_px.x, wish.file.size_px.y, job.film);
    const sun::Date date = wish.zone.local(wish.utc).wall.date;
    const std::string zone = wish.zone.name().starts_with("LMT") ? "solar" : wish.zone.name();
    if (choice.time == FilmChoice::Time::Day) {
        session::FilmDay day = session::film_day(wish.scene, sun::to_string(date), zone, times);
        job.day = std::move(day.day);
        note = std::move(day.note);
    }
    if (choice.time == FilmChoice::Time::Year) job.year = year_of(wish, times);
    if (choice.is_orbit()) job.orbit = {choice.turns, choice.ease};
    if (choice.is_flight()) job.flight = flight_of(wish);
    if (!choice.value.empty()) job.value = {choice.value, choice.from, choice.to};
    return job;
}

}  // namespace relevo::viewer
