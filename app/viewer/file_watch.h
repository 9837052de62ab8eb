#pragma once

#include <filesystem>
#include <map>
#include <vector>

namespace relevo::viewer {

/// Reports changes of files by polling their modification times.
class FileWatch {
  public:
    /// Sets the files. They need not exist yet.
    void watch(std::vector<std::filesystem::path> paths);
    /// Whether a file was written, created or removed since the last call that returned true.
    /// Returns true only once nothing has changed since the call before, so that files are
    /// complete.
    bool changed();
    /// Whether as many files exist as at watch().
    bool all_there() const { return last_.size() >= first_count_; }

  private:
    using Times = std::map<std::filesystem::path, std::filesystem::file_time_type>;
    Times look() const;

    std::vector<std::filesystem::path> paths_;
    Times known_, last_;
    std::size_t first_count_ = 0;
};

}  // namespace relevo::viewer
