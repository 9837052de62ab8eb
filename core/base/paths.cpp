#include "base/paths.h"

#include <cstdlib>

namespace relevo {
namespace {

std::filesystem::path prefix() {
    std::error_code ignored;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    return program.parent_path().parent_path();
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

}  // namespace relevo
