#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command_tree.h"

namespace relevo::commands {
namespace {

/// A text without Markdown.
std::string escaped_markdown(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '*' || c == '_' || c == '<' || c == '[' || c == '`') result += '\\';
        result += c;
    }
    return result;
}

/// A list of definitions, an extension of Markdown that the site has.
void add_options(const std::vector<const Option*>& options, std::string& text) {
    for (const Option* option : options) {
        const std::string names = fmt::format("{}", fmt::join(option->names, "`, `"));
        const std::string value =
            option->value.empty() ? "" : (names.empty() ? "" : " ") + option->value;
        text += fmt::format("`{}{}`{}\n: {}{}.\n\n", names, value, option->many ? " ..." : "",
                            escaped_markdown(option->text), option->needed ? " (required)" : "");
    }
}

}  // namespace

std::string reference_page(const Command& command) {
    std::string text = fmt::format("# {}\n\n{}.\n\n", command.name, escaped_markdown(command.text));
    for (const Command& inner : command.commands)
        text += fmt::format("- [{}]({}.md): {}\n", inner.name, manual_name(inner),
                            escaped_markdown(inner.text));
    if (!command.commands.empty()) text += "\n";
    std::vector<const Option*> arguments;
    for (const Option& positional : command.positionals)
        arguments.push_back(&positional);
    if (!arguments.empty()) {
        text += "## Arguments\n\n";
        add_options(arguments, text);
    }
    std::vector<std::string> groups;
    for (const Option& option : command.options)
        if (std::ranges::find(groups, option.group) == groups.end()) groups.push_back(option.group);
    for (const std::string& group : groups) {
        text += fmt::format("## {}\n\n", group);
        std::vector<const Option*> members;
        for (const Option& option : command.options)
            if (option.group == group) members.push_back(&option);
        add_options(members, text);
    }
    return text;
}

}  // namespace relevo::commands
