#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command_tree.h"

namespace relevo::commands {
namespace {

/// A text in the language of man: no word of it is a request, and hyphens can be searched for.
std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '\\')
            result += "\\e";
        else if (c == '-')
            result += "\\-";
        else if ((c == '.' || c == '\'') && result.empty())
            result += std::string("\\&") + c;
        else
            result += c;
    }
    return result;
}

std::string paragraph_of(const Option& option) {
    std::vector<std::string> names;
    for (auto name = option.names.rbegin(); name != option.names.rend(); ++name)
        names.push_back("\\fB" + escaped(*name) + "\\fR");
    std::string head = fmt::format("{}", fmt::join(names, ", "));
    if (!option.value.empty())
        head += (head.empty() ? "\\fI" : " \\fI") + escaped(option.value) + "\\fR";
    if (option.many) head += " ...";
    std::string text = option.text;
    if (!option.names.empty() && option.kind == Kind::Words &&
        text.find(option.words.front()) == std::string::npos)
        text += fmt::format(": {}", fmt::join(option.words, ", "));
    return fmt::format(".TP\n{}\n{}{}.\n", head, escaped(text), option.needed ? " (required)" : "");
}

std::string synopsis(const Command& command) {
    std::string text = fmt::format(".SH SYNOPSIS\n.B {}\n", escaped(command.name));
    if (!command.commands.empty()) return text + ".I COMMAND\n.RI [ OPTION ]...\n";
    text += ".RI [ OPTION ]...\n";
    for (const Option& positional : command.positionals)
        text +=
            fmt::format(".RI {}{}{}{}\n", positional.needed ? "" : "[ ", escaped(positional.value),
                        positional.needed ? "" : " ]", positional.many ? " ..." : "");
    return text;
}

std::string options_text(const Command& command) {
    std::string text;
    std::vector<std::string> groups;
    for (const Option& option : command.options)
        if (std::ranges::find(groups, option.group) == groups.end()) groups.push_back(option.group);
    for (const std::string& group : groups) {
        text += group == "Options" ? ".SH OPTIONS\n" : fmt::format(".SS {}\n", escaped(group));
        for (const Option& option : command.options)
            if (option.group == group) text += paragraph_of(option);
    }
    return text;
}

constexpr const char* kExitStatus = R"man(.SH EXIT STATUS
.TP
0
Success.
.TP
1
The operation failed.
.TP
2
The command line is wrong.
.TP
3
A file or a value cannot be used.
.TP
4
No GL device can draw.
.TP
5
Some of many results could not be made.
.TP
6
What was compared is different.
)man";

constexpr const char* kEnvironment = R"man(.SH ENVIRONMENT
.TP
.B RELEVO_PLUGIN_PATH
Folders with more plugins, separated by colons.
.TP
.B RELEVO_PATIENCE_S
How long the code of a plugin may take, in seconds (20).
.TP
.B RELEVO_SHARE
Folder of plugins, shaders and data, instead of the one that was installed.
)man";

}  // namespace

std::string manual_name(const Command& command) {
    std::string name = command.name;
    std::ranges::replace(name, ' ', '-');
    return name;
}

std::string manual(const Command& command, const std::string& version, const std::string& date) {
    std::string title = manual_name(command);
    std::ranges::transform(title, title.begin(), [](unsigned char c) { return std::toupper(c); });
    std::string text = fmt::format(
        ".TH {} 1 \"{}\" \"Relevo {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", escaped(title),
        date, version, escaped(manual_name(command)), escaped(command.text));
    text += synopsis(command);
    if (!command.positionals.empty()) {
        text += ".SH ARGUMENTS\n";
        for (const Option& positional : command.positionals)
            text += paragraph_of(positional);
    }
    if (!command.commands.empty()) {
        text += ".SH COMMANDS\n";
        for (const Command& inner : command.commands)
            text += fmt::format(".TP\n.BR {} (1)\n{}.\n", escaped(manual_name(inner)),
                                escaped(inner.text));
    }
    text += options_text(command);
    const bool is_whole = command.name == "relevo";
    if (is_whole) text.append(kExitStatus).append(kEnvironment);
    text += ".SH SEE ALSO\n";
    text += is_whole ? "/usr/share/doc/relevo/\n" : ".BR relevo (1)\n";
    return text;
}

}  // namespace relevo::commands
