#include "figure/horizons.h"

#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"

namespace relevo::figure {

std::vector<output::RasterBand> Horizons::bands() const {
    std::vector<output::RasterBand> bands;
    for (const double azimuth : azimuths_of(directions)) {
        const std::string azimuth_deg = fmt::format("{:.10g}", degrees(azimuth));
        bands.push_back(
            {"horizon towards azimuth " + azimuth_deg, "deg", {{"AZIMUTH_DEG", azimuth_deg}}});
    }
    return bands;
}

double Horizons::halo_m(const dem::Posts& posts) const {
    return light::horizon_reach_m(posts, terrestrial_refraction);
}

std::optional<light::Beyond> Horizons::beyond(const dem::Posts& posts,
                                              const dem::Window& window) const {
    return light::terrain_beyond(posts, window, azimuths_of(directions), terrestrial_refraction,
                                 highest_m);
}

PartMaker Horizons::maker(Work work) const {
    const auto plan = std::make_shared<light::SunPlan>(
        work.posts, light::LightPath{terrestrial_refraction, {}}, work.window, false, work.around);
    light::add_horizon_directions(*plan, azimuths_of(directions));
    const std::string definition = light::horizons_definition(terrestrial_refraction);
    return [plan, definition, put = std::move(work.put),
            done = std::move(work.done)](const dem::Window& part) {
        PartMade made{0, definition};
        for (std::size_t k = 0; k < plan->suns().size(); ++k) {
            Array2d<float> elevation = light::horizon_elevations(*plan, plan->suns()[k], part);
            for (float& value : elevation) {
                if (k == 0) made.holes += std::isnan(value);
                value = static_cast<float>(degrees(double{value}));
            }
            put(k, part, std::move(elevation));
            if (done) done(1);
        }
        return made;
    };
}

}  // namespace relevo::figure
