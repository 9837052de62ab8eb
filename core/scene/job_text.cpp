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

}  // namespace relevo::scene
