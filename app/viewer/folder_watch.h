#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace relevo::viewer {

/// Tells when files of some kinds are written in folders, or in those inside them, by what the
/// system says of them (inotify). A folder is listed once, when it is new.
class FolderWatch {
  public:
    FolderWatch() = default;
    FolderWatch(const FolderWatch&) = delete;
    FolderWatch& operator=(const FolderWatch&) = delete;
    ~FolderWatch();

    /// Warns if the system refuses to watch a folder. Folders that do not exist are ignored.
    /// @param endings  of names that matter: ".glsl"
    void watch(const std::vector<std::filesystem::path>& folders, std::vector<std::string> endings);
    /// Whether any such file has been written, has come or gone since the last call that said so;
    /// after a change it waits for a call before which nothing has changed any more, so that a
    /// file is whole.
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

}  // namespace relevo::viewer
