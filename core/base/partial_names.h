#pragma once

#include <string>

namespace relevo {

/// A file of a random name in a folder, which remove_partial_files() knows of as long as this is
/// there.
class PartialName {
  public:
    /// @param folder  descriptor of the folder, open as long as this
    explicit PartialName(int folder);
    ~PartialName();
    PartialName(const PartialName&) = delete;
    PartialName& operator=(const PartialName&) = delete;

    const char* name() const;

    /// The file has another name now, or none: nothing is left to remove.
    void forget();

  private:
    int slot_;
};

}  // namespace relevo
