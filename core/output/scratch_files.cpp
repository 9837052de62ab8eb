#include "output/scratch_files.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <map>
#include <mutex>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dem/gdal.h"

namespace relevo::output {

namespace {

constexpr const char* kPrefix = "/vsirelevo/";

struct File {
    int descriptor;

    explicit File(int number) : descriptor(number) {}
    ~File() { close(descriptor); }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
};

}  // namespace

struct ScratchFiles::Folder {
    std::string name;
    std::function<int()> open;
    std::map<std::string, std::shared_ptr<File>, std::less<>> files;
    std::atomic<int> error = 0;

    void note(int reason) {
        int none = 0;
        error.compare_exchange_strong(none, reason);
    }
};

namespace {

/// All that GDAL may ask for.
struct Folders {
    std::mutex mutex;
    std::map<std::string, std::shared_ptr<ScratchFiles::Folder>, std::less<>> by_name;
    int made = 0;
};
Folders& folders() {
    static Folders& all = *new Folders;  // GDAL has it until the process ends
    return all;
}

/// "3/whole.tif" as a folder and a name in it. With the lock held.
std::pair<std::shared_ptr<ScratchFiles::Folder>, std::string> find(std::string_view path) {
    while (path.starts_with('/'))
        path.remove_prefix(1);
    const std::size_t slash = std::min(path.find('/'), path.size());
    const auto found = folders().by_name.find(path.substr(0, slash));
    if (found == folders().by_name.end()) return {};
    return {found->second, std::string(path.substr(std::min(slash + 1, path.size())))};
}

/// What GDAL has open.
struct Handle {
    std::shared_ptr<ScratchFiles::Folder> folder;
    std::shared_ptr<File> file;
    off_t at = 0;
    bool ended = false;
};

void* open_file(void*, const char* path, const char* mode) {
    const std::lock_guard lock(folders().mutex);
    const auto [folder, name] = find(path);
    if (!folder || name.empty()) {
        errno = ENOENT;
        return nullptr;
    }
    auto found = folder->files.find(name);
    if (mode[0] == 'w') {
        if (found != folder->files.end()) folder->files.erase(found);
        try {
            found = folder->files.emplace(name, std::make_shared<File>(folder->open())).first;
        } catch (const std::exception&) {
            folder->note(errno != 0 ? errno : EIO);
            return nullptr;
        }
    }
    if (found == folder->files.end()) {
        errno = ENOENT;
        return nullptr;
    }
    auto handle = std::make_unique<Handle>(Handle{folder, found->second});
    if (mode[0] == 'a') handle->at = lseek(handle->file->descriptor, 0, SEEK_END);
    return handle.release();
}

off_t size_of(const File& file) {
    struct stat about {};
    return fstat(file.descriptor, &about) == 0 ? about.st_size : 0;
}

int seek(void* opaque, vsi_l_offset offset, int whence) {
    Handle& handle = *static_cast<Handle*>(opaque);
    const auto by = static_cast<off_t>(offset);
    handle.at = whence == SEEK_SET   ? by
                : whence == SEEK_CUR ? handle.at + by
                                     : size_of(*handle.file) + by;
    handle.ended = false;
    return 0;
}

/// Bytes by as many calls as the system needs.
template <typename Call>
std::size_t in_pieces(std::size_t bytes, off_t at, const Call& call) {
    std::size_t done = 0;
    while (done < bytes) {
        const ssize_t count = call(done, bytes - done, at + static_cast<off_t>(done));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        done += static_cast<std::size_t>(count);
    }
    return done;
}

std::size_t read_items(void* opaque, void* to, std::size_t size, std::size_t count) {
    Handle& handle = *static_cast<Handle*>(opaque);
    const std::size_t done =
        in_pieces(size * count, handle.at, [&](std::size_t from, std::size_t bytes, off_t at) {
            return pread(handle.file->descriptor, static_cast<char*>(to) + from, bytes, at);
        });
    handle.at += static_cast<off_t>(done);
    handle.ended = done < size * count;
    return size == 0 ? 0 : done / size;
}

std::size_t write_items(void* opaque, const void* from, std::size_t size, std::size_t count) {
    Handle& handle = *static_cast<Handle*>(opaque);
    const std::size_t done =
        in_pieces(size * count, handle.at, [&](std::size_t first, std::size_t bytes, off_t at) {
            return pwrite(handle.file->descriptor, static_cast<const char*>(from) + first, bytes,
                          at);
        });
    if (done < size * count) handle.folder->note(errno != 0 ? errno : ENOSPC);
    handle.at += static_cast<off_t>(done);
    return size == 0 ? 0 : done / size;
}

int truncate_file(void* opaque, vsi_l_offset size) {
    Handle& handle = *static_cast<Handle*>(opaque);
    const int result = ftruncate(handle.file->descriptor, static_cast<off_t>(size));
    if (result != 0) handle.folder->note(errno);
    return result;
}

int stat_file(void*, const char* path, VSIStatBufL* about, int) {
    const std::lock_guard lock(folders().mutex);
    const auto [folder, name] = find(path);
    *about = {};
    if (folder && name.empty()) {
        about->st_mode = S_IFDIR | 0700;
        return 0;
    }
    const auto found = folder ? folder->files.find(name) : decltype(folder->files.begin()){};
    if (!folder || found == folder->files.end()) return -1;
    about->st_mode = S_IFREG | 0600;
    about->st_size = size_of(*found->second);
    return 0;
}

int remove_file(void*, const char* path) {
    const std::lock_guard lock(folders().mutex);
    const auto [folder, name] = find(path);
    return folder && folder->files.erase(name) > 0 ? 0 : -1;
}

void install() {
    static std::once_flag once;
    std::call_once(once, [] {
        VSIFilesystemPluginCallbacksStruct* const calls = VSIAllocFilesystemPluginCallbacksStruct();
        calls->open = open_file;
        calls->stat = stat_file;
        calls->unlink = remove_file;
        calls->tell = [](void* handle) -> vsi_l_offset {
            return static_cast<vsi_l_offset>(static_cast<Handle*>(handle)->at);
        };
        calls->seek = seek;
        calls->read = read_items;
        calls->eof = [](void* handle) { return int{static_cast<Handle*>(handle)->ended}; };
        calls->write = write_items;
        calls->flush = [](void*) { return 0; };
        calls->truncate = truncate_file;
        calls->close = [](void* handle) {
            delete static_cast<Handle*>(handle);
            return 0;
        };
        VSIInstallPluginHandler(kPrefix, calls);
        VSIFreeFilesystemPluginCallbacksStruct(calls);
    });
}

}  // namespace

ScratchFiles::ScratchFiles(std::function<int()> open) : folder_(std::make_shared<Folder>()) {
    install();
    folder_->open = std::move(open);
    const std::lock_guard lock(folders().mutex);
    folder_->name = fmt::format("{}", folders().made++);
    folders().by_name[folder_->name] = folder_;
}

ScratchFiles::~ScratchFiles() {
    const std::lock_guard lock(folders().mutex);
    folders().by_name.erase(folder_->name);
}

std::string ScratchFiles::path(const std::string& name) const {
    return kPrefix + folder_->name + "/" + name;
}

bool ScratchFiles::read(const std::string& name,
                        const std::function<void(std::span<const std::byte>)>& use) const {
    const auto found = folder_->files.find(name);
    if (found == folder_->files.end()) return false;
    std::array<std::byte, 1 << 16> buffer;
    for (off_t at = 0;;) {
        const ssize_t count = pread(found->second->descriptor, buffer.data(), buffer.size(), at);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        if (count == 0) return true;
        use(std::span(buffer).first(static_cast<std::size_t>(count)));
        at += count;
    }
}

int ScratchFiles::error() const {
    return folder_->error;
}

}  // namespace relevo::output
