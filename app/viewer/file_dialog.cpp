#include "viewer/file_dialog.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "base/text.h"

namespace relevo::viewer {
namespace {

bool is_there(const std::string& program) {
    const char* path = std::getenv("PATH");
    for (const std::string& folder : split(path ? path : "", ':')) {
        std::error_code ignored;
        if (std::filesystem::is_regular_file(std::filesystem::path(folder) / program, ignored))
            return true;
    }
    return false;
}

std::vector<std::string> lines_of(const char* command) {
    std::vector<std::string> lines;
    std::FILE* const pipe = popen(command, "r");
    if (!pipe) return lines;
    std::string text;
    std::array<char, 4096> piece{};
    while (const std::size_t count = std::fread(piece.data(), 1, piece.size(), pipe))
        text.append(piece.data(), count);
    pclose(pipe);
    for (const std::string& line : split(text, '\n'))
        if (!line.empty()) lines.push_back(line);
    return lines;
}

}  // namespace

std::optional<std::future<std::vector<std::string>>> ask_for_files() {
    const char* command = nullptr;
    if (is_there("zenity"))
        command =
            "zenity --file-selection --multiple --separator='\n' --title='Open a DEM' "
            "2>/dev/null";
    else if (is_there("kdialog"))
        command = "kdialog --getopenfilename . --multiple --separate-output 2>/dev/null";
    if (!command) return std::nullopt;
    return std::async(std::launch::async, [command] { return lines_of(command); });
}

}  // namespace relevo::viewer
