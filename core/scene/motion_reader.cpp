#include "scene/motion_reader.h"

#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "dem/places.h"
#include "scene/ground_path.h"

namespace relevo::scene {

using json::ObjectReader;

namespace {

constexpr double kLongest_s = 1e6;

/// The views of a flight: cameras that begin as the scene's.
std::vector<View> read_views(const SceneReader& reader, const ObjectReader& object,
                             const json::Value& list, const std::string& path, const Scene& scene) {
    if (list.kind != json::Value::Kind::Array)
        object.fail(list.line, "views",
                    fmt::format("expected a list of cameras but got {}", json::describe(list)));
    std::vector<View> views;
    for (const json::Value& item : list.items) {
        Scene with = scene;
        reader.take_camera(item, fmt::format("{}.views[{}]", path, views.size()), with);
        views.push_back(with.view);
    }
    if (views.size() < 2)
        object.fail(list.line, "views",
                    fmt::format("expected two cameras or more but got {}", views.size()));
    return views;
}

/// The places of a line's file.
std::vector<geo::Geodetic> read_places(ObjectReader& object, const std::string& file) {
    std::vector<geo::Geodetic> places;
    const std::string crs = object.string("crs", "");
    const int number = static_cast<int>(object.number("line", 0, 1, dem::kMostPlaces, true));
    for (const dem::NamedPlace& place : dem::read_line(file, kJobWho, crs, number).places)
        places.push_back(place.at.place);
    return places;
}

}  // namespace

film::Settings read_film(const ObjectReader& job, const json::Value& value) {
    ObjectReader object = job.inner("film", value);
    film::Settings film;
    film.fps = object.number("fps", film.fps, film::kMinFps, film::kMaxFps, false);
    if (object.has("quality"))
        film.quality = static_cast<int>(object.number("quality", 0, 0, 100, true));
    if (object.has("loop")) film.loop = object.boolean("loop", true);
    object.take("quality"), object.take("loop");
    object.finish();
    return film;
}

int read_frames(ObjectReader& object, double fps, double otherwise_s) {
    if (object.has("frames") && object.has("duration_s"))
        object.fail(object.line_of("duration_s"), "duration_s",
                    "expected frames or a duration but got both");
    const double duration_s = object.number("duration_s", otherwise_s, 1e-3, kLongest_s, false);
    const double frames = std::max(1.0, std::round(duration_s * fps));
    if (!object.has("frames") && frames > kMostFrames)
        object.fail(object.line_of("duration_s"), "duration_s",
                    fmt::format("expected at most {} frames but got {:.0f}", kMostFrames, frames));
    return static_cast<int>(
        object.number("frames", std::min<double>(frames, kMostFrames), 1, kMostFrames, true));
}

OrbitMotion read_orbit(const SceneReader& reader, const json::Value& value, const std::string& path,
                       double fps) {
    ObjectReader object = reader.inside(value, path);
    OrbitMotion orbit;
    orbit.turns = object.number("turns", orbit.turns, -1000, 1000, false);
    if (orbit.turns == 0)
        object.fail(object.line_of("turns"), "turns", "expected a number that is not 0 but got 0");
    orbit.ease = object.boolean("ease", orbit.ease);
    orbit.frames = read_frames(object, fps, 10);
    object.finish();
    return orbit;
}

FlightMotion read_flight(const SceneReader& reader, const json::Value& value,
                         const std::string& path, double fps, const Scene& scene,
                         std::vector<JobFile>& files) {
    ObjectReader object = reader.inside(value, path);
    FlightMotion flight;
    flight.fps = fps;
    flight.ease = object.boolean("ease", flight.ease);
    const json::Value* const views = object.take("views");
    if (views && object.has("along"))
        object.fail(views->line, "views", "expected a line (along) or views but got both");
    if (views) {
        flight.views = read_views(reader, object, *views, path, scene);
        flight.frames = read_frames(object, fps, 10);
        object.finish();
        return flight;
    }
    const std::string file = reader.beside(object.string("along"));
    files.push_back({file, "the line of the flight"});
    flight.along = read_places(object, file);
    flight.height_m = object.number("height_m", flight.height_m, 0.1, 1e6, false);
    flight.look_ahead_m = object.number("look_ahead_m", 0, 1, 1e6, false);
    try {
        if (!object.has("speed_m_s")) {
            object.take("speed_m_s");
            GroundPath(flight.along, flight.height_m);  // says what is wrong with the line
            flight.frames = read_frames(object, fps, 10);
        } else {
            const double speed_m_s = object.number("speed_m_s", 0, 0.01, 1e6, false);
            if (object.has("frames") || object.has("duration_s"))
                object.fail(object.line_of("speed_m_s"), "speed_m_s",
                            "expected a speed, frames or a duration but got two of them");
            object.take("frames"), object.take("duration_s");
            const double frames = frames_at_speed(flight, speed_m_s);
            if (!(frames <= kMostFrames))
                object.fail(object.line_of("speed_m_s"), "speed_m_s",
                            fmt::format("expected at most {} frames but the line takes {:.0f}",
                                        kMostFrames, frames));
            flight.frames = static_cast<int>(frames);
        }
    } catch (const Error& error) {
        const std::string what = error.what();
        if (what.starts_with("expected ")) object.fail(object.line_of("along"), "along", what);
        throw;
    }
    object.finish();
    return flight;
}

}  // namespace relevo::scene
