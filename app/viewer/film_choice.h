#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "scene/film_job.h"
#include "session/scene_times.h"

/// What the film panel asks for, and the job that follows. Needs no device and no panels.
namespace relevo::viewer {

/// What moves in a film, and for how long. All moves at once.
struct FilmChoice {
    enum class Time {
        Still,
        Day,   ///< the displayed day, from before sunrise to after sunset
        Year,  ///< the displayed year, at one hour of mean solar time
    };
    enum class Camera {
        Still,
        AroundMiddle,  ///< around the ground in the picture's middle
        AroundDem,     ///< around all of the DEM
        Views,         ///< through the saved views, in their order
        Track,         ///< along the line of a file
    };

    Time time = Time::Day;
    Camera camera = Camera::Still;
    double turns = 1;         ///< of an orbit, clockwise from above
    std::string track;        ///< file of a line
    double height_m = 150;    ///< least height of a flight along a track above the ground
    double look_ahead_m = 0;  ///< 0: chosen from the height and the speed
    double speed_m_s = 0;     ///< 0: by `duration_s`
    bool ease = false;        ///< the camera begins and ends at rest
    std::string value;        ///< address of a parameter, or "seconds"; empty: none
    double from = 0, to = 1;  ///< of the parameter
    double duration_s = 10;
    double fps = 30;

    bool operator==(const FilmChoice&) const = default;
    bool is_orbit() const { return camera == Camera::AroundMiddle || camera == Camera::AroundDem; }
    bool is_flight() const { return camera == Camera::Views || camera == Camera::Track; }
    /// Whether `speed_m_s` gives the film's length: nothing but a flight along a track moves.
    bool can_have_speed() const {
        return camera == Camera::Track && time == Time::Still && value.empty();
    }
};

struct FilmPreset {
    const char* name;
    FilmChoice choice;
};
/// The first is a day in 10 s at 30 frames per second.
const std::vector<FilmPreset>& film_presets();

inline constexpr int kLeastFilm_px = 16, kMostFilm_px = 16384;
inline constexpr std::array<std::string_view, 4> kFilmEndings = {"mp4", "webm", "webp", "gif"};

/// The file of a film.
struct FilmFile {
    glm::ivec2 size_px{1280, 720};
    std::string ending = "mp4";
    int quality = 80;       ///< not of gif
    int samples = 1;        ///< a pixel
    bool has_date = false;  ///< date and time are stamped on every frame
    std::string name = "{dem}_film";

    bool operator==(const FilmFile&) const = default;
    bool has_quality() const { return ending != "gif"; }
};
inline constexpr double kLongestFilm_s = 3600;
/// More frames are not planned in the window.
inline constexpr int kMostFilmFrames = 20'000;

/// A film of a scene.
struct FilmWish {
    scene::Scene scene;  ///< what the film begins with: time, eye, absolute paths
    sun::Instant utc;    ///< its time
    sun::Zone zone;
    std::vector<scene::View> views;  ///< of a flight through views
    FilmChoice choice;
    FilmFile file;
    std::string folder{};  ///< empty: the working folder

    /// Equal wishes have equal films.
    bool operator==(const FilmWish& other) const;
};

/// What keeps a film from being made that is known without reading a file; empty: nothing.
std::string film_problem(const FilmChoice& choice, std::size_t saved_views);

/// The scene that the job of a film has.
scene::Scene film_scene(const FilmWish& wish);
/// The job of a film, with a file name that is free now.
/// @param times  for the day's events
/// @param note   receives what the film shows instead of what was asked for
/// @throws Error (BadInput) for sizes, settings and names that cannot be
scene::FilmJob film_job(const FilmWish& wish, session::SceneTimes& times, std::string& note);

}  // namespace relevo::viewer
