#include "base/cache_folder.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/partial_names.h"

namespace relevo {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 22;        // bytes that have a checksum
constexpr std::int64_t kLeastFree = std::int64_t{1} << 30;  // of the disk, afterwards
constexpr std::string_view kPartial = ".part";

std::size_t pieces_of(std::size_t bytes) {
    return (bytes + kPiece - 1) / kPiece;
}

std::span<const std::byte> piece_of(std::span<const std::byte> bytes, std::size_t index) {
    return bytes.subspan(index * kPiece, std::min(kPiece, bytes.size() - index * kPiece));
}

/// FNV-1a of words of 64 bits in four lanes: finds damage, not deceit.
std::uint64_t checksum(std::span<const std::byte> bytes) {
    constexpr std::uint64_t kPrime = 0x100000001b3, kBasis = 0xcbf29ce484222325;
    std::array<std::uint64_t, 4> lanes{kBasis, kBasis + 1, kBasis + 2, kBasis + 3};
    std::size_t at = 0;
    for (; at + sizeof lanes <= bytes.size(); at += sizeof lanes) {
        std::array<std::uint64_t, 4> words{};
        std::memcpy(words.data(), &bytes[at], sizeof words);
        for (std::size_t i = 0; i < lanes.size(); ++i) {
            lanes[i] = (lanes[i] ^ words[i]) * kPrime;
            lanes[i] ^= lanes[i] >> 32;
        }
    }
    std::uint64_t sum = bytes.size();
    for (; at < bytes.size(); ++at)
        sum = (sum ^ std::to_integer<std::uint64_t>(bytes[at])) * kPrime;
    for (const std::uint64_t lane : lanes)
        sum = (sum ^ lane) * kPrime;
    return sum;
}

std::vector<std::uint64_t> checksums(std::span<const std::byte> bytes) {
    std::vector<std::uint64_t> sums(pieces_of(bytes.size()));
    parallel_for(0, static_cast<int>(sums.size()), 1, [&](int first, int last) {
        for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i)
            sums[i] = checksum(piece_of(bytes, i));
    });
    return sums;
}

bool read_at(int descriptor, std::int64_t at, std::span<std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t count = pread(descriptor, bytes.data(), bytes.size(), at);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(count));
        at += count;
    }
    return true;
}

}  // namespace

CacheReader::~CacheReader() {
    if (descriptor_ >= 0) close(descriptor_);
}

bool CacheReader::read(std::span<std::byte> bytes) {
    std::uint64_t length = 0;
    if (!read_at(descriptor_, at_, std::as_writable_bytes(std::span(&length, 1))) ||
        length != bytes.size())
        return false;
    std::vector<std::uint64_t> sums(pieces_of(bytes.size()));
    const std::int64_t table = at_ + static_cast<std::int64_t>(sizeof length);
    if (!read_at(descriptor_, table, std::as_writable_bytes(std::span(sums)))) return false;
    const std::int64_t begin = table + static_cast<std::int64_t>(sums.size() * sizeof sums[0]);
    std::atomic<bool> is_whole = true;
    parallel_for(0, static_cast<int>(sums.size()), 1, [&](int first, int last) {
        for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i) {
            const std::span piece =
                bytes.subspan(i * kPiece, std::min(kPiece, bytes.size() - i * kPiece));
            if (!read_at(descriptor_, begin + static_cast<std::int64_t>(i * kPiece), piece) ||
                checksum(piece) != sums[i])
                is_whole = false;
        }
    });
    at_ = begin + static_cast<std::int64_t>(bytes.size());
    return is_whole;
}

std::optional<std::string> CacheReader::read_text(std::size_t most) {
    std::uint64_t length = 0;
    if (!read_at(descriptor_, at_, std::as_writable_bytes(std::span(&length, 1))) || length > most)
        return std::nullopt;
    std::string text(length, '\0');
    if (!read_values(text.data(), text.size())) return std::nullopt;
    return text;
}

void CacheWriter::put(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
        if (count >= 0)
            bytes = bytes.subspan(static_cast<std::size_t>(count));
        else if (errno != EINTR)
            failed(std::strerror(errno));
    }
}

void CacheWriter::write(std::span<const std::byte> bytes) {
    const std::uint64_t length = bytes.size();
    put(std::as_bytes(std::span(&length, 1)));
    const std::vector<std::uint64_t> sums = checksums(bytes);
    put(std::as_bytes(std::span(sums)));
    put(bytes);
}

