#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace relevo::output {

/// Files that GDAL reads and writes by name, and that have no name on the disk: whatever GDAL puts
/// beside them, and however the process ends, nothing is left.
class ScratchFiles {
  public:
    /// @param open  gives a descriptor of a new unnamed file each time, which is closed here;
    ///     called by GDAL, on any thread
    explicit ScratchFiles(std::function<int()> open);
    ~ScratchFiles();
    ScratchFiles(const ScratchFiles&) = delete;
    ScratchFiles& operator=(const ScratchFiles&) = delete;

    /// How GDAL calls a file of this.
    std::string path(const std::string& name) const;
    /// Gives a file's bytes piece by piece. @return whether it could be read
    bool read(const std::string& name,
              const std::function<void(std::span<const std::byte>)>& use) const;
    /// The first reason (errno) for which the disk refused to take something; 0: it did not.
    int error() const;

    struct Folder;

  private:
    std::shared_ptr<Folder> folder_;
};

}  // namespace relevo::output
