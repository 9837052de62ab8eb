#include <algorithm>
#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "cli/commands.h"

namespace {

/// "relevo sun position": the command that a message is about.
std::string command_of(const CLI::App* app) {
    const CLI::App* verb = app;
    std::string command = app->get_name();
    for (auto used = verb->get_subcommands(); !used.empty(); used = verb->get_subcommands()) {
        verb = used.front();
        command += " " + verb->get_name();
    }
    return command;
}

/// CLI11 would only say that a command is missing.
/// @param words  of the command line, from the one on that should be a verb of `app`
void check_verb(const CLI::App& app, std::span<const char* const> words) {
    const std::string word = words.empty() ? "" : words.front();
    const std::vector<const CLI::App*> verbs = app.get_subcommands({});
    if (word.starts_with('-') || verbs.empty()) return;
    std::vector<std::string> names;
    for (const CLI::App* verb : verbs) {
        if (verb->get_name() == word) return check_verb(*verb, words.subspan(1));
        names.push_back(verb->get_name());
    }
    if (word.empty()) {
        if (app.get_require_subcommand_min() == 0) return;
        relevo::bad_usage(fmt::format("{}: which command? There are {}; each has --help",
                                      app.get_name(), fmt::join(names, ", ")));
    }
    const std::optional<std::string> near = relevo::nearest(word, names);
    relevo::bad_usage(fmt::format("{}: no such command; {}", word,
                                  near ? fmt::format("did you mean {}?", *near)
                                       : fmt::format("there are {}", fmt::join(names, ", "))));
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

int run(int argc, char** argv) {
    CLI::App app{"Relevo: any DEM under the sun of a date", "relevo"};
    app.require_subcommand(1);
    app.formatter(std::make_shared<HelpOfAll>());
    app.set_version_flag("--version", "relevo " RELEVO_VERSION);
    app.set_help_all_flag("--help-all", "Help of every command");
    app.failure_message([](const CLI::App* verb, const CLI::Error& error) {
        return fmt::format("relevo: error: {}; see {} --help\n", error.what(), command_of(verb));
    });
    app.add_flag_callback(
        "-q,--quiet", [] { relevo::log::set_level(relevo::log::Level::Warning); },
        "Warnings and errors only");
    app.add_flag_callback(
        "-v,--verbose", [] { relevo::log::set_level(relevo::log::Level::Debug); },
        "Say more on standard error");
    app.fallthrough();
    relevo::cli::add_capture(app);
    relevo::cli::add_info(app);
    relevo::cli::add_sun(app);
    relevo::cli::add_plugins(app);
    relevo::cli::add_doctor(app);
    check_verb(app, std::span(argv, static_cast<std::size_t>(argc)).subspan(1));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        // Help and version are "errors" of CLI11 with status 0; the others are usage errors.
        return app.exit(error) == 0 ? 0 : static_cast<int>(relevo::ErrorCode::Usage);
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const relevo::Error& error) {
        relevo::log::error(error.what());
        return error.exit_status();
    } catch (const std::exception& error) {
        relevo::log::error(error.what());
        return static_cast<int>(relevo::ErrorCode::Failed);
    }
}
