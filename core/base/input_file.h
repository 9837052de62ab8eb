#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "base/allowed_name.h"

namespace relevo {

/// A regular file that is open for reading. Pipes and devices, which may never end and may keep
/// whoever opens them waiting, are refused.
class InputFile {
  public:
    /// @param who  what errors begin with
    /// @throws Error (BadInput) `who: name: cannot be read, reason`
    InputFile(const AllowedName& name, std::string_view who);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    int descriptor() const { return descriptor_; }
    /// When it was opened [bytes]. Files that the kernel makes up may say 0 and have more.
    std::uint64_t size() const { return size_; }

  private:
    int descriptor_ = -1;
    std::uint64_t size_ = 0;
};

/// Bytes, one after the other.
using InputStream = std::ifstream;

/// A stream; not good() where there is no such file.
InputStream input_stream(const AllowedName& name);

}  // namespace relevo
