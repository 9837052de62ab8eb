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

/// Which effects are to be on, by their ids.
struct Switches {
    std::optional<std::vector<std::string>> only;  ///< these and nothing else
    std::vector<std::string> enable;
    std::vector<std::string> disable;
    bool operator==(const Switches&) const = default;
};

/// A value for a parameter.
struct Setting {
    std::string address;   ///< "haze.density"
    std::string text;      ///< as shader::parse_value reads it
    int line = 0;          ///< in a preset's or scene's file; 0 on the command line
    std::string folder{};  ///< from which the path of a file counts; empty: the working folder
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
/// @throws Error (Usage) if it is not of that form
Setting parse_setting(std::string_view text);

/// The settings of an object's member `key`: {"haze.density": 0.2, "sea.colour": [0, 0.1, 0.2]};
/// none if it is missing.
/// @param folder  of the file
/// @throws Error (BadInput) for a value that no parameter can have
std::vector<Setting> read_settings(json::ObjectReader& object, const std::string& key,
                                   const std::string& folder);

/// A value of a file as it would stand on the command line; nothing where no parameter can have it.
std::optional<std::string> value_text(const json::Value& value);

/// Whether load_preset() takes it for a path.
bool is_preset_file(const std::string& name_or_path);

/// Reads a preset: `share_dir()/presets/NAME.json`, or a path if there is a slash or `.json` in it.
/// @throws Error (BadInput) `preset: file:line: ...`
Preset load_preset(const std::string& name_or_path);

/// Names of the presets that came with the program.
std::vector<std::string> preset_names();

}  // namespace relevo::effect
