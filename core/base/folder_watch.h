#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace relevo {

/// Reports changes of files in folders and their subfolders by inotify. A folder is listed once,
/// when it is new.
class FolderWatch {
  public:
    FolderWatch() = default;
    FolderWatch(const FolderWatch&) = delete;
    FolderWatch& operator=(const FolderWatch&) = delete;
    ~FolderWatch();

    /// Warns if the system refuses to watch a folder. Ignores folders that do not exist.
    /// @param endings  of file names: ".glsl"
    void watch(const std::vector<std::filesystem::path>& folders, std::vector<std::string> endings);
    /// Whether a file was written, created or removed since the last call that returned true.
    /// Returns true only once nothing has changed since the call before, so that files are
    /// complete.
    bool changed();

  private:
    void add(const std::filesystem::path& folder);
    bool matters(const std::filesystem::path& name) const;
    void close();

    int inotify_ = -1;
    std::map<int, std::filesystem::path> folders_;  // by inotify's numbers
    std::vector<std::string> endings_;
    bool pending_ = false;
};

}  // namespace relevo
