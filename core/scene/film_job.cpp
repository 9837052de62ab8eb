#include "scene/film_job.h"

#include <nlohmann/json.hpp>

namespace relevo::scene {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

ordered_json film_of(const FilmJob& job) {
    ordered_json film{{"fps", job.film.fps}};
    if (job.film.quality) film["quality"] = *job.film.quality;
    if (job.film.loop) film["loop"] = *job.film.loop;
    return film;
}

ordered_json orbit_of(const FilmJob& job) {
    ordered_json result{{"turns", job.orbit->turns}, {"duration_s", job.duration_s}};
    if (job.orbit->ease) result["ease"] = true;
    return result;
}

/// The camera of a view as a scene has it.
ordered_json camera_of(Scene scene, const View& view) {
    scene.view = view;
    return ordered_json::parse(scene_text(scene, ""))["camera"];
}

ordered_json flight_of(const Scene& scene, const FilmJob& job, const fs::path& folder) {
    const FilmJob::Flight& flight = *job.flight;
    ordered_json result;
    if (flight.views.empty()) result["along"] = path_from(flight.along, folder);
    for (const View& view : flight.views)
        result["views"].push_back(camera_of(scene, view));
    if (!flight.ease) result["ease"] = false;
    if (flight.height_m) result["height_m"] = *flight.height_m;
    if (flight.look_ahead_m) result["look_ahead_m"] = *flight.look_ahead_m;
    if (flight.speed_m_s)
        result["speed_m_s"] = *flight.speed_m_s;
    else
        result["duration_s"] = job.duration_s;
    return result;
}

ordered_json time_of(const std::string& at, const std::string& date, const std::string& zone) {
    ordered_json time{{"at", at}, {"date", date}};
    if (!zone.empty()) time["zone"] = zone;
    return time;
}

}  // namespace

std::string path_from(const fs::path& path, const fs::path& folder) {
    const fs::path whole = fs::absolute(path).lexically_normal();
    const fs::path relative =
        whole.lexically_relative(fs::absolute(folder.empty() ? "." : folder).lexically_normal());
    return relative.empty() || *relative.begin() == ".." ? whole.string() : relative.string();
}

std::string film_job_text(const Scene& scene, const FilmJob& job, const fs::path& folder) {
    ordered_json json = ordered_json::parse(scene_text(scene, folder));
    ordered_json sweep = ordered_json::array();
    if (job.day) {
        const FilmJob::Day& day = *job.day;
        json["time"] = time_of(day.from, day.date, day.zone);
        sweep.push_back(
            {{"times", {{"from", day.from}, {"to", day.to}, {"duration_s", job.duration_s}}}});
    }
    if (job.year) {
        const FilmJob::Year& year = *job.year;
        json["time"] = time_of(year.at, std::to_string(year.year) + "-01-01", year.zone);
        sweep.push_back(
            {{"dates", {{"year", year.year}, {"duration_s", job.duration_s}, {"at", year.at}}}});
    }
    if (job.orbit) sweep.push_back({{"orbit", orbit_of(job)}});
    if (job.flight) sweep.push_back({{"flight", flight_of(scene, job, folder)}});
    if (job.value)
        sweep.push_back({{"set", job.value->address},
                         {"from", job.value->from},
                         {"to", job.value->to},
                         {"duration_s", job.duration_s}});
    if (sweep.size() > 1) json["combine"] = "zip";
    json["sweep"] = sweep;
    json["film"] = film_of(job);
    json["output"] = path_from(job.output, folder);
    return json.dump(2) + "\n";
}

}  // namespace relevo::scene
