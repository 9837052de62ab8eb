#include "base/paths.h"

#include <cstdlib>
#include <string>

#include <dlfcn.h>

namespace relevo {
namespace {

/// The file that this code is in: the program, or the library that another program has loaded.
std::filesystem::path own_file() {
    std::error_code ignored;
    Dl_info info{};
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    if (dladdr(reinterpret_cast<const void*>(&own_file), &info) == 0 || !info.dli_fname)
        return program;
    const std::filesystem::path file = std::filesystem::canonical(info.dli_fname, ignored);
    // dladdr() has a program's name as it was called, which may be a name on the search path.
    return file.filename().string().find(".so") == std::string::npos ? program : file;
}

const std::filesystem::path& loaded_from() {
    static const std::filesystem::path file = own_file();
    return file;
}

/// Asked while the program or the library is loaded: its name may be relative, and the working
/// folder may change.
[[maybe_unused]] const bool asked = !loaded_from().empty();

/// `bin/relevo`, `lib/librelevo.so.0` and `lib/x86_64-linux-gnu/librelevo.so.0` are of one.
const std::filesystem::path& prefix() {
    static const std::filesystem::path found = [] {
        std::error_code ignored;
        const std::filesystem::path above = loaded_from().parent_path().parent_path();
        const bool deeper =
            !std::filesystem::exists(above / "share" / "relevo", ignored) &&
            std::filesystem::exists(above.parent_path() / "share" / "relevo", ignored);
        return deeper ? above.parent_path() : above;
    }();
    return found;
}

}  // namespace

std::filesystem::path share_dir() {
    if (const char* given = std::getenv("RELEVO_SHARE"); given && *given) return given;
    return prefix() / "share" / "relevo";
}

std::optional<std::filesystem::path> file_inside(const std::filesystem::path& folder,
                                                 const std::filesystem::path& name) {
    if (name.empty() || name.is_absolute()) return std::nullopt;
    std::error_code error;
    const std::filesystem::path inside = std::filesystem::canonical(folder, error);
    if (error) return std::nullopt;
    const std::filesystem::path file = std::filesystem::weakly_canonical(inside / name, error);
    if (error) return std::nullopt;
    const std::filesystem::path relative = file.lexically_relative(inside);
    if (relative.empty() || *relative.begin() == ".." || relative == ".") return std::nullopt;
    return folder / name;
}

std::filesystem::path module_dir() {
    return prefix() / "lib" / "relevo";
}

std::filesystem::path user_folder(const char* variable, const char* below_home) {
    const auto absolute = [](const char* name) {
        const char* const value = std::getenv(name);
        const std::filesystem::path path = value ? value : "";
        return path.is_absolute() ? path : std::filesystem::path();
    };
    if (const auto given = absolute(variable); !given.empty()) return given;
    const std::filesystem::path home = absolute("HOME");
    return home.empty() ? home : home / below_home;
}

}  // namespace relevo
