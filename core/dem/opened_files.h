#pragma once

#include <ctime>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace relevo::dem {

/// What was known of a DEM's files before they were opened: tells later whether the open files are
/// still those of these names.
class OpenedFiles {
  public:
    /// To be made before the files are opened.
    /// @param paths  as Source::open() takes them
    explicit OpenedFiles(std::span<const std::string> paths);

    /// Whether one of the paths, or a folder on its way, has become a link to something else.
    bool are_elsewhere(std::span<const std::string> paths) const;

    /// Whether a file was written, or another one got its name, since then: by the time of the last
    /// change of the file or link (st_ctime), which no program can set. True in doubt: clocks of
    /// files have ticks of some milliseconds.
    bool may_have_changed(const std::filesystem::path& file) const;

  private:
    std::timespec before_{};
    std::vector<std::filesystem::path> real_;  // without links
};

}  // namespace relevo::dem
