#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "film/film.h"
#include "scene/motion.h"
#include "scene/scene.h"
#include "sun/zone.h"

/// Many pictures from one file: docs/jobs.md.
namespace relevo::scene {

/// What messages about a job begin with.
inline constexpr std::string_view kJobWho = "job";

/// One picture of a job on its way: a scene, and what tells it from the others.
struct Draft {
    Scene scene;
    std::string time;                   ///< instead of the scene's; a time of day or an event
                                        ///< without a date too
    std::optional<sun::Date> date;      ///< instead of the scene's
    std::optional<geo::Geodetic> site;  ///< where events without a place happen
    std::map<std::string, std::string> names;  ///< "camera", "site", "haze.density", ...
};

/// A value of an axis.
struct Change {
    std::string name;
    std::function<void(Draft&)> apply;
};

/// Times from one to another in equal steps. The ends may be events.
struct TimeRange {
    std::string from, to;
    double step_s = 0;
    int frames = 0;  ///< if above 0, instead of `step_s`: number of times, both ends included
};

/// A camera that moves over the ground of a scene.
using Motion = std::variant<OrbitMotion, FlightMotion>;

/// Something that changes from picture to picture.
struct Axis {
    std::string kind;  ///< "shot", "time", "date", "camera", "site", "effects", or a parameter
    std::string path;  ///< in the file, for messages: "sweep[1].cameras"
    int line = 0;
    std::vector<Change> values;
    std::optional<TimeRange> range;  ///< instead of values, of times
    std::optional<Motion> motion;    ///< instead of values, of the camera

    /// How many values it has; none where only the DEM tells.
    std::optional<std::size_t> count() const;
};

/// A file that a job was read from, beside its own.
struct JobFile {
    std::filesystem::path path;
    std::string what;  ///< "the scene", "the sites"
};

/// A scene, and how its pictures differ.
struct Job {
    std::string file;                                            ///< as messages name it
    std::string text;                                            ///< what it was read from
    std::vector<JobFile> files;                                  ///< that it names
    Scene scene;                                                 ///< that all begin with
    std::string output = "{dem}_{time:%Y%m%dT%H%M}_{n:04}.png";  ///< template of names
    bool output_given = false;
    bool output_may_leave = false;  ///< `folder`: the user has named the output, or trusts the job
    int output_line = 0;
    std::filesystem::path folder;  ///< from which the output counts
    bool zip = false;              ///< the sweep's axes go hand in hand, else each with each
    std::vector<Axis> shots;       ///< none or one, each with each of the sweep
    std::vector<Axis> sweep;
    std::optional<film::Settings> film;

    /// Whether the pictures become frames of one file: by the ending of `output`; a webp is a film
    /// where `film` is given.
    bool is_film() const;
};

/// Reads a job from a file. Paths that are relative count from the file's folder.
/// @param change  is made to the job's scene before shots and sweep are
/// @throws Error (BadInput) `job: FILE:LINE: shots[3].camera.fov: what, expected E but got G`
Job read_job(
    const std::filesystem::path& path, const std::function<void(Scene&)>& change = [](Scene&) {});

/// The same from a text.
/// @param file    as messages name it
/// @param folder  from which relative paths count
Job read_job_text(
    const std::string& text, const std::string& file, const std::filesystem::path& folder,
    const std::function<void(Scene&)>& change = [](Scene&) {});

/// A day in the words of a job's file.
struct JobDay {
    std::string date;            ///< "2026-06-21"
    std::string zone;            ///< as TimeSpec::zone
    std::string from, to, step;  ///< "sunrise", "sunset", "1h": TimeRange
    std::string output;          ///< template of names
};

/// The file of a job that draws a scene through a day, paths as scene_text() has them.
std::string day_job_text(const Scene& scene, const JobDay& day,
                         const std::filesystem::path& folder);

/// A job as a film carries it: its members on one line, with absolute paths in the scene's, and the
/// folder from which those in shots and sweep count.
std::string job_record(const Job& job);

/// A picture of a job.
struct Shot {
    Scene scene;  ///< with a complete time
    sun::Instant utc;
    sun::Zone zone;  ///< by whose clocks its name tells the time
    std::map<std::string, std::string> names;
    std::size_t number = 0;  ///< from 1, in the order of the job
    std::filesystem::path output;
};

/// Determines the time of a scene. @throws Error (BadInput) if it has none
using Resolve = std::function<sun::ParsedTime(const Scene& scene)>;

/// The ground of a scene, for cameras that move.
using GroundOf = std::function<MotionGround(const Scene& scene)>;

/// The pictures of a job.
struct Shots {
    std::vector<Shot> shots;
    /// Of pictures that are left out because their event does not happen on their day: why.
    std::vector<std::string> left_out;
    std::vector<std::string> warnings;  ///< about flights over places without ground
};

/// Draws up a job's pictures, with their names.
/// @param most  more pictures are an error, which says how many there are
/// @param ground_of  needed where cameras move
/// @throws Error (BadInput) for an axis without values, too many pictures, dates without a time,
///     names that name one file twice, and as `resolve`, except for events that do not happen
Shots shots_of(const Job& job, const Resolve& resolve, std::size_t most,
               const GroundOf& ground_of = {});

}  // namespace relevo::scene
