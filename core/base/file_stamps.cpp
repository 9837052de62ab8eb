#include "base/file_stamps.h"

#include <algorithm>

#include <sys/stat.h>

namespace relevo {
namespace {

/// File systems take times from a clock that advances in steps of up to 10 ms.
constexpr auto kClockStep = std::chrono::milliseconds(20);
constexpr std::int64_t kNsPerS = 1'000'000'000;

}  // namespace

FileStamps::Stamp FileStamps::stamp_of(const std::filesystem::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return {};
    return {status.st_dev, status.st_ino, status.st_size,
            status.st_ctim.tv_sec * kNsPerS + status.st_ctim.tv_nsec};
}

void FileStamps::add(const std::filesystem::path& path) {
    const Stamp& stamp = stamps_.emplace_back(path, stamp_of(path)).second;
    const auto from = std::chrono::nanoseconds((read_from_ - kClockStep).time_since_epoch());
    if (stamp.changed_ns >= from.count()) changed_while_read_ = true;
}

bool FileStamps::hold() const {
    return !changed_while_read_ && std::ranges::all_of(stamps_, [](const auto& each) {
        return stamp_of(each.first) == each.second;
    });
}

}  // namespace relevo
