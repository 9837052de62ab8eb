#pragma once

#include <filesystem>
#include <string_view>

namespace relevo {

/// A folder of this user alone among the temporary files ($TMPDIR, else /tmp), which is removed
/// with this.
class TemporaryFolder {
  public:
    /// @param name  with which the name of the folder begins
    explicit TemporaryFolder(std::string_view name);
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder();

    /// Empty if no folder can be made.
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace relevo
