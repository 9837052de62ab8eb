#include "figure/hours.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "figure/hours_bands.h"
#include "figure/sun_over_middle.h"
#include "light/raster/horizons.h"

namespace relevo::figure {

std::vector<output::RasterBand> Hours::bands() const {
    std::vector<output::RasterBand> bands;
    for (const std::string& word : words)
        bands.push_back(hours_band(word));
    return bands;
}

std::string Hours::from() const {
    return sun::to_iso(time.begin, zone);
}

std::string Hours::to() const {
    return sun::to_iso(time.end, zone);
}

output::RasterMetadata Hours::metadata(const dem::Posts& posts) const {
    return {{"TIME_FROM", from()},
            {"TIME_TO", to()},
            {"TIME_ZONE", zone.name()},
            {"REFRACTION", air_of_posts(refraction, posts)}};
}

int Hours::bytes_a_post() const {
    return (std::ranges::any_of(words, needs_spells) ? 44 : 22) +
           (std::ranges::any_of(words, needs_irradiation) ? 32 : 0);
}

double Hours::halo_m(const dem::Posts& posts) const {
    return light::horizon_reach_m(posts, terrestrial_refraction);
}

std::optional<light::Beyond> Hours::beyond(const dem::Posts& posts,
                                           const dem::Window& window) const {
    light::ShadowOptions sight;
    sight.refraction = terrestrial_refraction;
    sight.air = air_of(refraction);
    return light::terrain_beyond(posts, window, light::suns_of(posts.grid(), time.begin, time.end),
                                 sight, highest_m);
}

light::SunHoursOptions Hours::options() const {
    light::SunHoursOptions options;
    options.refraction = terrestrial_refraction;
    options.air = air_of(refraction);
    options.step_s = step_s;
    options.spells = std::ranges::any_of(words, needs_spells);
    if (std::ranges::any_of(words, needs_irradiation)) options.irradiation = irradiation;
    return options;
}

PartMaker Hours::maker(Work work) const {
    light::SunHoursOptions options = this->options();
    options.part = work.window;
    options.around = work.around;
    options.done = std::move(work.done);
    options.mixes_suns = work.is_estimate;
    const auto plan =
        std::make_shared<light::SunHoursPlan>(work.posts, time.begin, time.end, options);
    return [this, plan, irradiation = options.irradiation,
            put = std::move(work.put)](const dem::Window& part) {
        light::SunHours hours = plan->part(part);
        if (irradiation) hours.definition += "; " + definition_of(*irradiation);
        if (seen) seen(hours);
        for (std::size_t k = 0; k < words.size(); ++k)
            put(k, part, hours_values(words[k], hours));
        return PartMade{hours.holes, std::move(hours.definition)};
    };
}

}  // namespace relevo::figure
