#include "base/temporary_folder.h"

#include <cstdlib>
#include <string>
#include <system_error>

namespace relevo {

TemporaryFolder::TemporaryFolder(std::string_view name) {
    std::error_code error;
    const std::filesystem::path all = std::filesystem::temp_directory_path(error);
    std::string folder = (all / name).string() + "-XXXXXX";
    if (!error && mkdtemp(folder.data())) path_ = folder;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

}  // namespace relevo
