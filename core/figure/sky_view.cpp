#include "figure/sky_view.h"

#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"

namespace relevo::figure {

output::RasterBand sky_view_band() {
    return {"sky-view factor", "1"};
}

std::vector<output::RasterBand> SkyView::bands() const {
    return {sky_view_band()};
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

}  // namespace relevo::figure
