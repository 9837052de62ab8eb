#include "figure/hours.h"

#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "figure/sun_over_middle.h"
#include "light/raster/horizons.h"

namespace relevo::figure {
namespace {

/// A band by its word on the command line.
struct Band {
    enum class Needs { Nothing, Spells, Irradiation };

    const char *word, *name, *unit;
    Array2d<float> light::SunHours::*values;  ///< null: the sum of beam, diffuse and reflected
    Needs needs = Needs::Irradiation;
};

constexpr Band kBands[] = {
    {"hours", "sun hours", "h", &light::SunHours::hours, Band::Needs::Nothing},
    {"first", "minutes to the first light", "min", &light::SunHours::first_h, Band::Needs::Spells},
    {"last", "minutes to the last light", "min", &light::SunHours::last_h, Band::Needs::Spells},
    {"spells", "sunshine periods", "1", &light::SunHours::spells, Band::Needs::Spells},
    {"global", "global irradiation", "kWh/m2", nullptr},
    {"beam", "beam irradiation", "kWh/m2", &light::SunHours::beam_kwh},
    {"diffuse", "diffuse irradiation", "kWh/m2", &light::SunHours::diffuse_kwh},
    {"reflected", "reflected irradiation", "kWh/m2", &light::SunHours::reflected_kwh},
};

const Band& band_of(const std::string& word) {
    return *std::ranges::find(kBands, word, &Band::word);
}

bool needs(const std::vector<std::string>& words, Band::Needs what) {
    return std::ranges::any_of(
        words, [&](const std::string& word) { return band_of(word).needs == what; });
}

/// Moves what no other band needs.
Array2d<float> values_of(const Band& band, light::SunHours& hours) {
    Array2d<float> values = !band.values ? hours.beam_kwh
                            : band.needs == Band::Needs::Irradiation
                                ? hours.*band.values
                                : std::move(hours.*band.values);
    constexpr float kMinutes = 60;  // of an hour
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!band.values)
            values.data()[i] += hours.diffuse_kwh.data()[i] + hours.reflected_kwh.data()[i];
        else if (band.unit == std::string_view("min"))
            values.data()[i] *= kMinutes;
    return values;
}

/// A sentence for the file's metadata.
std::string definition_of(const light::SunHoursOptions::Irradiation& irradiation) {
    const std::optional<light::Plane>& plane = irradiation.plane;
    return fmt::format(
        "irradiation of {}, clear sky of the European Solar Radiation "
        "Atlas (Rigollier et al. 2000), Linke turbidity {:.4g}: beam with the terrain's shade, "
        "diffuse alike from all of the open sky, reflected by ground of albedo {:.4g}",
        plane ? fmt::format("a plane of tilt {:.6g} that faces {:.6g} degrees at each post",
                            degrees(plane->tilt_rad), degrees(plane->azimuth_rad))
              : "the ground as it is inclined",
        irradiation.linke, irradiation.albedo);
}

}  // namespace

const std::vector<std::string>& Hours::all_words() {
    static const std::vector<std::string> kWords = [] {
        std::vector<std::string> words;
        for (const Band& band : kBands)
            words.emplace_back(band.word);
        return words;
    }();
    return kWords;
}

bool Hours::has_spells() const {
    return needs(words, Band::Needs::Spells);
}

bool Hours::has_irradiation() const {
    return needs(words, Band::Needs::Irradiation);
}

std::string Hours::repeated_word() const {
    for (auto word = words.begin(); word != words.end(); ++word)
        if (std::find(words.begin(), word, *word) != word) return *word;
    return {};
}

std::vector<output::RasterBand> Hours::bands() const {
    std::vector<output::RasterBand> bands;
    for (const std::string& word : words)
        bands.push_back({band_of(word).name, band_of(word).unit});
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

const char* Hours::accuracy() const {
    const bool few = time.end - time.begin <= light::SunHoursOptions::kMostDays * 86400.0;
    return few ? kDaysAccuracy : kManyDaysAccuracy;
}

int Hours::bytes_a_post() const {
    return (has_spells() ? 44 : 22) + (has_irradiation() ? 32 : 0);
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
    options.spells = has_spells();
    if (has_irradiation()) options.irradiation = irradiation;
    return options;
}

PartMaker Hours::maker(Work work) const {
    light::SunHoursOptions options = this->options();
    options.part = work.window;
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
            put(k, part, values_of(band_of(words[k]), hours));
        return PartMade{hours.holes, std::move(hours.definition)};
    };
}

}  // namespace relevo::figure
