#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command_tree.h"

namespace relevo::commands {
namespace {

/// A text inside of single quotes and brackets of _arguments.
std::string in_quotes(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '\'')
            result += "'\\''";
        else if (c == '[' || c == ']' || c == ':' || c == '\\')
            result += std::string("\\") + c;
        else
            result += c;
    }
    return result;
}

std::string action_of(const Option& option) {
    switch (option.kind) {
        case Kind::File:
            return "_files";
        case Kind::Folder:
            return "_files -/";
        case Kind::Effect:
            return "_sequence _relevo_effects";
        case Kind::Parameter:
            return "_relevo_parameters";
        case Kind::Preset:
            return "_relevo_presets";
        case Kind::Zone:
            return "_relevo_zones";
        case Kind::Words:
            return fmt::format("({})", in_quotes(fmt::format("{}", fmt::join(option.words, " "))));
        case Kind::Lists:
            return fmt::format("_values -s , value {}", fmt::join(option.words, " "));
        default:
            return " ";
    }
}

std::string function_of(const Command& command) {
    std::string name = command.name;
    for (char& c : name)
        if (c == ' ' || c == '-') c = '_';
    return "_" + name + (command.name == "relevo" ? "_command" : "");
}

void add_functions(const Command& command, std::string& text) {
    text += fmt::format("{}() {{\n    _arguments -C \\\n", function_of(command));
    for (const Option& option : command.options)
        for (const std::string& name : option.names) {
            text += fmt::format("        '{}{}[{}]", option.many ? "*" : "", name,
                                in_quotes(option.text));
            if (option.kind != Kind::Flag)
                text += fmt::format(":{}:{}", in_quotes(option.value), action_of(option));
            text += "' \\\n";
        }
    if (command.commands.empty()) {
        text += "        '*:file:_files'\n}\n\n";
        return;
    }
    text +=
        "        '1: :->command' '*:: :->arguments'\n    case $state in\n        command)\n        "
        "    local -a commands=(\n";
    for (const Command& inner : command.commands)
        text += fmt::format("                '{}:{}'\n", inner.name.substr(command.name.size() + 1),
                            in_quotes(inner.text));
    text +=
        "            )\n            _describe command commands\n            _files\n            "
        ";;\n        arguments)\n"
        "            case $line[1] in\n";
    for (const Command& inner : command.commands)
        text += fmt::format("                {}) {} ;;\n",
                            inner.name.substr(command.name.size() + 1), function_of(inner));
    text += "            esac\n            ;;\n    esac\n}\n\n";
    for (const Command& inner : command.commands)
        add_functions(inner, text);
}

}  // namespace

std::string zsh_completion(const Command& all, const Installed& values) {
    std::string text =
        "#compdef relevo\n# Completion of relevo for zsh, made when it was built.\n\n";
    text += "_relevo_effects() {\n    local -a effects=(\n";
    for (const auto& [id, description] : values.effects)
        text += fmt::format("        '{}:{}'\n", id, in_quotes(description));
    text +=
        "    )\n    "
        "effects+=(${XDG_DATA_HOME:-$HOME/.local/share}/relevo/plugins/*/plugin.json(N:h:t))\n"
        "    _describe -t effects effect effects \"$@\"\n}\n\n_relevo_parameters() {\n    local -a "
        "parameters=(\n";
    for (const auto& [address, description] : values.parameters)
        text += fmt::format("        '{}:{}'\n", address, in_quotes(description));
    text += fmt::format(
        "    )\n    _describe -t parameters parameter parameters -S =\n}}\n\n"
        "_relevo_presets() {{\n    _alternative 'presets:preset:({})' 'files:file:_files -g "
        "\"*.json\"'\n}}\n\n"
        "_relevo_zones() {{\n    compadd {}\n}}\n\n",
        fmt::join(values.presets, " "), fmt::join(values.zones, " "));
    add_functions(all, text);
    return text + "_relevo_command \"$@\"\n";
}

}  // namespace relevo::commands
