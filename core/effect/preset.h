#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace relevo::json {
class ObjectReader;
struct Value;
}  // namespace relevo::json

namespace relevo::effect {

/// The scene's overlay in Switches::order.
inline constexpr std::string_view kOverlay = "overlay";

/// Ids of effects to switch on or off.
struct Switches {
    std::optional<std::vector<std::string>> only;  ///< only these
    std::vector<std::string> enable;
    std::vector<std::string> disable;
    /// Calling order of these effects, instead of that of their manifests; kOverlay is the scene's
    /// overlay. Not of presets.
    std::vector<std::string> order{};
    bool operator==(const Switches&) const = default;
};

/// A value for a parameter.
struct Setting {
    std::string address;   ///< "haze.density"
    std::string text;      ///< as shader::parse_value reads it
    int line = 0;          ///< in the file of a preset or scene; 0: command line
    std::string folder{};  ///< base of relative paths; empty: working folder

    bool operator==(const Setting& other) const {
        return address == other.address && text == other.text && folder == other.folder;
    }
};

/// A file of switches and values.
struct Preset {
    std::string name;
    std::string file;
    std::string description;
    Switches switches;
    std::vector<Setting> settings;
};

/// Reads `haze.density=0.2`.
/// @throws Error (Usage) for another form
Setting parse_setting(std::string_view text);

/// The settings of an object's member `key`: {"haze.density": 0.2, "sea.colour": [0, 0.1, 0.2]};
/// none if it is missing.
/// @param folder  of the file
/// @throws Error (BadInput) for a value that no parameter can have
std::vector<Setting> read_settings(json::ObjectReader& object, const std::string& key,
                                   const std::string& folder);

/// A value of a file as the command line would have it; none if no parameter can have it.
std::optional<std::string> value_text(const json::Value& value);

/// Whether load_preset() uses it as a path.
bool is_preset_file(const std::string& name_or_path);

/// Reads a preset: `share_dir()/presets/NAME.json`, or a path if it has a slash or `.json`.
/// @throws Error (BadInput) `preset: file:line: ...`
Preset load_preset(const std::string& name_or_path);

/// Names of the bundled presets.
std::vector<std::string> preset_names();

}  // namespace relevo::effect
