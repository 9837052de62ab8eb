// Writes manual pages and completions into a folder: relevo_make_command_files FOLDER DATE
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>

#include "base/error.h"
#include "command_tree.h"

namespace relevo::commands {
namespace {

void write(const std::filesystem::path& path, const std::string& text) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file) failed(fmt::format("{}: cannot be written", path.string()));
}

void write_manuals(const Command& command, const std::filesystem::path& folder,
                   const std::string& date) {
    write(folder / "man1" / (manual_name(command) + ".1"), manual(command, RELEVO_VERSION, date));
    write(folder / "reference" / (manual_name(command) + ".md"), reference_page(command));
    for (const Command& inner : command.commands)
        write_manuals(inner, folder, date);
}

}  // namespace
}  // namespace relevo::commands

int main(int argc, char** argv) try {
    using namespace relevo::commands;
    if (argc != 3) relevo::bad_usage("expected FOLDER DATE");
    const std::filesystem::path folder = argv[1];
    const Command all = all_commands();
    const Installed values = installed();
    write_manuals(all, folder, argv[2]);
    write(folder / "bash/relevo", bash_completion(all, values));
    write(folder / "zsh/_relevo", zsh_completion(all, values));
    write(folder / "fish/relevo.fish", fish_completion(all, values));
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "relevo_make_command_files: %s\n", error.what());
    return 1;
}
