#include "scene/job.h"

#include <string>

#include "fuzz/fuzz.h"
#include "geo/local_frame.h"

namespace relevo::fuzz {

// Places and lines have files of their own.
const Target kJob("job", [](std::string_view bytes) {
    static const auto sites = file("name,lat,lon\na,36.36,-84.23\nb,36.3,-84.2\n", "sites.csv");
    static const auto track = file("lat,lon\n36.3,-84.2\n36.4,-84.2\n36.4,-84.1\n", "track.csv");
    const scene::Job job = scene::read_job_text(std::string(bytes), "job.json", folder());
    const auto noon = [](const scene::Scene& scene) {
        return sun::parse_time(scene.time.at, sun::Zone());
    };
    const auto level_ground = [](const scene::Scene&) {
        static const geo::LocalFrame frame({});
        return scene::MotionGround{.height_m = [](const geo::Geodetic&) { return 100.0; },
                                   .frame = frame,
                                   .points = {{0, 0, 100}, {900, 0, 100}, {0, 900, 200}},
                                   .camera = [](const scene::View&) { return scene::Camera(); }};
    };
    scene::shots_of(job, noon, 100, level_ground);
});

}  // namespace relevo::fuzz
