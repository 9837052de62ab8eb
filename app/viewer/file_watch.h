#pragma once

#include <filesystem>
#include <map>
#include <vector>

namespace relevo::viewer {

/// Tells when files are written: by their times, looked at now and then.
class FileWatch {
  public:
    /// Files; those that are not there are waited for.
    void watch(std::vector<std::filesystem::path> paths);
    /// Whether any has changed since the last call that said so, come or gone; after a change it
    /// waits until nothing has changed any more, so that a file is whole.
    bool changed();
    /// Whether as many files are there as were at watch().
    bool all_there() const { return last_.size() >= first_count_; }

  private:
    using Times = std::map<std::filesystem::path, std::filesystem::file_time_type>;
    Times look() const;

    std::vector<std::filesystem::path> paths_;
    Times known_, last_;
    std::size_t first_count_ = 0;
};

}  // namespace relevo::viewer
