#include "figure/hours_bands.h"

#include <utility>

#include <fmt/format.h>

namespace relevo::figure {
namespace {

constexpr const char* kEnergy = "kWh/m2";
constexpr float kMinutes = 60;  // of an hour

Array2d<float> in_minutes(Array2d<float> hours) {
    for (float& value : hours)
        value *= kMinutes;
    return hours;
}

/// Beam, diffuse and reflected together.
Array2d<float> global_of(const light::SunHours& hours) {
    Array2d<float> sum = hours.beam_kwh;
    for (std::size_t i = 0; i < sum.size(); ++i)
        sum.data()[i] += hours.diffuse_kwh.data()[i] + hours.reflected_kwh.data()[i];
    return sum;
}

}  // namespace

const std::vector<std::string>& hours_words() {
    static const std::vector<std::string> kWords{"hours",  "first", "last",    "spells",
                                                 "global", "beam",  "diffuse", "reflected"};
    return kWords;
}

output::RasterBand hours_band(std::string_view word) {
    if (word == "first") return {"minutes to the first light", "min"};
    if (word == "last") return {"minutes to the last light", "min"};
    if (word == "spells") return {"sunshine periods", "1"};
    if (needs_irradiation(word)) return {std::string(word) + " irradiation", kEnergy};
    return {"sun hours", "h"};
}

bool needs_spells(std::string_view word) {
    return word == "first" || word == "last" || word == "spells";
}

bool needs_irradiation(std::string_view word) {
    return word == "global" || word == "beam" || word == "diffuse" || word == "reflected";
}

Array2d<float> hours_values(std::string_view word, light::SunHours& hours) {
    if (word == "global") return global_of(hours);
    if (word == "beam") return hours.beam_kwh;
    if (word == "diffuse") return hours.diffuse_kwh;
    if (word == "reflected") return hours.reflected_kwh;
    if (word == "first") return in_minutes(std::move(hours.first_h));
    if (word == "last") return in_minutes(std::move(hours.last_h));
    return std::move(word == "spells" ? hours.spells : hours.hours);
}

std::string definition_of(const light::SunHoursOptions::Irradiation& irradiation) {
    return fmt::format(
        "irradiation of the ground as it is inclined, clear sky of the European Solar Radiation "
        "Atlas (Rigollier et al. 2000), Linke turbidity {:.4g}: beam with the terrain's shade, "
        "diffuse alike from all of the open sky, reflected by ground of albedo {:.4g}",
        irradiation.linke, irradiation.albedo);
}

}  // namespace relevo::figure
