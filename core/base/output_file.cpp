#include "base/output_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/stat.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/link_walk.h"
#include "base/object_store.h"
#include "base/partial_names.h"
#include "base/text.h"

namespace relevo {
namespace {

constexpr mode_t kNewFile = 0666;  ///< less the umask
constexpr mode_t kPermissions = 0777;

/// An open file, closed at the end.
class Descriptor {
  public:
    explicit Descriptor(int number = -1) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    ~Descriptor() {
        if (number_ >= 0) close(number_);
    }
    int get() const { return number_; }
    explicit operator bool() const { return number_ >= 0; }

  private:
    int number_;
};

bool same_file(const struct stat& a, const struct stat& b) {
    return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// How /proc calls an open file; a link to it is a link to the file.
std::string proc_name(int descriptor) {
    return fmt::format("/proc/self/fd/{}", descriptor);
}

/// The file system, or the kernel, has no such call.
bool not_offered(int error) {
    return error == EOPNOTSUPP || error == ENOSYS || error == EINVAL || error == EISDIR;
}

/// /dev/stdout and its kin mean the stream as it is, its place in a file included; to open what
/// they lead to would begin that file anew.
Descriptor standard_stream(const std::filesystem::path& path, const struct stat& target) {
    const std::string text = path.lexically_normal().string();
    if (!text.starts_with("/dev/") && !text.starts_with("/proc/")) return Descriptor();
    for (const int number : {STDOUT_FILENO, STDERR_FILENO}) {
        struct stat stream {};
        if (fstat(number, &stream) == 0 && same_file(stream, target)) {
            std::fflush(number == STDOUT_FILENO ? stdout : stderr);
            return Descriptor(fcntl(number, F_DUPFD_CLOEXEC, 3));
        }
    }
    return Descriptor();
}

}  // namespace

struct OutputFile::Impl {
    std::filesystem::path path;  ///< as it was given
    std::string who;
    bool overwrite = false;
    Descriptor folder;  ///< of the file, its links followed
    std::string leaf;   ///< the file's name there
    std::optional<mode_t> replaced_mode;
    Descriptor special;                  ///< what is no regular file, open for writing
    std::optional<PartialName> part;     ///< after `folder`, which it needs to its end
    Descriptor file;                     ///< where the result is gathered
    const ObjectStore* store = nullptr;  ///< that the path names an object of

    [[noreturn]] void refuse(const std::string& what) const {
        bad_input(fmt::format("{}: {}: {}", who, printable(path.string()), what));
    }
    [[noreturn]] void cannot_be_written(int error) const {
        failed(fmt::format("{}: {}: cannot be written, {}", who, printable(path.string()),
                           std::strerror(error)));
    }

