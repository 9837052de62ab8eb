#include "cli/command_line.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/allowed_name.h"
#include "base/contains.h"
#include "base/error.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/effects.h"
#include "dem/remote.h"

namespace relevo::cli {
namespace {

/// The verb that a line names: "relevo sun position" as its command.
struct Named {
    const CLI::App* verb;
    std::string command;
};

Named named_verb(const CLI::App& app) {
    Named named{&app, app.get_name()};
    for (auto used = app.get_subcommands(); !used.empty(); used = named.verb->get_subcommands())
        named = {used.front(), named.command + " " + used.front()->get_name()};
    return named;
}

bool is_global_flag(const std::string& word) {
    constexpr std::array<std::string_view, 5> kFlags = {"-q", "--quiet", "-v", "--verbose",
                                                        "--progress"};
    return contains(kFlags, word);
}

/// CLI11 would only say that a command is missing.
/// @param words  of the command line, from the one on that should be a verb of `app`
/// @returns the verbs that are named, each after a blank: " sun position"
std::string check_verb(const CLI::App& app, std::span<const std::string> words) {
    const std::string word = words.empty() ? "" : words.front();
    const std::vector<const CLI::App*> verbs = app.get_subcommands({});
    if (word.starts_with('-') || verbs.empty()) return {};
    std::vector<std::string> names;
    for (const CLI::App* verb : verbs) {
        if (verb->get_name() == word) return " " + word + check_verb(*verb, words.subspan(1));
        names.push_back(verb->get_name());
    }
    if (word.empty()) {
        if (app.get_require_subcommand_min() == 0) return {};
        bad_usage(fmt::format("{}: no command given; there are {}; each has --help", app.get_name(),
                              fmt::join(names, ", ")));
    }
    if (word == "help") bad_usage("help: no such command; write relevo --help");
    const std::optional<std::string> near = nearest(word, names);
    bad_usage(fmt::format("{}: no such command; {}", word,
                          near ? fmt::format("did you mean {}?", *near)
                               : fmt::format("there are {}", fmt::join(names, ", "))));
}

/// `relevo DEM...` and `relevo` alone open the window: where no verb is named but what may be a
/// file is, or nothing at all, the verb is put in.
std::vector<std::string> with_verb(const CLI::App& app, std::vector<std::string> words) {
    const auto first = std::ranges::find_if_not(words, is_global_flag);
    const auto names_a_file = [&](const std::string& word) {
        const std::vector<const CLI::App*> verbs = app.get_subcommands({});
        const bool is_verb = std::ranges::any_of(
            verbs, [&](const CLI::App* verb) { return verb->get_name() == word; });
        std::error_code ignored;
        return !word.starts_with('-') && !is_verb &&
               (word.find_first_of("./:") != std::string::npos ||
                std::filesystem::exists(word, ignored));
    };
    if (first == words.end() || names_a_file(*first)) words.insert(first, "view");
    return words;
}

/// --help-all with the verbs of verbs, which CLI11 only names.
class HelpOfAll : public CLI::Formatter {
  public:
    std::string make_expanded(const CLI::App* verb) const override {
        std::string text = CLI::Formatter::make_expanded(verb);
        for (const CLI::App* inner : verb->get_subcommands({}))
            text += "\n" + verb->get_name() + " " + make_expanded(inner);
        return text;
    }
};

/// "--output", "-o": what options of a verb, and of those above it, are called.
std::vector<std::string> option_names(const CLI::App* verb) {
    std::vector<std::string> names;
    for (; verb; verb = verb->get_parent())
        for (const CLI::Option* option : verb->get_options()) {
            for (const std::string& name : option->get_lnames())
                names.push_back("--" + name);
            for (const std::string& name : option->get_snames())
                names.push_back("-" + name);
        }
    return names;
}

/// @throws Error (Usage) `what; see relevo capture --help`
[[noreturn]] void refuse(const std::string& what, const std::string& command) {
    bad_usage(fmt::format("{}{} {} --help", what, what.ends_with('?') ? " See" : "; see", command));
}

constexpr const char* kNoValue = "expected a value but got \"\"; is a shell variable unset?";

/// What is wrong with a word that was taken as an option's value; empty if nothing is.
std::string value_error(const CLI::App* verb, const CLI::Option* option, const std::string& value) {
    if (trimmed(value).empty()) return kNoValue;
    if (!option->get_snames().empty() && value.starts_with('='))
        return fmt::format("write -{} {}, without the =", option->get_snames().front(),
                           value.substr(1));
    const std::vector<std::string> names = option_names(verb);
    if (value.starts_with('-') && contains(names, value))
        return fmt::format("expected a value but got the option {}", value);
    return {};
}

/// Has every option of a verb, and of those below it, refuse values that are none.
void check_values(CLI::App& verb) {
    for (CLI::Option* option : verb.get_options()) {
        if (option->get_items_expected_max() == 0) continue;  // a flag
        if (option->get_items_expected_min() == 0) continue;  // an empty list is one, too
        // transform() puts it before the option's own checks; nothing is transformed.
        option->transform(CLI::Validator(
            [&verb, option](std::string& value) { return value_error(&verb, option, value); }, ""));
    }
    for (CLI::App* inner : verb.get_subcommands({}))
        check_values(*inner);
}

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// "--size" of an option whose hyphens have become dashes; nothing of other words.
std::optional<std::string> with_hyphens(std::string_view word) {
    constexpr std::array<std::string_view, 2> kDashes = {"\u2013", "\u2014"};
    bool has_dash = false;
    while (true) {
        const auto dash = std::ranges::find_if(
            kDashes, [&](std::string_view one) { return word.starts_with(one); });
        if (dash == kDashes.end() && !word.starts_with('-')) break;
        has_dash = has_dash || dash != kDashes.end();
        word.remove_prefix(dash != kDashes.end() ? dash->size() : 1);
    }
    const std::string_view name = word.substr(0, word.find('='));
    const bool is_name = !name.empty() && is_letter(name.front()) &&
                         std::ranges::all_of(name, [](char c) { return is_letter(c) || c == '-'; });
    if (!has_dash || !is_name) return std::nullopt;
    return fmt::format("{}{}", name.size() == 1 ? "-" : "--", word);
}

/// Refuses what CLI11 would read as something else: `--unit=`, which takes the next word, and
/// dashes that a word processor has made of hyphens, which are names of files.
/// @param command  that the words are of
void check_words(const std::vector<std::string>& words, const std::string& command) {
    for (const std::string& word : words) {
        if (word == "--") return;
        if (const std::optional<std::string> meant = with_hyphens(word))
            refuse(fmt::format("{}: begins with a dash; write {} with hyphens", word, *meant),
                   command);
        if (word == "--only=") refuse("--only: write --only '' for no effects", command);
        if (word.starts_with("--") && word.find('=') == word.size() - 1)
            refuse(fmt::format("{}: {}", word.substr(0, word.size() - 1), kNoValue), command);
    }
}

/// The verbs that have an option: "relevo capture", "relevo sun day".
void add_owners(const CLI::App* verb, const std::string& command, const std::string& option,
                std::vector<std::string>& owners) {
    for (const CLI::Option* own : verb->get_options())
        if (own->check_name(option)) owners.push_back(command);
    for (const CLI::App* inner : verb->get_subcommands({}))
        add_owners(inner, command + " " + inner->get_name(), option, owners);
}

/// Whether a word is meant as an option: -33.9 is a number.
bool is_option(std::string_view word) {
    return word.starts_with('-') && (word.size() < 2 || word[1] < '0' || word[1] > '9') &&
           !word.starts_with("-.");
}

/// What to say of words that no option took.
std::string unknown_words(const CLI::App& app, const Named& named,
                          const std::vector<std::string>& words) {
    const std::string& word = words.front();
    if (is_setting(word)) return fmt::format("{0}: write --set {0}, once for each value", word);
    if (!is_option(word))
        return fmt::format(
            "{}: belongs to no option; write values of several parts with commas and without "
            "blanks, or in quotes",
            printable(word));
    const std::string option = word.substr(0, word.find('='));
    std::vector<std::string> owners;
    add_owners(&app, app.get_name(), option, owners);
    constexpr std::size_t kMostNamed = 3;
    if (contains(owners, named.command))
        return fmt::format("{}: write it after {}", option, named.command);
    if (!owners.empty())
        return fmt::format("{}: not an option of {}, but of {}{}", option, named.command,
                           fmt::join(owners.begin(),
                                     owners.begin() + static_cast<std::ptrdiff_t>(
                                                          std::min(owners.size(), kMostNamed)),
                                     ", "),
                           owners.size() > kMostNamed ? ", ..." : "");
    const std::optional<std::string> near = nearest(option, option_names(named.verb));
    return fmt::format("{}: no such option{}", printable(option),
                       near ? fmt::format("; did you mean {}?", *near) : "");
}

/// What an option's value looks like.
std::string example_of(const std::string& option) {
    if (option == "--output") return "FILE";
    if (option == "--at" || option == "--over") return "46.55,8.56";
    if (option == "--time") return "2026-06-21T12:00";
    return option == "--year" ? "2026" : "VALUE";
}

/// "relevo capture DEM --output FILE": a verb with what it needs.
std::string usage_of(const Named& named) {
    std::string text = named.command;
    for (const CLI::Option* option : named.verb->get_options()) {
        if (!option->get_required()) continue;
        const std::string name = option->get_name(option->get_positional());
        text += " " + name;
        if (!option->get_positional()) text += " " + example_of(name);
    }
    return text;
}

/// What CLI11 says of a line, in our words where it has none of ours.
std::string text_of(const CLI::App& app, const Named& named, const CLI::ParseError& error) {
    const std::string what = error.what();
    const std::vector<std::string> extras = app.remaining(true);
    const bool no_verb = what.starts_with("A subcommand");
    if ((no_verb || dynamic_cast<const CLI::ExtrasError*>(&error)) && !extras.empty())
        return unknown_words(app, named, extras);
    if (no_verb) return "no command given";
    // A required option may be misspelt.
    if (const auto misspelt = std::ranges::find_if(extras, is_option); misspelt != extras.end())
        return unknown_words(app, named, {*misspelt});
    if (const std::size_t end = what.rfind(" is required"); end != what.npos)
        return fmt::format("{} is missing; write {}", what.substr(0, end), usage_of(named));
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) && what.ends_with(" missing"))
        return fmt::format("{}: expected a value after it", what.substr(0, what.find(':')));
    return what;
}

