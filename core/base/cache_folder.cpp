#include "base/cache_folder.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "base/error.h"
#include "base/output_file.h"
#include "base/parallel_for.h"
#include "base/sha256.h"

namespace relevo {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 22;        // bytes that have a checksum
constexpr std::int64_t kLeastFree = std::int64_t{1} << 30;  // of the disk, afterwards
constexpr std::string_view kPartial = ".part";

std::size_t pieces_of(std::size_t bytes) {
    return (bytes + kPiece - 1) / kPiece;
}

template <typename Byte>
std::span<Byte> piece_of(std::span<Byte> bytes, std::size_t index) {
    return bytes.subspan(index * kPiece, std::min(kPiece, bytes.size() - index * kPiece));
}

using Sum = std::array<char, 64>;  // SHA-256, as hexadecimal digits

Sum sum_of(std::span<const std::byte> piece) {
    Sum sum{};
    const std::string text =
        sha256_of_text({reinterpret_cast<const char*>(piece.data()), piece.size()});
    std::ranges::copy(text, sum.begin());
    return sum;
}

/// Calls body(index) for each piece of so many bytes, on several threads.
template <typename Body>
void for_pieces(std::size_t bytes, const Body& body) {
    parallel_for(0, static_cast<int>(pieces_of(bytes)), 1, [&](int first, int last) {
        for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i)
            body(i);
    });
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
    std::vector<Sum> sums(pieces_of(bytes.size()));
    const std::int64_t table = at_ + static_cast<std::int64_t>(sizeof length);
    if (!read_at(descriptor_, table, std::as_writable_bytes(std::span(sums)))) return false;
    const std::int64_t begin = table + static_cast<std::int64_t>(sums.size() * sizeof(Sum));
    std::atomic<bool> is_whole = true;
    for_pieces(bytes.size(), [&](std::size_t i) {
        const std::span piece = piece_of(bytes, i);
        if (!read_at(descriptor_, begin + static_cast<std::int64_t>(i * kPiece), piece) ||
            sum_of(piece) != sums[i])
            is_whole = false;
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

void CacheWriter::write(std::span<const std::byte> bytes) {
    const std::uint64_t length = bytes.size();
    std::vector<Sum> sums(pieces_of(bytes.size()));
    for_pieces(bytes.size(), [&](std::size_t i) { sums[i] = sum_of(piece_of(bytes, i)); });
    file_.write(std::as_bytes(std::span(&length, 1)));
    file_.write(std::as_bytes(std::span(sums)));
    file_.write(bytes);
}

bool CacheFolder::is_own_name(std::string_view name) {
    constexpr std::size_t kDigits = 64;
    if (name.starts_with(".relevo-") && name.ends_with(kPartial)) return true;
    return name.size() == kDigits && name.find_first_not_of("0123456789abcdef") == name.npos;
}

std::vector<CacheFolder::Entry> CacheFolder::entries() const {
    std::vector<Entry> all;
    std::error_code ignored;
    for (std::filesystem::directory_iterator at(folder_, ignored), end; !ignored && at != end;
         at.increment(ignored)) {
        std::error_code gone;
        if (!is_own_name(at->path().filename().string())) continue;
        if (at->is_symlink(gone) || !at->is_regular_file(gone) || gone) continue;
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
    try {
        OutputFile file(folder_ / name, /*overwrite=*/true, "cache");
        CacheWriter writer(file);
        if (!fill(writer)) return "what it is made of has changed meanwhile";
        file.finish();
    } catch (const Error& failure) {
        return failure.what();
    }
    remove_oldest(name);
    return {};
}

}  // namespace relevo
