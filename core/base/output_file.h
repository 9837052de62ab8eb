#pragma once

#include <filesystem>
#include <string>
#include <string_view>

/// Results in files: nothing is replaced unless asked for, and nothing is there in part.
namespace relevo {

/// Says before any work is done whether `path` can be written.
/// @param who  what errors begin with
/// @throws Error (BadInput) `who: path: what` if its folder does not exist or cannot be written to,
///     if it is a folder itself, or if it exists and `overwrite` is false
void check_output_file(const std::filesystem::path& path, bool overwrite, std::string_view who);

/// A name beside `path` to write to, which is removed again unless it is moved to its place.
class PartialFile {
  public:
    explicit PartialFile(const std::filesystem::path& path);
    ~PartialFile();
    PartialFile(const PartialFile&) = delete;
    PartialFile& operator=(const PartialFile&) = delete;

    const std::filesystem::path& path() const { return path_; }

    /// Gives the whole file its name.
    /// @throws Error (Failed) where the name has been taken meanwhile and `overwrite` is false, and
    ///     where the disk refuses
    void become(const std::filesystem::path& target, bool overwrite, std::string_view who) const;

  private:
    std::filesystem::path path_;
};

/// Writes a text file.
/// @throws Error as check_output_file, and (Failed) where the disk refuses
void write_text(const std::filesystem::path& path, std::string_view text, bool overwrite,
                std::string_view who);

}  // namespace relevo
