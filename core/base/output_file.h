#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Results in files: nothing is replaced unless asked for, and nothing is there in part.
namespace relevo {

/// A result on its way to its file.
///
/// The constructor opens the place where the result is gathered, so that what cannot be written is
/// refused before any work is done: an unnamed file in the folder of the result where the file
/// system offers one, which vanishes however the process ends; elsewhere a file of a random name
/// there, which the destructor and remove_partial_files() remove. finish() gives it its name.
///
/// A symbolic link is followed, and stays. A file that is replaced keeps its permissions, not its
/// owner, and its other hard links keep the old content; a new one has those that the umask leaves.
/// What is no regular file (a FIFO, a terminal, /dev/stdout) is written to as it is, at the end. An
/// object of a store (base/object_store.h) is gathered in the folder for temporary files, and put
/// there at the end; where the store refuses it the result stays in that folder, and the error
/// names it.
class OutputFile {
  public:
    /// @param overwrite  an existing regular file may be replaced
    /// @param who  what errors begin with
    /// @throws Error (BadInput) `who: path: what` where the path is a folder, has none, exists and
    ///     may not be replaced, is too long, or leads to where nothing can be written
    OutputFile(const std::filesystem::path& path, bool overwrite, std::string_view who);
    OutputFile(OutputFile&&) noexcept;
    OutputFile& operator=(OutputFile&&) noexcept;
    ~OutputFile();

    const std::filesystem::path& path() const;  ///< as it was given
    const std::string& who() const;

    /// Adds to the file. @throws Error (Failed) where the disk refuses
    void write(std::span<const std::byte> bytes);
    void write(std::string_view text);

    /// The open file, for encoders that seek in it; the file keeps the descriptor. What write()
    /// adds goes to the descriptor's position.
    int descriptor() const;

    /// Gives the file its name, once what was written is on the disk; called once.
    /// @throws Error (Failed) where the name has been taken meanwhile and may not be replaced, and
    ///     where the disk refuses
    void finish();

    /// Opens a file without a name in the folder of the result, for what is on the way to it; the
    /// system frees it with the descriptor, however the process ends. The caller closes it.
    /// @throws Error (Failed) where the disk refuses
    int open_scratch() const;

    /// finish() of all results of a run, which appear together or not at all: none has its name
    /// before all are on the disk or have gone to their devices and pipes, and where one cannot
    /// have its name the others lose theirs. What has replaced a file stays; its turn is last.
    static void finish_all(const std::vector<OutputFile*>& files);

    /// finish() would replace that file, by whichever of its names it is known.
    bool replaces(const std::filesystem::path& other) const;
    /// finish() would replace a file.
    bool replaces_any() const;
    /// Both would go to the same regular file.
    bool same_as(const OutputFile& other) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Whether a result of this name would replace something: a file, a broken link, an object of a
/// store.
/// @throws Error (BadInput) where a store does not say
bool is_taken(const std::filesystem::path& path);

/// Removes a result, a file or an object. Does nothing where it cannot.
void remove_result(const std::filesystem::path& path) noexcept;

/// Makes the folder that a result is to lie in, and those around it; stores have none.
/// @throws Error (BadInput) `who: folder: the folder cannot be made, why`
void make_folder_of(const std::filesystem::path& path, std::string_view who);

/// Writes a text file whole: OutputFile, write() and finish().
/// @throws Error as they do
void write_text(const std::filesystem::path& path, std::string_view text, bool overwrite,
                std::string_view who);

/// Removes what OutputFile has under random names, of this process. Safe in a signal handler.
void remove_partial_files() noexcept;

/// Calls remove_partial_files() where a signal that asks for it ends the process (INT, TERM, HUP,
/// QUIT, PIPE, XCPU), which ends by that signal nonetheless; what is ignored stays ignored. Also
/// has writes beyond a limit on file sizes fail, instead of ending the process (XFSZ).
void remove_partial_files_at_signals();

}  // namespace relevo
