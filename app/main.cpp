#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "base/log.h"
#include "cli/commands.h"

namespace {

int run(int argc, char** argv) {
    CLI::App app{"Relevo: any DEM under the sun of a date", "relevo"};
    app.require_subcommand(1);
    app.set_version_flag("--version", "relevo " RELEVO_VERSION);
    app.set_help_all_flag("--help-all", "Help of every command");
    app.failure_message(CLI::FailureMessage::simple);
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
