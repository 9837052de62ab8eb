#pragma once

#include <CLI/CLI.hpp>

/// The verbs of the command line, a file each. A verb adds its options to `app` and returns
/// nothing; CLI11 calls back once the line has been read.
namespace relevo::cli {

void add_capture(CLI::App& app);
void add_compare(CLI::App& app);
void add_run(CLI::App& app);
void add_film(CLI::App& app);
void add_view(CLI::App& app);
void add_doctor(CLI::App& app);
void add_info(CLI::App& app);
void add_export(CLI::App& app);
void add_sun(CLI::App& app);
void add_plugins(CLI::App& app);
void add_thumbnail(CLI::App& app);

}  // namespace relevo::cli
