#include "figure/horizons.h"

#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"

namespace relevo::figure {

std::vector<output::RasterBand> Horizons::bands() const {
    std::vector<output::RasterBand> bands;
    for (const double azimuth : azimuths()) {
        const std::string azimuth_deg = fmt::format("{:.10g}", degrees(azimuth));
        bands.push_back(
            {"horizon towards azimuth " + azimuth_deg, "deg", {{"AZIMUTH_DEG", azimuth_deg}}});
    }
    return bands;
}

PartMaker Horizons::maker(Work work) const {
    const auto plan = this->plan(work);
    light::add_horizon_directions(*plan, azimuths());
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
