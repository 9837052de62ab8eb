#include "base/folder_watch.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <sys/inotify.h>
#include <unistd.h>

#include "base/contains.h"
#include "base/log.h"

namespace relevo {

namespace fs = std::filesystem;

FolderWatch::~FolderWatch() {
    close();
}

void FolderWatch::close() {
    if (inotify_ >= 0) ::close(inotify_);
    inotify_ = -1;
    folders_.clear();
}

void FolderWatch::watch(const std::vector<fs::path>& folders, std::vector<std::string> endings) {
    close();
    endings_ = std::move(endings);
    pending_ = false;
    inotify_ = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    std::error_code ignored;
    for (const fs::path& folder : folders)
        if (fs::is_directory(folder, ignored)) add(folder);
}

void FolderWatch::add(const fs::path& folder) {
    const int number = inotify_add_watch(
        inotify_, folder.c_str(), IN_CLOSE_WRITE | IN_CREATE | IN_DELETE | IN_MOVE | IN_ONLYDIR);
    if (number < 0) {
        if (errno != ENOENT)
            log::warning(fmt::format(
                "{}: changes of its files are not noticed ({}); F5 in the window reads effects "
                "again",
                folder.string(), std::strerror(errno)));
        return;
    }
    folders_[number] = folder;
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
        if (entry.is_directory(ignored) && !entry.is_symlink(ignored)) add(entry.path());
}

bool FolderWatch::matters(const fs::path& name) const {
    return contains(endings_, name.extension().string());
}

bool FolderWatch::changed() {
    bool rests = true;
    alignas(inotify_event) std::array<char, 16 * 1024> buffer;
    for (ssize_t length = 0; (length = ::read(inotify_, buffer.data(), buffer.size())) > 0;)
        for (ssize_t at = 0; at < length;) {
            const auto& event = *reinterpret_cast<const inotify_event*>(buffer.data() + at);
            at += static_cast<ssize_t>(sizeof event + event.len);
            const auto folder = folders_.find(event.wd);
            const bool is_folder = (event.mask & IN_ISDIR) != 0;
            if (is_folder && folder != folders_.end() && (event.mask & (IN_CREATE | IN_MOVED_TO)))
                add(folder->second / event.name);
            // With a folder come files, and go.
            if (is_folder || (event.mask & IN_Q_OVERFLOW) || (event.len > 0 && matters(event.name)))
                rests = false;
        }
    if (!rests) pending_ = true;
    return rests && std::exchange(pending_, false);
}

}  // namespace relevo
