#include <algorithm>
#include <exception>
#include <optional>
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
void check_verb(const CLI::App& app, const std::string& word) {
    if (word.empty() || word[0] == '-') return;
    std::vector<std::string> verbs;
    for (const CLI::App* verb : app.get_subcommands({}))
        verbs.push_back(verb->get_name());
    if (std::find(verbs.begin(), verbs.end(), word) != verbs.end()) return;
    const std::optional<std::string> near = relevo::nearest(word, verbs);
    relevo::bad_usage(fmt::format("{}: no such command; {}", word,
                                  near ? fmt::format("did you mean {}?", *near)
                                       : fmt::format("there are {}", fmt::join(verbs, ", "))));
}

int run(int argc, char** argv) {
    CLI::App app{"Relevo: any DEM under the sun of a date", "relevo"};
    app.require_subcommand(1);
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
    if (argc > 1) check_verb(app, argv[1]);
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
