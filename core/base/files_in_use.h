#pragma once

#include <deque>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/output_file.h"

namespace relevo {

/// What a run reads and what it writes, so that no result replaces what it was made from, or
/// another result. Files are told apart by what they are, not by their names: links do not matter.
class FilesInUse {
  public:
    /// Adds a file that is read; one that does not exist is left to who reads it.
    /// @param what  "the DEM"
    /// @throws Error (BadInput) where an output would replace it
    void add_input(const std::filesystem::path& path, std::string_view what);

    /// Refuses results of which one would replace an input or another result, before any is opened:
    /// links are followed, also those of folders.
    /// @throws Error (BadInput) naming both files
    void check_planned(const std::vector<std::filesystem::path>& results,
                       std::string_view who) const;

    /// Opens a file that is written; it lives as long as this.
    /// @param who  the option that names it, "--timings"
    /// @throws Error (BadInput) where it would replace an input, (Usage) where it is another
    ///     output, and as OutputFile does
    OutputFile& open_output(const std::filesystem::path& path, bool overwrite,
                            std::string_view who);

    /// The same, but its life, and its finish(), are the caller's: for results that come one after
    /// the other. Later inputs are not held against it.
    OutputFile open_alone(const std::filesystem::path& path, bool overwrite,
                          std::string_view who) const;

    /// Finishes all that was opened: results of one run appear together or not at all.
    /// @throws Error as OutputFile::finish_all()
    void finish_outputs();

    /// Some output would replace a file.
    bool replaces_any() const;

  private:
    struct Input {
        std::filesystem::path path;
        std::string what;
    };
    std::vector<Input> inputs_;
    std::set<std::string> input_names_;
    std::deque<OutputFile> outputs_;
};

}  // namespace relevo
