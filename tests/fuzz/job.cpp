#include "scene/job.h"

#include <string>

#include "fuzz/fuzz.h"

namespace relevo::fuzz {

const Target kJob("job", [](std::string_view bytes) {
    const scene::Job job = scene::read_job_text(std::string(bytes), "job.json", folder());
    const auto noon = [](const scene::Scene& scene) {
        return sun::parse_time(scene.time.at, sun::Zone());
    };
    scene::shots_of(job, noon, 100);
});

}  // namespace relevo::fuzz
