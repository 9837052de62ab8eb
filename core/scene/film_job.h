#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "film/film.h"
#include "scene/scene.h"

namespace relevo::scene {

/// A film in the words of a job's file. What moves moves at once, over the film's length.
struct FilmJob {
    film::Settings film;
    double duration_s = 10;
    std::string output;  ///< its file

    /// A day, from one time or event to another.
    struct Day {
        std::string date;      ///< "2026-06-21"
        std::string zone;      ///< as TimeSpec::zone
        std::string from, to;  ///< "sunrise-30min", "sunset+30min"
    };
    /// A year at one time of day.
    struct Year {
        int year = 0;
        std::string at;    ///< "12:00"
        std::string zone;  ///< "solar": clocks that are never changed
    };
    struct Orbit {
        double turns = 1;
        bool ease = false;
    };
    struct Flight {
        std::string along;        ///< file of a line
        std::vector<View> views;  ///< instead of `along`: two or more
        std::optional<double> height_m, look_ahead_m, speed_m_s;  ///< of a flight along a line
        bool ease = true;
    };
    /// A number from one value to another.
    struct Value {
        std::string address;  ///< of a parameter, or "seconds"
        double from = 0, to = 0;
    };
    std::optional<Day> day;
    std::optional<Year> year;  ///< not with `day`
    std::optional<Orbit> orbit;
    std::optional<Flight> flight;  ///< not with `orbit`
    std::optional<Value> value;
};

/// The file of a job that makes a film of a scene, paths as scene_text() has them.
std::string film_job_text(const Scene& scene, const FilmJob& job,
                          const std::filesystem::path& folder);

/// A path as a file in `folder` names it: relative where it is below, else absolute.
std::string path_from(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace relevo::scene
