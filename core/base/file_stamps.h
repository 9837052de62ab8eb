#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace relevo {

/// Detects that files or folders have changed since they were read, by inode, size and the time of
/// their last change of status.
class FileStamps {
  public:
    /// Make it before the first file is read. A file that changed since then may have been read as
    /// it was before, and counts as changed.
    FileStamps() = default;

    /// Adds a file or folder that has been read. It may not exist. Links are followed.
    void add(const std::filesystem::path& path);
    /// Whether none has changed, appeared or been removed.
    bool hold() const;
    /// Whether the same files were added, as they were then.
    bool operator==(const FileStamps& other) const { return stamps_ == other.stamps_; }

  private:
    using Clock = std::chrono::system_clock;
    struct Stamp {
        std::uint64_t device = 0, inode = 0;  // 0: no such file
        std::int64_t size = 0, changed_ns = 0;
        bool operator==(const Stamp&) const = default;
    };
    static Stamp stamp_of(const std::filesystem::path& path);

    Clock::time_point read_from_ = Clock::now();
    std::vector<std::pair<std::filesystem::path, Stamp>> stamps_;
    bool changed_while_read_ = false;
};

}  // namespace relevo
