#include "figure/sky_view.h"

#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"

namespace relevo::figure {

std::vector<double> azimuths_of(int directions) {
    std::vector<double> azimuth_rad;
    for (int i = 0; i < directions; ++i)
        azimuth_rad.push_back(2 * kPi * i / directions);
    return azimuth_rad;
}

output::RasterBand sky_view_band() {
    return {"sky-view factor", "1"};
}

std::vector<output::RasterBand> SkyView::bands() const {
    return {sky_view_band()};
}

output::RasterMetadata SkyView::metadata(const dem::Posts&) const {
    return {{"DIRECTIONS", fmt::format("{}", directions)}};
}

double SkyView::halo_m(const dem::Posts& posts) const {
    return light::horizon_reach_m(posts, terrestrial_refraction);
}

std::optional<light::Beyond> SkyView::beyond(const dem::Posts& posts,
                                             const dem::Window& window) const {
    return light::terrain_beyond(posts, window, azimuths_of(directions), terrestrial_refraction,
                                 highest_m);
}

PartMaker SkyView::maker(Work work) const {
    const auto plan = std::make_shared<light::SunPlan>(
        work.posts, light::LightPath{terrestrial_refraction, {}}, work.window, false, work.around);
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

}  // namespace relevo::figure
