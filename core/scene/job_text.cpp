#include <nlohmann/json.hpp>

#include "scene/job.h"

namespace relevo::scene {

std::string day_job_text(const Scene& scene, const JobDay& day,
                         const std::filesystem::path& folder) {
    using nlohmann::ordered_json;
    ordered_json json = ordered_json::parse(scene_text(scene, folder));
    json["time"] = {{"at", day.from}, {"date", day.date}};
    if (!day.zone.empty()) json["time"]["zone"] = day.zone;
    json["sweep"] = ordered_json::array();
    json["sweep"].push_back({{"times", {{"from", day.from}, {"to", day.to}, {"step", day.step}}}});
    json["output"] = day.output;
    return json.dump(2) + "\n";
}

std::string job_record(const Job& job) {
    using nlohmann::ordered_json;
    ordered_json record = ordered_json::parse(scene_line(job.scene));
    const ordered_json given = ordered_json::parse(job.text);
    for (const char* const key : {"shots", "sweep", "combine", "film"})
        if (given.contains(key)) record[key] = given[key];
    record["output"] = job.output;
    const std::filesystem::path folder = std::filesystem::absolute(job.folder / ".");
    return ordered_json{{"relevo:job", record}, {"folder", folder.lexically_normal().string()}}
        .dump();
}

}  // namespace relevo::scene