[[noreturn]] void refuse(const CLI::App& app, const CLI::ParseError& error) {
    const Named named = named_verb(app);
    refuse(text_of(app, named, error), named.command);
}

}  // namespace

void add_verbs(CLI::App& app) {
    app.require_subcommand(1);
    app.formatter(std::make_shared<HelpOfAll>());
    app.set_version_flag("--version", "relevo " RELEVO_VERSION);
    app.set_help_all_flag("--help-all", "Help for all commands");
    app.add_flag_callback(
        "-q,--quiet", [] { log::set_level(log::Level::Warning); }, "Warnings and errors only");
    app.add_flag_callback(
        "-v,--verbose", [] { log::set_level(log::Level::Debug); },
        "More messages on standard error");
    app.add_flag_callback(
        "--progress", [] { ProgressBar::use_lines(true); },
        "Progress of long work as lines for other programs: progress 0.342");
    app.fallthrough();
    const Verb line(app);
    add_view(line);
    add_capture(line);
    add_run(line);
    add_plan(line);
    add_merge(line);
    add_film(line);
    add_compare(line);
    add_info(line);
    add_export(line);
    add_sun(line);
    add_moon(line);
    add_plugins(line);
    add_thumbnail(line);
    add_zones(line);
    add_cache(line);
    add_doctor(line);
    check_values(app);
}

void parse(CLI::App& app, std::vector<std::string> words) {
    words = with_verb(app, std::move(words));
    const auto first = std::ranges::find_if_not(words, is_global_flag);
    check_words(words, app.get_name() + check_verb(app, {first, words.end()}));
    std::ranges::reverse(words);  // as CLI11 takes them
    try {
        app.parse(std::move(words));
    } catch (const CLI::ParseError& error) {
        // Help and version are "errors" of CLI11 with status 0; the others are usage errors.
        if (error.get_exit_code() != 0) refuse(app, error);
        std::ostringstream text;
        app.exit(error, text, text);
        fmt::print("{}", text.str());
    }
}

void run(std::vector<std::string> words) {
    CLI::App app{"Relevo: shows any DEM in the sunlight of a date", "relevo"};
    add_verbs(app);
    std::ranges::for_each(words, allow_word);
    parse(app, std::move(words));
    if (const auto net = dem::network_use())
        log::debug(fmt::format("{} requests to the net, {} bytes read, {} written", net->requests,
                               net->read_bytes, net->written_bytes));
}

}  // namespace relevo::cli
