#include "base/link_walk.h"

#include <cerrno>
#include <climits>
#include <deque>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace relevo {
namespace {

constexpr int kMostLinks = 40;  // as many as the kernel follows

/// Whether a link in an open folder may be somebody else's trap.
bool is_foreign(int folder, const struct stat& link) {
    struct stat in {};
    if (fstat(folder, &in) != 0) return true;
    const bool open_to_others = in.st_mode & (S_IWGRP | S_IWOTH);
    return open_to_others && link.st_uid != geteuid() && link.st_uid != in.st_uid &&
           link.st_uid != 0;
}

class Walk {
  public:
    explicit Walk(const std::filesystem::path& path) { follow(path); }
    ~Walk() {
        if (folder_ >= 0) close(folder_);
    }

    LinkWalk run() {
        LinkWalk result;
        while (error_ == 0 && !parts_.empty()) {
            const std::filesystem::path part = std::move(parts_.front());
            parts_.pop_front();
            struct stat status {};
            const bool exists = fstatat(folder_, part.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0;
            const bool is_last = parts_.empty();
            if (exists && S_ISLNK(status.st_mode)) {
                if (is_foreign(folder_, status)) {
                    result.foreign_link = (so_far_ / part).lexically_normal();
                    return result;
                }
                follow_link(part);
            } else if (is_last && (exists || errno == ENOENT)) {
                result.leaf = part.string();
                result.folder = std::exchange(folder_, -1);
                return result;
            } else {
                enter(part);
            }
        }
        result.error = error_ != 0 ? error_ : EISDIR;
        return result;
    }

  private:
    /// Puts a path before what is left.
    void follow(const std::filesystem::path& path) {
        if (folder_ < 0 || path.is_absolute())
            move_to(open(path.is_absolute() ? "/" : ".", kFolder));
        if (path.is_absolute()) so_far_ = "/";
        std::deque<std::filesystem::path> parts;
        for (const std::filesystem::path& part : path.relative_path())
            if (!part.empty() && part != ".") parts.push_back(part);
        parts_.insert(parts_.begin(), parts.begin(), parts.end());
    }

    void follow_link(const std::filesystem::path& part) {
        std::string target(PATH_MAX, '\0');
        const ssize_t length = readlinkat(folder_, part.c_str(), target.data(), target.size());
        if (length <= 0 || ++links_ > kMostLinks) {
            error_ = length < 0 ? errno : ELOOP;
            return;
        }
        target.resize(static_cast<std::size_t>(length));
        follow(target);
    }

    void enter(const std::filesystem::path& part) {
        move_to(openat(folder_, part.c_str(), kFolder | O_NOFOLLOW));
        so_far_ /= part;
    }

    void move_to(int folder) {
        if (folder < 0) {
            error_ = errno;
            return;
        }
        if (folder_ >= 0) close(folder_);
        folder_ = folder;
    }

    static constexpr int kFolder = O_PATH | O_DIRECTORY | O_CLOEXEC;
    int folder_ = -1;
    int error_ = 0;
    int links_ = 0;
    std::filesystem::path so_far_;  ///< of folder_, for messages
    std::deque<std::filesystem::path> parts_;
};

}  // namespace

LinkWalk walk_links(const std::filesystem::path& path) {
    return Walk(path).run();
}

}  // namespace relevo
