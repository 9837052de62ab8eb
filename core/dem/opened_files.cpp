#include "dem/opened_files.h"

#include <system_error>
#include <tuple>

#include <sys/stat.h>

namespace relevo::dem {
namespace {

/// Paths without links; empty ones for what is no file of this machine.
std::vector<std::filesystem::path> real_paths(std::span<const std::string> paths) {
    std::vector<std::filesystem::path> real;
    for (const std::string& path : paths) {
        std::error_code none;
        real.push_back(std::filesystem::canonical(path, none));
    }
    return real;
}

}  // namespace

OpenedFiles::OpenedFiles(std::span<const std::string> paths) : real_(real_paths(paths)) {
    clock_gettime(CLOCK_REALTIME_COARSE, &before_);  // that of the times of files
}

bool OpenedFiles::are_elsewhere(std::span<const std::string> paths) const {
    return real_paths(paths) != real_;
}

bool OpenedFiles::may_have_changed(const std::filesystem::path& file) const {
    const auto is_older = [&](const struct stat& status) {
        return std::tie(status.st_ctim.tv_sec, status.st_ctim.tv_nsec) <
               std::tie(before_.tv_sec, before_.tv_nsec);
    };
    struct stat of_file {
    }, of_link{};
    return stat(file.c_str(), &of_file) != 0 || !is_older(of_file) ||
           lstat(file.c_str(), &of_link) != 0 || !is_older(of_link);
}

}  // namespace relevo::dem
