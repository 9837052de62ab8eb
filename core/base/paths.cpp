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

std::filesystem::path module_dir() {
    return prefix() / "lib" / "relevo";
}

}  // namespace relevo
