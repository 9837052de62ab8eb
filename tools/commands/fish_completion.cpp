#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command_tree.h"

namespace relevo::commands {
namespace {

/// A text inside of single quotes.
std::string in_fish_quotes(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '\'' || c == '\\') result += '\\';
        result += c;
    }
    return "'" + result + "'";
}

std::string value_of(const Option& option) {
    const std::string words = fmt::format("{}", fmt::join(option.words, " "));
    switch (option.kind) {
        case Kind::Flag:
            return {};
        case Kind::File:
            return " -r -F";
        case Kind::Folder:
            return " -x -a '(__fish_complete_directories (commandline -ct))'";
        case Kind::Effect:
            return " -x -a '(__fish_append , (__relevo_effects))'";
        case Kind::Parameter:
            return " -x -a '(__relevo_parameters)'";
        case Kind::Preset:
            return " -r -F -a \"$__relevo_presets\"";
        case Kind::Zone:
            return " -x -a \"$__relevo_zones\"";
        case Kind::Words:
            return " -x -a " + in_fish_quotes(words);
        case Kind::Lists:
            return fmt::format(" -x -a '(__fish_append , {})'", words);
        default:
            return " -x";
    }
}

void add_lines(const Command& command, std::string& text) {
    const std::string words = command.name.size() > 7 ? command.name.substr(7) : "";
    const std::string condition = fmt::format("-n '__relevo_is \"{}\"'", words);
    for (const Command& inner : command.commands)
        text += fmt::format("complete -c relevo {} -a {} -d {}\n", condition,
                            inner.name.substr(command.name.size() + 1), in_fish_quotes(inner.text));
    for (const Option& option : command.options) {
        std::string names;
        for (const std::string& name : option.names)
            names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        text += fmt::format("complete -c relevo {}{} -d {}{}\n", condition, names,
                            in_fish_quotes(option.text), value_of(option));
    }
    for (const Command& inner : command.commands)
        add_lines(inner, text);
}

void list_groups(const Command& command, std::vector<std::string>& names) {
    for (const Command& inner : command.commands) {
        names.push_back(in_fish_quotes(inner.name.substr(7)));
        list_groups(inner, names);
    }
}

constexpr const char* kFunctions = R"sh(
# Whether the words of the line name this command and no other one.
function __relevo_is
    set -l found
    for word in (commandline -opc)[2..-1]
        set -l longer (string trim "$found $word")
        contains -- $longer $__relevo_commands; and set found $longer
    end
    test "$found" = "$argv[1]"
end

function __relevo_effects
    string join \n $__relevo_effect_ids
    set -l data $XDG_DATA_HOME
    test -n "$data"; or set data ~/.local/share
    for file in $data/relevo/plugins/*/plugin.json
        basename (dirname $file)
    end
end

function __relevo_parameters
    for address in $__relevo_parameter_addresses
        echo $address=
    end
end

)sh";

}  // namespace

std::string fish_completion(const Command& all, const Installed& values) {
    std::vector<std::string> commands, ids, addresses;
    list_groups(all, commands);
    for (const auto& [id, description] : values.effects)
        ids.push_back(id);
    for (const auto& [address, description] : values.parameters)
        addresses.push_back(address);
    std::string text = fmt::format(
        "# Completion of relevo for fish, made when it was built.\n"
        "set -g __relevo_commands {}\nset -g __relevo_effect_ids {}\nset -g __relevo_presets {}\n"
        "set -g __relevo_zones {}\nset -g __relevo_parameter_addresses {}\n",
        fmt::join(commands, " "), fmt::join(ids, " "), fmt::join(values.presets, " "),
        fmt::join(values.zones, " "), fmt::join(addresses, " "));
    text += kFunctions;
    add_lines(all, text);
    return text;
}

}  // namespace relevo::commands
