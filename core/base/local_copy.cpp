#include "base/local_copy.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "base/object_store.h"
#include "base/text.h"

namespace relevo {

LocalCopy::LocalCopy(const std::filesystem::path& result, std::string_view who) : path_(result) {
    const ObjectStore* const store = object_store_of(result.native());
    if (!store) return;
    const auto refuse = [&](const std::filesystem::path& what) {
        failed(fmt::format("{}: {}: cannot be copied to {}, {}", who, printable(result.string()),
                           printable(what.string()), std::strerror(errno)));
    };
    folder_.emplace("relevo-copy");
    if (folder_->path().empty()) refuse("a folder for temporary files");
    path_ = folder_->path() / result.filename();
    const int file = open(path_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0600);
    if (file < 0) refuse(path_);
    bool is_there = false;
    try {
        is_there = store->get(result.native(), file);
    } catch (...) {
        close(file);
        throw;
    }
    close(file);
    if (!is_there) unlink(path_.c_str());
}

}  // namespace relevo
