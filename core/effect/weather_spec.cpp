#include "effect/weather_spec.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "effect/manifest.h"
#include "json/object_reader.h"
#include "weather/facts.h"

namespace relevo::effect {

WeatherSpec read_weather_spec(json::ObjectReader object, const std::string& id) {
    WeatherSpec spec;
    spec.on = object.strings("on");
    for (const std::string& word : spec.on)
        if (!contains(weather::fact_words(), word))
            object.fail(object.line_of("on"), "on",
                        fmt::format("expected words of {} but got \"{}\"",
                                    fmt::join(weather::fact_words(), ", "), word));
    if (const json::Value* const set = object.take("set")) {
        if (set->kind != json::Value::Kind::Object)
            object.fail(set->line, "set",
                        fmt::format("expected an object of parameter and figure but got {}",
                                    json::describe(*set)));
        for (const auto& [name, figure] : set->members) {
            if (!is_word(name))
                object.fail(figure.line, "set",
                            fmt::format("expected a parameter of the plugin but got \"{}\"", name));
            if (!contains(weather::fact_figures(), figure.text))
                object.fail(
                    figure.line, "set",
                    fmt::format("{}: expected one of {} but got {}", name,
                                fmt::join(weather::fact_figures(), ", "), json::describe(figure)));
            spec.settings.push_back({id + '.' + name, figure.text, figure.line});
        }
    }
    object.finish();
    return spec;
}

}  // namespace relevo::effect
