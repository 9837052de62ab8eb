#include "figure/shadow.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "light/raster/horizons.h"

namespace relevo::figure {

std::vector<output::RasterBand> Shadow::bands() const {
    const output::RasterBand band{soft ? "visible fraction of the solar disc" : "direct sun", "1"};
    std::vector<output::RasterBand> bands(suns.size(), band);
    for (std::size_t k = 0; k < names.size(); ++k) {
        bands[k].name = names[k];
        bands[k].metadata = metadata_of(suns[k]);
    }
    return bands;
}

std::string Shadow::air(const dem::Posts& posts) const {
    return refraction.empty() ? "none, the sun was given as seen" : air_of_posts(refraction, posts);
}

output::RasterMetadata Shadow::metadata(const dem::Posts& posts) const {
    output::RasterMetadata about{{"REFRACTION", air(posts)}};
    if (names.empty())
        for (auto& item : metadata_of(suns.front()))
            about.push_back(std::move(item));
    return about;
}

double Shadow::halo_m(const dem::Posts& posts) const {
    double farthest_m = 0;
    for (const SunOverMiddle& sun : suns)
        farthest_m = std::max(
            farthest_m, light::shade_reach_m(posts, terrestrial_refraction, sun.apparent_rad));
    return std::min(farthest_m, light::horizon_reach_m(posts, terrestrial_refraction));
}

light::ShadowOptions Shadow::options() const {
    light::ShadowOptions options;
    options.refraction = terrestrial_refraction;
    if (!refraction.empty()) options.air = air_of(refraction);
    options.soft = soft;
    return options;
}

std::vector<light::SunOverDem> Shadow::directions() const {
    std::vector<light::SunOverDem> all;
    for (const SunOverMiddle& sun : suns)
        all.push_back(sun.sun);
    return all;
}

std::optional<light::Beyond> Shadow::beyond(const dem::Posts& posts,
                                            const dem::Window& window) const {
    return light::terrain_beyond(posts, window, directions(), options(), highest_m);
}

PartMaker Shadow::maker(Work work) const {
    light::ShadowOptions options = this->options();
    options.done = work.done;
    const auto plan = std::make_shared<light::SunPlan>(
        work.posts, light::LightPath{options.refraction, options.air}, work.window, soft);
    plan->add_suns(work.middle, directions());
    return [this, plan, options, put = std::move(work.put)](const dem::Window& part) mutable {
        options.part = part;
        PartMade made;
        for (std::size_t k = 0; k < plan->suns().size(); ++k) {
            light::Shadows shadows = light::shadows(*plan, plan->suns()[k], options);
            if (seen) seen(k, shadows);
            put(k, part, std::move(shadows.lit));
            made = {shadows.holes, std::move(shadows.definition)};
        }
        return made;
    };
}

}  // namespace relevo::figure
