#include "effect/search_path.h"

#include <cstdlib>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "base/error.h"
#include "base/paths.h"
#include "base/text.h"

namespace relevo::effect {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVariable = "RELEVO_PLUGIN_PATH";

bool is_folder(const fs::path& path) {
    std::error_code ignored;
    return fs::is_directory(path, ignored);
}

}  // namespace

std::vector<fs::path> user_plugin_folders() {
    std::vector<fs::path> folders;
    const fs::path home = user_folder("XDG_DATA_HOME", ".local/share");  // empty: no home
    if (!home.empty() && is_folder(home / "relevo/plugins"))
        folders.push_back(home / "relevo/plugins");
    const char* const names = std::getenv(kVariable);
    for (const std::string& name : split(names ? names : "", ':')) {
        if (name.empty()) continue;
        const fs::path folder = name;
        // A relative path would load modules of whichever folder the program is started in.
        if (!folder.is_absolute())
            bad_input(
                fmt::format("{}: {}: expected an absolute path of a folder", kVariable, name));
        if (!is_folder(folder)) bad_input(fmt::format("{}: {}: no such folder", kVariable, name));
        folders.push_back(folder);
    }
    return folders;
}

std::vector<fs::path> plugin_search_path(const std::vector<fs::path>& extra) {
    std::vector<fs::path> folders;
    if (const fs::path shipped = share_dir() / "plugins"; is_folder(shipped))
        folders.push_back(shipped);
    const std::vector<fs::path> own = user_plugin_folders();
    folders.insert(folders.end(), own.begin(), own.end());
    folders.insert(folders.end(), extra.begin(), extra.end());
    return folders;
}

}  // namespace relevo::effect
