#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/output_file.h"

/// Files that can be made again from others, in a folder that several processes use at once.
namespace relevo {

/// A file of a CacheFolder that is being read: byte ranges in the order in which CacheWriter added
/// them, each with its checksums.
class CacheReader {
  public:
    explicit CacheReader(int descriptor) : descriptor_(descriptor) {}
    CacheReader(CacheReader&& other) noexcept
        : descriptor_(std::exchange(other.descriptor_, -1)), at_(other.at_) {}
    CacheReader& operator=(CacheReader&&) = delete;
    ~CacheReader();

    /// Reads the next range, on several threads. @returns false if it is of another length, damaged
    /// or cut short; the file is of no use then
    bool read(std::span<std::byte> bytes);
    /// The same of a range of any length up to `most`; nullopt if it is longer or damaged.
    std::optional<std::string> read_text(std::size_t most);

    template <typename T>
    bool read_values(T* first, std::size_t count) {
        return read(std::as_writable_bytes(std::span(first, count)));
    }

  private:
    int descriptor_;
    std::int64_t at_ = 0;
};

/// A file of a CacheFolder that is being written.
class CacheWriter {
  public:
    explicit CacheWriter(OutputFile& file) : file_(file) {}

    /// Adds a range. @throws Error (Failed) if the disk refuses
    void write(std::span<const std::byte> bytes);
    void write_text(std::string_view text) { write(std::as_bytes(std::span(text))); }

    template <typename T>
    void write_values(const T* first, std::size_t count) {
        write(std::as_bytes(std::span(first, count)));
    }

  private:
    OutputFile& file_;
};

/// A folder of files, each whole or absent, under names that are SHA-256 digests in hexadecimal.
/// Those that were used longest ago are removed if all together exceed a size. Files of other
/// names, and links, are nobody's business: the folder may be a link to one of the user's.
class CacheFolder {
  public:
    struct Entry {
        std::filesystem::path path;
        std::int64_t bytes = 0;
        std::filesystem::file_time_type used;
    };

    /// @param most_bytes  of all files together
    CacheFolder(std::filesystem::path folder, std::int64_t most_bytes)
        : folder_(std::move(folder)), most_bytes_(most_bytes) {}

    const std::filesystem::path& folder() const { return folder_; }
    std::int64_t most_bytes() const { return most_bytes_; }

    /// Files, the one used last first. None if the folder is absent.
    std::vector<Entry> entries() const;
    /// Removes all files. @returns why some are left; empty if none is
    std::string clear() const;

    /// Opens a file, which then is the one used last; nullopt if it is absent.
    std::optional<CacheReader> open(const std::string& name) const;
    /// The same without a note of its use.
    std::optional<CacheReader> peek(const std::string& name) const;
    /// Writes a file whole or not at all, and removes those that exceed the size. What `fill`
    /// throws ends it; so does a `fill` that returns false.
    /// @param bytes  about as many as `fill` writes
    /// @returns why the file is not there; empty if it is
    std::string write(const std::string& name, std::int64_t bytes,
                      const std::function<bool(CacheWriter&)>& fill) const;

  private:
    static bool is_own_name(std::string_view name);
    void remove_oldest(const std::string& keep) const;

    std::filesystem::path folder_;
    std::int64_t most_bytes_;
};

}  // namespace relevo
