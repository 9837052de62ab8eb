#include "viewer/file_watch.h"

#include <utility>

namespace relevo::viewer {

namespace fs = std::filesystem;

void FileWatch::watch(std::vector<fs::path> paths) {
    paths_ = std::move(paths);
    known_ = last_ = look();
    first_count_ = known_.size();
}

FileWatch::Times FileWatch::look() const {
    Times times;
    std::error_code ignored;
    for (const fs::path& file : paths_) {
        const fs::file_time_type time = fs::last_write_time(file, ignored);
        if (!ignored) times[file] = time;
    }
    return times;
}

bool FileWatch::changed() {
    Times now = look();
    const bool rests = now == last_;
    last_ = std::move(now);
    if (!rests || last_ == known_) return false;
    known_ = last_;
    return true;
}

}  // namespace relevo::viewer
