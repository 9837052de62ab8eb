#pragma once

#include <map>
#include <string>
#include <vector>

/// The commands of the program and their options, as manual pages and completions need them.
namespace relevo::commands {

/// What completes a value.
enum class Kind {
    Flag,       ///< takes no value
    Text,       ///< numbers, dates, places and names: nothing is proposed
    Words,      ///< one of Option::words
    Lists,      ///< some of Option::words, separated by commas
    File,       ///< a name of a file
    Folder,     ///< a name of a folder
    Effect,     ///< an id of an effect, or several, separated by commas
    Parameter,  ///< "haze.density="
    Preset,     ///< a preset's name, or a file
    Zone,       ///< a time zone
};

struct Option {
    std::vector<std::string> names;  ///< "--output", "-o"; empty: positional
    std::string value;               ///< name of the value for a manual: "FILE"; empty of flags
    std::string text;                ///< a sentence without a full stop
    std::string group;               ///< "Options", "View" ...
    Kind kind = Kind::Text;
    std::vector<std::string> words{};
    bool needed = false, many = false;
};

struct Command {
    std::string name;  ///< "relevo sun hours"
    std::string text;
    std::vector<Option> positionals, options;
    std::vector<Command> commands;
};

/// Values that are proposed for options of the kinds that depend on what is installed.
struct Installed {
    std::map<std::string, std::string> effects;     ///< id: description
    std::map<std::string, std::string> parameters;  ///< address: description
    std::vector<std::string> presets, zones;
};

/// All commands. @throws Error (Failed) naming options of which it is not known what completes them
Command all_commands();
/// What comes with the program.
Installed installed();

/// The manual of a command: "relevo-sun-hours.1" in the language of man.
/// @param date  "2026-11-26"
std::string manual(const Command& command, const std::string& version, const std::string& date);
/// The same as a page of Markdown.
std::string reference_page(const Command& command);
/// "relevo-sun-hours".
std::string manual_name(const Command& command);

std::string bash_completion(const Command& all, const Installed& values);
std::string zsh_completion(const Command& all, const Installed& values);
std::string fish_completion(const Command& all, const Installed& values);

}  // namespace relevo::commands
