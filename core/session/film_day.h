#pragma once

#include <string>

#include "scene/film_job.h"
#include "session/scene_times.h"

namespace relevo::session {

/// What a film of a day shows where nobody says: from half an hour before sunrise to half an hour
/// after sunset.
inline constexpr const char* kFilmDayFrom = "sunrise-30min";
inline constexpr const char* kFilmDayTo = "sunset+30min";

struct FilmDay {
    scene::FilmJob::Day day;
    std::string note;  ///< why it is the whole day; empty: it is not
};
/// The times of a film of a day. Where the sun does not rise or set, or sets after midnight, that
/// is the whole day.
/// @param scene  whose DEM has the place
/// @param date   "2026-06-21"
/// @param zone   as TimeSpec::zone; empty: that of the place, by its name
/// @throws Error (BadInput) for a date or zone that is none
FilmDay film_day(const scene::Scene& scene, const std::string& date, const std::string& zone,
                 SceneTimes& times);

/// The zone of a film of a day where none is given: the place's by its name, so that the job says
/// it; empty where it has none.
std::string film_zone(scene::Scene scene, const std::string& date, SceneTimes& times);

}  // namespace relevo::session