namespace {

/// A file on its way into a folder: without a name where the file system offers that, so that it
/// vanishes however the process ends.
class FileToBe {
  public:
    explicit FileToBe(const std::filesystem::path& folder)
        : folder_(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC)), name_(folder_) {
        if (folder_ < 0) return;
        file_ = openat(folder_, ".", O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
        has_name_ = file_ < 0;
        if (has_name_)
            file_ = openat(folder_, name_.name(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0600);
    }
    FileToBe(const FileToBe&) = delete;
    FileToBe& operator=(const FileToBe&) = delete;
    ~FileToBe() {
        if (file_ >= 0) close(file_);
        if (folder_ >= 0) {
            unlinkat(folder_, name_.name(), 0);
            close(folder_);
        }
        name_.forget();
    }

    int descriptor() const { return file_; }
    bool give(const std::string& name) {
        const std::string from = fmt::format("/proc/self/fd/{}", file_);
        if (!has_name_ &&
            linkat(AT_FDCWD, from.c_str(), folder_, name_.name(), AT_SYMLINK_FOLLOW) != 0)
            return false;
        return renameat(folder_, name_.name(), folder_, name.c_str()) == 0;
    }

  private:
    int folder_;
    PartialName name_;
    int file_ = -1;
    bool has_name_ = false;
};

}  // namespace

std::filesystem::path CacheFolder::user_folder(std::string_view name) {
    const auto of = [](const char* variable) {
        const char* const value = std::getenv(variable);
        return std::filesystem::path(value ? value : "");
    };
    // The specification has relative ones ignored.
    if (const auto cache = of("XDG_CACHE_HOME"); cache.is_absolute())
        return cache / "relevo" / name;
    if (const auto home = of("HOME"); home.is_absolute()) return home / ".cache" / "relevo" / name;
    return {};
}

std::vector<CacheFolder::Entry> CacheFolder::entries() const {
    std::vector<Entry> all;
    std::error_code ignored;
    for (std::filesystem::directory_iterator at(folder_, ignored), end; !ignored && at != end;
         at.increment(ignored)) {
        std::error_code gone;
        if (!at->is_regular_file(gone) || gone) continue;
        const auto bytes = static_cast<std::int64_t>(at->file_size(gone));
        const auto used = at->last_write_time(gone);
        if (!gone) all.push_back({at->path(), bytes, used});
    }
    std::ranges::sort(all, [](const Entry& a, const Entry& b) { return a.used > b.used; });
    return all;
}

std::string CacheFolder::clear() const {
    std::string failure;
    for (const Entry& entry : entries()) {
        std::error_code error;
        std::filesystem::remove(entry.path, error);
        if (error) failure = error.message();
    }
    return failure;
}

std::optional<CacheReader> CacheFolder::peek(const std::string& name) const {
    const int file = ::open((folder_ / name).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    return file < 0 ? std::nullopt : std::optional<CacheReader>(file);
}

std::optional<CacheReader> CacheFolder::open(const std::string& name) const {
    // Refused in a read-only folder, where nothing is removed either.
    utimensat(AT_FDCWD, (folder_ / name).c_str(), nullptr, AT_SYMLINK_NOFOLLOW);
    return peek(name);
}

void CacheFolder::remove_oldest(const std::string& keep) const {
    constexpr auto kStale = std::chrono::hours(1);
    std::int64_t bytes = 0;
    std::error_code ignored;
    for (const Entry& entry : entries()) {
        const bool is_partial = entry.path.filename().string().ends_with(kPartial);
        const bool is_stale =
            is_partial && std::filesystem::file_time_type::clock::now() - entry.used > kStale;
        bytes += entry.bytes;
        if (is_stale || (bytes > most_bytes_ && !is_partial && entry.path.filename() != keep))
            std::filesystem::remove(entry.path, ignored);
    }
}

std::string CacheFolder::write(const std::string& name, std::int64_t bytes,
                               const std::function<bool(CacheWriter&)>& fill) const {
    if (folder_.empty()) return "neither XDG_CACHE_HOME nor HOME is set";
    if (bytes > most_bytes_) return "it is larger than the cache";
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) return error.message();
    struct statvfs disk {};
    if (statvfs(folder_.c_str(), &disk) == 0 &&
        static_cast<std::int64_t>(disk.f_bavail) * static_cast<std::int64_t>(disk.f_frsize) <
            bytes + kLeastFree)
        return "the disk would have less than 1 GiB left";
    FileToBe file(folder_);
    if (file.descriptor() < 0) return std::strerror(errno);
    try {
        CacheWriter writer(file.descriptor());
        if (!fill(writer)) return "the DEM has changed meanwhile";
    } catch (const Error& failure) {
        return failure.what();
    }
    if (!file.give(name)) return std::strerror(errno);
    remove_oldest(name);
    return {};
}

}  // namespace relevo
