#include "figure/horizons.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

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
        work.posts, light::LightPath{terrestrial_refraction, {}}, work.window);
}

output::RasterMetadata SkyView::metadata(const dem::Posts&) const {
    return {{"DIRECTIONS", fmt::format("{}", directions)}};
}

PartMaker SkyView::maker(Work work) const {
    const auto plan = this->plan(work);
    light::add_sky_view_directions(*plan, directions);
    light::SkyViewOptions options{.directions = directions,
                                  .refraction = terrestrial_refraction,
                                  .level = level,
                                  .part = {},
                                  .done = work.done};
    return [this, plan, options, put = std::move(work.put)](const dem::Window& part) mutable {
        options.part = part;
        light::SkyView view = light::sky_view(*plan, options);
        if (seen) seen(view);
        put(0, part, std::move(view.share));
        return PartMade{view.holes, std::move(view.definition)};
    };
}

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
    const std::string definition = light::horizons_definition(work.posts, terrestrial_refraction);
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
