#include "figure/directions.h"

#include "base/units.h"

namespace relevo::figure {

std::vector<double> Directions::azimuths() const {
    std::vector<double> azimuth_rad;
    for (int i = 0; i < directions; ++i)
        azimuth_rad.push_back(2 * kPi * i / directions);
    return azimuth_rad;
}

double Directions::halo_m(const dem::Posts& posts) const {
    return light::horizon_reach_m(posts, terrestrial_refraction);
}

std::optional<light::Beyond> Directions::beyond(const dem::Posts& posts,
                                                const dem::Window& window) const {
    return light::terrain_beyond(posts, window, azimuths(), terrestrial_refraction, highest_m);
}

std::shared_ptr<light::SunPlan> Directions::plan(const Work& work) const {
    return std::make_shared<light::SunPlan>(
        work.posts, light::LightPath{terrestrial_refraction, {}}, work.window, false, work.around);
}

}  // namespace relevo::figure
