#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "base/temporary_folder.h"

namespace relevo {

/// A result that is read: a file is read where it is, an object of a store from a copy among the
/// temporary files, which is removed with this.
class LocalCopy {
  public:
    /// Where there is no such file or object, path() names nothing.
    /// @param who  what errors begin with
    /// @throws Error (BadInput) where a store gives no answer, (Failed) where the disk refuses
    LocalCopy(const std::filesystem::path& result, std::string_view who);

    /// Ends as the result's name does.
    const std::filesystem::path& path() const { return path_; }

  private:
    std::optional<TemporaryFolder> folder_;
    std::filesystem::path path_;
};

}  // namespace relevo
