#pragma once

#include <string>
#include <vector>

namespace relevo::test {

/// While it lives, dlopen() of this program finds no library whose name contains one of
/// these texts.
class HiddenLibraries {
  public:
    explicit HiddenLibraries(std::vector<std::string> texts);
    ~HiddenLibraries();
    HiddenLibraries(const HiddenLibraries&) = delete;
    HiddenLibraries& operator=(const HiddenLibraries&) = delete;
};

}  // namespace relevo::test
