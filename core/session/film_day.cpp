#include "session/film_day.h"

#include <fmt/format.h>

#include "base/error.h"

namespace relevo::session {
namespace {

/// Why the span of a day does not begin before it ends; empty: it does.
std::string why_no_span(const scene::Scene& of, const scene::FilmJob::Day& day, SceneTimes& times) {
    const auto at = [&](const std::string& event) {
        scene::Scene scene = of;
        scene.time = {event, day.date, day.zone};
        return times.of(scene).utc;
    };
    try {
        if (at(day.from) < at(day.to)) return {};
        return day.date + ": the sun sets after midnight; the film shows the whole day";
    } catch (const Error& error) {
        if (error.code() != ErrorCode::BadInput) throw;
        return fmt::format("the film shows the whole day: {}", error.what());
    }
}

}  // namespace

std::string film_zone(scene::Scene scene, const std::string& date, SceneTimes& times) {
    scene.time = {"noon", date, ""};
    std::string name = times.of(scene).zone.name();
    return name.starts_with("LMT") ? "" : name;
}

FilmDay film_day(const scene::Scene& scene, const std::string& date, const std::string& zone,
                 SceneTimes& times) {
    FilmDay film{{date, zone, kFilmDayFrom, kFilmDayTo}, ""};
    if (zone.empty()) film.day.zone = film_zone(scene, date, times);
    film.note = why_no_span(scene, film.day, times);
    if (film.note.empty()) return film;
    film.day.from = "00:00";
    film.day.to = "23:59";
    return film;
}

}  // namespace relevo::session
