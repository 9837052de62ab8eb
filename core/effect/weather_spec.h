#pragma once

#include <string>
#include <vector>

namespace relevo::json {
class ObjectReader;
}  // namespace relevo::json

namespace relevo::effect {

/// What a plugin takes from the weather of a scene, the object "weather" of plugin.json:
///     "weather": {"on": ["rainy"], "set": {"wetness": "rain"}}
struct WeatherSpec {
    /// A parameter of the plugin, and the figure that sets it.
    struct Setting {
        std::string address;  ///< "wet.wetness"
        std::string figure;   ///< of weather::fact_figures()
        int line = 0;         ///< in plugin.json
    };
    std::vector<std::string> on;  ///< of weather::fact_words(): each switches the effect on
    std::vector<Setting> settings;
};

/// Reads the object.
/// @param id  of the plugin
/// @throws Error (BadInput) with file and line
WeatherSpec read_weather_spec(json::ObjectReader object, const std::string& id);

}  // namespace relevo::effect