    void open();
    void open_special(const struct stat& target);
    void open_object();
    void open_folder();
    void check_replaceable(const struct stat& target) const;
    void open_part();
    void settle() const;
    void deliver_special() const;
    void put_object();
    std::filesystem::path kept_path() const;
    void give_name();
    void take_name() const;
    void name_unnamed();
    void name_part();
    void take_back() const noexcept;
    void sync_folder() const;
};

void OutputFile::Impl::open() {
    store = object_store_of(path.native());
    if (store) return open_object();
    const std::string name = path.filename().string();
    const std::filesystem::path given_folder =
        path.parent_path().empty() ? std::filesystem::path(".") : path.parent_path();
    std::error_code error;
    if (!std::filesystem::is_directory(given_folder, error)) {
        if (error && error != std::errc::no_such_file_or_directory &&
            error != std::errc::not_a_directory)
            refuse(fmt::format("cannot be written, {}", error.message()));
        refuse(fmt::format("the folder {} does not exist; create it first",
                           printable(given_folder.string())));
    }
    struct stat target {};
    const bool exists = stat(path.c_str(), &target) == 0;
    const int reason = errno;
    if (name.empty() || name == "." || name == ".." || (exists && S_ISDIR(target.st_mode)))
        refuse("is a folder");
    if (!exists) {
        struct stat link {};
        if (reason != ENOENT) refuse(fmt::format("cannot be written, {}", std::strerror(reason)));
        // Someone else may have put it there, to have a file made where they may not.
        if (lstat(path.c_str(), &link) == 0)
            refuse("is a broken symbolic link; remove it, or create its target");
        open_folder();
        return open_part();
    }
    Descriptor stream = standard_stream(path, target);
    if (stream || !S_ISREG(target.st_mode)) {
        special = std::move(stream);
        return open_special(target);
    }
    if (!overwrite) refuse("exists; pass --overwrite to replace it");
    // Asks the kernel, which may protect links in folders that everyone can write to.
    if (const Descriptor followed(::open(path.c_str(), O_PATH | O_CLOEXEC)); !followed)
        refuse(fmt::format("cannot be written, {}", std::strerror(errno)));
    open_folder();
    check_replaceable(target);
    replaced_mode = target.st_mode & kPermissions;
    open_part();
}

void OutputFile::Impl::open_special(const struct stat& target) {
    if (!special && (S_ISBLK(target.st_mode) || S_ISSOCK(target.st_mode)))
        refuse(
            fmt::format("is a {}, expected a file", S_ISBLK(target.st_mode) ? "disk" : "socket"));
    // A FIFO opens when someone reads it.
    if (!special) special = Descriptor(::open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
    if (!special) refuse(fmt::format("cannot be written, {}", std::strerror(errno)));
    // Formats that go back in the file need one.
    file = Descriptor(memfd_create("relevo", MFD_CLOEXEC));
    if (!file) cannot_be_written(errno);
}

/// What is on the way to the store lies in a folder of this machine.
void OutputFile::Impl::open_object() {
    store->check_writable(path.native());
    if (!overwrite && store->exists(path.native()))
        refuse("exists; pass --overwrite to replace it");
    std::error_code error;
    const std::filesystem::path scratch = std::filesystem::temp_directory_path(error);
    if (error) refuse(fmt::format("no folder for temporary files, {}", error.message()));
    folder = Descriptor(::open(scratch.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!folder)
        refuse(fmt::format("the folder {} cannot be written to, {}", printable(scratch.string()),
                           std::strerror(errno)));
    leaf = fmt::format("relevo-{}-{}", getpid(), path.filename().string());
    open_part();
}

void OutputFile::Impl::open_folder() {
    const LinkWalk found = walk_links(path);
    if (!found.foreign_link.empty())
        refuse(
            fmt::format("the link {} is another user's, in a folder that others can write to; "
                        "name the place that it leads to",
                        printable(found.foreign_link.string())));
    if (found.folder < 0) refuse(fmt::format("cannot be written, {}", std::strerror(found.error)));
    leaf = found.leaf;
    // One may write to folders that one may not list.
    folder = Descriptor(found.folder);
    if (Descriptor listed(openat(found.folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC)); listed)
        folder = std::move(listed);
    else if (errno != EACCES)
        refuse(fmt::format("the folder {} cannot be written to, {}",
                           printable(path.parent_path().string()), std::strerror(errno)));
}

/// A rename could do without the permission to write to the file, and fails for the rest only in
/// the end.
void OutputFile::Impl::check_replaceable(const struct stat& target) const {
    if (faccessat(folder.get(), leaf.c_str(), W_OK, AT_EACCESS) != 0)
        refuse(fmt::format("may not be replaced, {}", std::strerror(errno)));
    struct stat parent {};
    if (fstat(folder.get(), &parent) == 0 && (parent.st_mode & S_ISVTX) && geteuid() != 0 &&
        geteuid() != target.st_uid && geteuid() != parent.st_uid)
        refuse("may not be replaced, it belongs to another user");
    struct statx more {};
    if (statx(folder.get(), leaf.c_str(), 0, STATX_BASIC_STATS, &more) != 0) return;
    if (more.stx_attributes & (STATX_ATTR_IMMUTABLE | STATX_ATTR_APPEND))
        refuse("may not be replaced, it is marked as immutable");
    if (more.stx_attributes & more.stx_attributes_mask & STATX_ATTR_MOUNT_ROOT)
        refuse("is a mount point and cannot be replaced; mount its folder instead");
}

void OutputFile::Impl::open_part() {
    file = Descriptor(openat(folder.get(), ".", O_TMPFILE | O_RDWR | O_CLOEXEC, kNewFile));
    // Without /proc it could not be given a name.
    if (file && access(proc_name(file.get()).c_str(), F_OK) == 0) return;
    if (file || not_offered(errno)) {
        file = Descriptor();
        part.emplace(folder.get());
        file = Descriptor(openat(folder.get(), part->name(),
                                 O_CREAT | O_EXCL | O_NOFOLLOW | O_RDWR | O_CLOEXEC, kNewFile));
        if (file) return;
    }
    const int error = errno;
    if (error != EACCES && error != EROFS && error != EPERM) cannot_be_written(error);
    const std::filesystem::path parent = path.parent_path();
    refuse(fmt::format("the folder {} cannot be written to, {}",
                       parent.empty() ? "." : printable(parent.string()), std::strerror(error)));
}

OutputFile::OutputFile(const std::filesystem::path& path, bool overwrite, std::string_view who)
    : impl_(std::make_unique<Impl>()) {
    impl_->path = path;
    impl_->who = who;
    impl_->overwrite = overwrite;
    impl_->open();
}

OutputFile::OutputFile(OutputFile&&) noexcept = default;
OutputFile& OutputFile::operator=(OutputFile&&) noexcept = default;
OutputFile::~OutputFile() = default;

const std::filesystem::path& OutputFile::path() const {
    return impl_->path;
}

const std::string& OutputFile::who() const {
    return impl_->who;
}

void OutputFile::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(impl_->file.get(), bytes.data(), bytes.size());
        if (written >= 0)
            bytes = bytes.subspan(static_cast<std::size_t>(written));
        else if (errno != EINTR)
            impl_->cannot_be_written(errno);
    }
}

void OutputFile::write(std::string_view text) {
    write(std::as_bytes(std::span(text)));
}

int OutputFile::descriptor() const {
    return impl_->file.get();
}

int OutputFile::open_scratch() const {
    // What is no regular file has no folder of ours.
    if (!impl_->folder) {
        const int memory = memfd_create("relevo", MFD_CLOEXEC);
        if (memory < 0) impl_->cannot_be_written(errno);
        return memory;
    }
    const int in = impl_->folder.get();
    const int unnamed = openat(in, ".", O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (unnamed >= 0) return unnamed;
    if (!not_offered(errno)) impl_->cannot_be_written(errno);
    const PartialName name(in);  // which goes with this
    const int named =
        openat(in, name.name(), O_CREAT | O_EXCL | O_NOFOLLOW | O_RDWR | O_CLOEXEC, 0600);
    if (named < 0 || unlinkat(in, name.name(), 0) != 0) impl_->cannot_be_written(errno);
    return named;
}

void OutputFile::finish() {
    finish_all({this});
}

void OutputFile::finish_all(const std::vector<OutputFile*>& files) {
    for (const OutputFile* file : files)
        if (!file->impl_->special) file->impl_->settle();
    for (const OutputFile* file : files)
        if (file->impl_->special) file->impl_->deliver_special();
    std::vector<Impl*> named;
    try {
        for (const OutputFile* file : files) {
            if (!file->impl_->store) continue;
            file->impl_->put_object();
            named.push_back(file->impl_.get());
        }
        for (const bool replacing : {false, true})
            for (const OutputFile* file : files) {
                Impl& impl = *file->impl_;
                if (impl.special || impl.store || impl.replaced_mode.has_value() != replacing)
                    continue;
                impl.give_name();
                named.push_back(&impl);
                impl.sync_folder();
            }
    } catch (...) {
        for (const Impl* impl : named)
            if (!impl->replaced_mode && !(impl->store && impl->overwrite)) impl->take_back();
        throw;
    }
}

/// All that can be refused before the file has its name.
void OutputFile::Impl::settle() const {
    if (replaced_mode && fchmod(file.get(), *replaced_mode) != 0) cannot_be_written(errno);
    // Without this a name may outlive a power cut, and what it names not.
    if (fsync(file.get()) != 0) cannot_be_written(errno);
}

void OutputFile::Impl::give_name() {
    if (part)
        name_part();
    else
        name_unnamed();
}

std::filesystem::path OutputFile::Impl::kept_path() const {
    return std::filesystem::temp_directory_path() / leaf;
}

/// Keeps the result under a name of this machine where the store refuses it.
void OutputFile::Impl::put_object() {
    try {
        store->put(file.get(), path.native());
    } catch (const Error& refusal) {
        give_name();
        throw Error(refusal.code(), fmt::format("{}: {}; the result is kept as {}", who,
                                                refusal.what(), printable(kept_path().string())));
    }
}

/// Removes the file, unless its name is another's by now.
void OutputFile::Impl::take_back() const noexcept {
    if (store) return store->remove(path.native());
    struct stat mine {
    }, there{};
    if (fstat(file.get(), &mine) == 0 &&
        fstatat(folder.get(), leaf.c_str(), &there, AT_SYMLINK_NOFOLLOW) == 0 &&
        same_file(mine, there))
        unlinkat(folder.get(), leaf.c_str(), 0);
}

void OutputFile::Impl::deliver_special() const {
    if (lseek(file.get(), 0, SEEK_SET) != 0) cannot_be_written(errno);
    std::array<char, 1 << 16> buffer;
    for (;;) {
        const ssize_t got = read(file.get(), buffer.data(), buffer.size());
        if (got < 0) cannot_be_written(errno);
        if (got == 0) return;
        for (ssize_t at = 0; at < got;) {
            const ssize_t written =
                ::write(special.get(), buffer.data() + at, static_cast<std::size_t>(got - at));
            if (written >= 0)
                at += written;
            else if (errno != EINTR)
                cannot_be_written(errno);
        }
    }
}

/// Says why the name could not be had.
void OutputFile::Impl::take_name() const {
    if (errno == EEXIST)
        failed(fmt::format(
            "{}: {}: exists now, made by another program; pass --overwrite to replace it", who,
            printable(path.string())));
    cannot_be_written(errno);
}

void OutputFile::Impl::name_unnamed() {
    const std::string source = proc_name(file.get());
    const auto link_as = [&](const char* name) {
        return linkat(AT_FDCWD, source.c_str(), folder.get(), name, AT_SYMLINK_FOLLOW) == 0;
    };
    if (link_as(leaf.c_str())) return;
    if (errno != EEXIST || !overwrite) take_name();
    // A link replaces nothing; a rename does.
    PartialName name(folder.get());
    if (!link_as(name.name()) ||
        renameat(folder.get(), name.name(), folder.get(), leaf.c_str()) != 0)
        cannot_be_written(errno);
    name.forget();
}

void OutputFile::Impl::name_part() {
    const int in = folder.get();
    const auto done = [&](int result) {
        if (result == 0) part->forget();
        return result == 0;
    };
    if (overwrite) {
        if (!done(renameat(in, part->name(), in, leaf.c_str()))) cannot_be_written(errno);
        return;
    }
    if (done(renameat2(in, part->name(), in, leaf.c_str(), RENAME_NOREPLACE))) return;
    if (!not_offered(errno)) take_name();
    // The name of the part goes with it.
    if (linkat(in, part->name(), in, leaf.c_str(), 0) == 0) return;
    if (!not_offered(errno) && errno != EPERM && errno != EMLINK) take_name();
    // The file system has no way to take a name only where it is free.
    struct stat taken {};
    if (fstatat(in, leaf.c_str(), &taken, AT_SYMLINK_NOFOLLOW) == 0) {
        errno = EEXIST;
        take_name();
    }
    if (!done(renameat(in, part->name(), in, leaf.c_str()))) cannot_be_written(errno);
}

void OutputFile::Impl::sync_folder() const {
    // EBADF: the folder may not be read. EINVAL: the file system has nothing to sync there.
    if (fsync(folder.get()) != 0 && errno != EBADF && errno != EINVAL) cannot_be_written(errno);
}

bool OutputFile::replaces(const std::filesystem::path& other) const {
    if (impl_->store) return impl_->path == other;
    struct stat a {
    }, b{};
    return impl_->replaced_mode && stat(other.c_str(), &b) == 0 &&
           fstatat(impl_->folder.get(), impl_->leaf.c_str(), &a, AT_SYMLINK_NOFOLLOW) == 0 &&
           same_file(a, b);
}

bool OutputFile::replaces_any() const {
    return impl_->replaced_mode.has_value() || (impl_->store && impl_->overwrite);
}

bool OutputFile::same_as(const OutputFile& other) const {
    if (impl_->store || other.impl_->store) return impl_->path == other.impl_->path;
    struct stat a {
    }, b{};
    return impl_->folder && other.impl_->folder && impl_->leaf == other.impl_->leaf &&
           fstat(impl_->folder.get(), &a) == 0 && fstat(other.impl_->folder.get(), &b) == 0 &&
           same_file(a, b);
}

bool is_taken(const std::filesystem::path& path) {
    if (const ObjectStore* store = object_store_of(path.native()))
        return store->exists(path.native());
    std::error_code missing;
    return std::filesystem::exists(std::filesystem::symlink_status(path, missing));
}

void remove_result(const std::filesystem::path& path) noexcept {
    if (const ObjectStore* store = object_store_of(path.native()))
        return store->remove(path.native());
    std::error_code error;
    std::filesystem::remove(path, error);
}

void make_folder_of(const std::filesystem::path& path, std::string_view who) {
    const std::filesystem::path folder = path.parent_path();
    if (folder.empty() || object_store_of(path.native())) return;
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        bad_input(fmt::format("{}: {}: the folder cannot be made, {}", who,
                              printable(folder.string()), error.message()));
}

void write_text(const std::filesystem::path& path, std::string_view text, bool overwrite,
                std::string_view who) {
    OutputFile file(path, overwrite, who);
    file.write(text);
    file.finish();
}

}  // namespace relevo
