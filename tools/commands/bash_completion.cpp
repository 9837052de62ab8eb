#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command_tree.h"

namespace relevo::commands {
namespace {

// What is the same for all programs of this shape. COMP_WORDS are the words of the line; "=" and
// ":" are words of their own, which what is proposed has to take into account.
constexpr const char* kFunction = R"sh(
_relevo_effects() {
    local file id
    printf '%s\n' $_relevo_effect_ids
    for file in "${XDG_DATA_HOME:-$HOME/.local/share}"/relevo/plugins/*/plugin.json; do
        id=$(basename "$(dirname "$file")")
        # compgen would execute what a name has of the shell's language.
        [[ -e $file && $id =~ ^[a-z0-9_-]+$ ]] && printf '%s\n' "$id"
    done
}

_relevo_files() {
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen "$1" -- "$2")
}

# The last word of a list that is separated by commas.
_relevo_lists() {
    local before= rest=$2 i
    [[ $2 == *,* ]] && before=${2%,*}, rest=${2##*,}
    mapfile -t COMPREPLY < <(compgen -W "$1" -- "$rest")
    for i in "${!COMPREPLY[@]}"; do COMPREPLY[i]=$before${COMPREPLY[i]}; done
}

_relevo_value() {
    local kind=${_relevo_values[$1 $2]} current=$3
    case $kind in
        @file) _relevo_files -f "$current" ;;
        @folder) _relevo_files -d "$current" ;;
        @effect) _relevo_lists "$(_relevo_effects)" "$current" ;;
        @preset) mapfile -t COMPREPLY < <(
            compgen -W "$_relevo_presets" -- "$current"
            compgen -f -X '!*.json' -- "$current") ;;
        @zone) mapfile -t COMPREPLY < <(compgen -W "$_relevo_zones" -- "$current") ;;
        @parameter)
            compopt -o nospace 2>/dev/null
            mapfile -t COMPREPLY < <(compgen -S = -W "$_relevo_parameters" -- "$current")
            ;;
        ,*) _relevo_lists "${kind#,}" "$current" ;;
        *)
            mapfile -t COMPREPLY < <(compgen -W "$kind" -- "$current")
            [[ ${COMPREPLY[0]} == *[=:] ]] && compopt -o nospace 2>/dev/null
            ;;
    esac
}

_relevo() {
    local current=${COMP_WORDS[COMP_CWORD]} command=relevo option= word i
    COMPREPLY=()
    for ((i = 1; i < COMP_CWORD; ++i)); do
        word=${COMP_WORDS[i]}
        if [[ -n ${_relevo_options[$command $word]+x} ]]; then
            command+=" $word" option=
        elif [[ $word == -* ]]; then
            option=$word
        elif [[ $word != = ]]; then
            option=
        fi
    done
    [[ $current == = ]] && current=
    if [[ -n $option && -n ${_relevo_values[$command $option]} ]]; then
        _relevo_value "$command" "$option" "$current"
    elif [[ -n $option && -n ${_relevo_free[$command $option]} ]]; then
        return
    elif [[ $current == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "${_relevo_options[$command]}" -- "$current")
    else
        mapfile -t COMPREPLY < <(compgen -W "${_relevo_commands[$command]}" -- "$current")
        ((${#COMPREPLY[@]} > 0)) || _relevo_files -f "$current"
    fi
}
complete -F _relevo relevo
)sh";

/// What _relevo_value() reads: "@file", ",a b", "a b".
std::string values_of(const Option& option) {
    switch (option.kind) {
        case Kind::File:
            return "@file";
        case Kind::Folder:
            return "@folder";
        case Kind::Effect:
            return "@effect";
        case Kind::Parameter:
            return "@parameter";
        case Kind::Preset:
            return "@preset";
        case Kind::Zone:
            return "@zone";
        case Kind::Words:
            return fmt::format("{}", fmt::join(option.words, " "));
        case Kind::Lists:
            return fmt::format(",{}", fmt::join(option.words, " "));
        default:
            return {};
    }
}

struct Tables {
    std::string options, commands, values, free;

    void add(const Command& command) {
        std::vector<std::string> names, inner;
        for (const Option& option : command.options) {
            for (const std::string& name : option.names) {
                if (name.starts_with("--")) names.push_back(name);
                if (option.kind == Kind::Flag) continue;
                const std::string proposed = values_of(option);
                std::string& table = proposed.empty() ? free : values;
                table += fmt::format("    [\"{} {}\"]=\"{}\"\n", command.name, name,
                                     proposed.empty() ? "1" : proposed);
            }
        }
        for (const Command& one : command.commands)
            inner.push_back(one.name.substr(command.name.size() + 1));
        options += fmt::format("    [\"{}\"]=\"{}\"\n", command.name, fmt::join(names, " "));
        if (!inner.empty())
            commands += fmt::format("    [\"{}\"]=\"{}\"\n", command.name, fmt::join(inner, " "));
        for (const Command& one : command.commands)
            add(one);
    }
};

template <typename Map>
std::string keys(const Map& map) {
    std::vector<std::string> names;
    for (const auto& [name, text] : map)
        names.push_back(name);
    return fmt::format("{}", fmt::join(names, " "));
}

}  // namespace

std::string bash_completion(const Command& all, const Installed& values) {
    Tables tables;
    tables.add(all);
    return fmt::format(
               "# Completion of relevo for bash, made when it was built.\n"
               "declare -gA _relevo_options=(\n{})\ndeclare -gA _relevo_commands=(\n{})\n"
               "declare -gA _relevo_values=(\n{})\ndeclare -gA _relevo_free=(\n{})\n"
               "_relevo_effect_ids=\"{}\"\n_relevo_presets=\"{}\"\n_relevo_zones=\"{}\"\n_relevo_"
               "parameters=\"{}\"\n",
               tables.options, tables.commands, tables.values, tables.free, keys(values.effects),
               fmt::join(values.presets, " "), fmt::join(values.zones, " "),
               keys(values.parameters)) +
           kFunction;
}

}  // namespace relevo::commands
