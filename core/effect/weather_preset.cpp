#include "effect/weather_preset.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/log.h"

namespace relevo::effect {
namespace {

/// A figure as a value of a parameter.
std::string value_of(const shader::Param& param, double figure) {
    if (!param.words.empty()) {
        const double last = static_cast<double>(param.words.size()) - 1;
        return param.words[static_cast<std::size_t>(std::clamp(std::round(figure), 0.0, last))];
    }
    double value = param.type == shader::ParamType::Int ? std::round(figure) : figure;
    if (param.range && (value < param.range->min || value > param.range->max)) {
        value = std::clamp(value, param.range->min, param.range->max);
        log::info(
            fmt::format("weather: {} is {:g}, the nearest to the report's {:g} that it can be",
                        param.address, value, figure));
    }
    return shader::format_value(param, {value});
}

}  // namespace

Preset weather_preset(const Registry& registry, const weather::Facts& facts) {
    Preset preset;
    preset.name = kWeatherPreset;
    for (const Effect& effect : registry.effects()) {
        const std::optional<WeatherSpec>& spec = effect.manifest.weather;
        if (!spec) continue;
        if (std::ranges::any_of(
                spec->on, [&](const std::string& word) { return contains(facts.words, word); }))
            preset.switches.enable.push_back(effect.id());
        const std::vector<shader::Param> params = effect.params();
        for (const WeatherSpec::Setting& setting : spec->settings) {
            const std::optional<double> figure = facts.figure(setting.figure);
            const auto param = std::ranges::find(params, setting.address, &shader::Param::address);
            if (figure && param != params.end())
                preset.settings.push_back({setting.address, value_of(*param, *figure)});
        }
    }
    return preset;
}

}  // namespace relevo::effect
