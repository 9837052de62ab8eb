#include "image/ktx.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/output_file.h"

namespace relevo::image {
namespace {

// Numbers are copied out of and into the file as they lie in memory.
static_assert(std::endian::native == std::endian::little, "KTX 2 is little-endian");

constexpr std::array<unsigned char, 12> kIdentifier{0xAB, 'K',  'T',  'X',  ' ',  '2',
                                                    '0',  0xBB, '\r', '\n', 0x1A, '\n'};
constexpr int kGreatestSide = 32768;
constexpr int kMaxLayers = 2048;

/// The file's first bytes, as the specification's section 3 lays them out.
struct Header {
    std::array<unsigned char, 12> identifier;
    std::uint32_t vk_format, type_size, width, height, depth, layers, faces, levels;
    std::uint32_t supercompression;
    std::uint32_t dfd_offset, dfd_size, kvd_offset, kvd_size;
    std::uint64_t sgd_offset, sgd_size;
};
static_assert(sizeof(Header) == 80);

struct LevelIndex {
    std::uint64_t offset, size, uncompressed_size;
};
static_assert(sizeof(LevelIndex) == 24);

/// A format that KTX files may have here.
struct FormatInfo {
    PixelFormat format;
    std::uint32_t vk_format;
    const char* name;

    std::uint32_t channels() const {
        return static_cast<std::uint32_t>(layout_of(format).channels);
    }
    std::uint32_t channel_bytes() const {
        return static_cast<std::uint32_t>(layout_of(format).channel_bytes);
    }
    std::size_t bytes() const { return static_cast<std::size_t>(layout_of(format).bytes()); }
    bool srgb() const { return format == PixelFormat::Srgb8A8; }
    bool is_float() const { return layout_of(format).kind == ChannelKind::Float; }
};

constexpr std::array kVulkanFormats{
    FormatInfo{PixelFormat::R8, 9, "VK_FORMAT_R8_UNORM"},
    FormatInfo{PixelFormat::RG8, 16, "VK_FORMAT_R8G8_UNORM"},
    FormatInfo{PixelFormat::RGBA8, 37, "VK_FORMAT_R8G8B8A8_UNORM"},
    FormatInfo{PixelFormat::Srgb8A8, 43, "VK_FORMAT_R8G8B8A8_SRGB"},
    FormatInfo{PixelFormat::R16, 70, "VK_FORMAT_R16_UNORM"},
    FormatInfo{PixelFormat::RGBA16F, 97, "VK_FORMAT_R16G16B16A16_SFLOAT"},
    FormatInfo{PixelFormat::R32F, 100, "VK_FORMAT_R32_SFLOAT"},
    FormatInfo{PixelFormat::RGBA32F, 109, "VK_FORMAT_R32G32B32A32_SFLOAT"},
};

const FormatInfo& info(PixelFormat format) {
    for (const FormatInfo& each : kVulkanFormats)
        if (each.format == format) return each;
    throw std::logic_error("ktx: a format without an entry");
}

std::size_t level_bytes(const FormatInfo& f, int width, int height, int depth, int layers,
                        int level) {
    const auto side = [level](int s) { return static_cast<std::size_t>(std::max(1, s >> level)); };
    return f.bytes() * side(width) * side(height) * side(depth) * static_cast<std::size_t>(layers);
}

std::size_t aligned(std::size_t offset, std::size_t alignment) {
    return (offset + alignment - 1) / alignment * alignment;
}

/// The data format descriptor that belongs to a format, its total size first.
/// Source: Khronos Data Format Specification 1.3, section 5 (basic descriptor block).
std::vector<std::uint32_t> descriptor(const FormatInfo& f) {
    constexpr std::uint32_t kRgbsda = 1, kBt709 = 1, kLinear = 1, kSrgb = 2, kLinearAlpha = 0x10,
                            kSignedFloat = 0xC0;
    constexpr std::array<std::uint32_t, 4> kChannelId{0, 1, 2, 15};  // red, green, blue, alpha
    const std::uint32_t block_size = 24 + 16 * f.channels();
    std::vector<std::uint32_t> words{
        4 + block_size,                                              // total size
        0,                                                           // Khronos, basic descriptor
        2 | block_size << 16,                                        // version 1.3
        kRgbsda | kBt709 << 8 | (f.srgb() ? kSrgb : kLinear) << 16,  // and straight alpha
        0,                                                           // one texel a block
        f.channels() * f.channel_bytes(),                            // bytes of plane 0
        0};
    const std::uint32_t bits = 8 * f.channel_bytes();
    for (std::uint32_t c = 0; c < f.channels(); ++c) {
        std::uint32_t id = kChannelId[c];
        if (f.srgb() && c == 3) id |= kLinearAlpha;
        if (f.is_float()) id |= kSignedFloat;
        words.insert(words.end(),
                     {c * bits | (bits - 1) << 16 | id << 24, 0,
                      f.is_float() ? std::bit_cast<std::uint32_t>(-1.0f) : 0,
                      f.is_float() ? std::bit_cast<std::uint32_t>(1.0f) : (1u << bits) - 1});
    }
    return words;
}

/// Reads what it is asked for, or says that the file is bad.
class Reader {
  public:
    Reader(const std::filesystem::path& path, std::span<const std::byte> bytes)
        : path_(path), bytes_(bytes) {}

    [[noreturn]] void bad(const std::string& what) const {
        bad_input(fmt::format("texture: {}: {}", path_.string(), what));
    }

    template <typename T>
    T at(std::uint64_t offset) const {
        assert(offset + sizeof(T) <= bytes_.size());
        T value;
        std::memcpy(&value, bytes_.data() + offset, sizeof(T));
        return value;
    }

    /// A part of the file that it names by offset and size.
    std::span<const std::byte> part(std::string_view name, std::uint64_t offset,
                                    std::uint64_t size) const {
        if (offset > bytes_.size() || size > bytes_.size() - offset)
            bad(fmt::format("{} at {} to {} is outside the file of {} bytes", name, offset,
                            offset + size, bytes_.size()));
        return bytes_.subspan(offset, size);
    }

    Header header() const;
    const FormatInfo& format(const Header& h) const;
    void check_shape(const Header& h) const;
    void check_descriptor(const Header& h, const FormatInfo& f) const;
    std::map<std::string, std::string> metadata(const Header& h) const;
    std::vector<std::size_t> level_offsets(const Header& h, const FormatInfo& f) const;

  private:
    const std::filesystem::path& path_;
    std::span<const std::byte> bytes_;
};

Header Reader::header() const {
    if (bytes_.size() < sizeof(Header))
        bad(fmt::format("file too short, expected at least {} bytes but got {}", sizeof(Header),
                        bytes_.size()));
    const auto h = at<Header>(0);
    if (std::memcmp(h.identifier.data(), "\xABKTX 11\xBB", 8) == 0)
        bad("is KTX version 1, expected version 2; convert it with ktx2ktx2");
    if (h.identifier != kIdentifier) bad("not a KTX 2 file");
    return h;
}

const FormatInfo& Reader::format(const Header& h) const {
    if (h.supercompression != 0)
        bad(fmt::format("supercompression scheme {}, expected none (0)", h.supercompression));
    for (const FormatInfo& f : kVulkanFormats)
        if (f.vk_format == h.vk_format) {
            if (h.type_size != f.channel_bytes())
                bad(fmt::format("type size of {}, expected {} but got {}", f.name,
                                f.channel_bytes(), h.type_size));
            return f;
        }
    std::string known;
    for (const FormatInfo& f : kVulkanFormats)
        known += fmt::format("{}{} ({})", known.empty() ? "" : ", ", f.vk_format, f.name);
    bad(fmt::format("texel format {}, expected one of {}", h.vk_format, known));
}

void Reader::check_shape(const Header& h) const {
    // A 1-D texture has height 0 in the file; none is needed here.
    if (h.width < 1 || h.height < 1 || h.width > kGreatestSide || h.height > kGreatestSide ||
        h.depth > kGreatestSide)
        bad(fmt::format("size {} x {} x {}, expected 1 to {} a side", h.width, h.height, h.depth,
                        kGreatestSide));
    if (h.layers > kMaxLayers)
        bad(fmt::format("{} layers, expected at most {}", h.layers, kMaxLayers));
    if (h.layers > 0 && h.depth > 0) bad("an array of volumes, expected one or the other");
    if (h.faces != 1) bad(fmt::format("{} faces, expected 1", h.faces));
    const int most = full_chain_levels(static_cast<int>(h.width), static_cast<int>(h.height),
                                       std::max(1, static_cast<int>(h.depth)));
    if (h.levels < 1 || h.levels > static_cast<std::uint32_t>(most))
        bad(fmt::format("{} mip levels, expected 1 to {}", h.levels, most));
    if (bytes_.size() < sizeof(Header) + h.levels * sizeof(LevelIndex))
        bad(
            fmt::format("file too short for the index of its {} levels, expected at least {} bytes "
                        "but got {}",
                        h.levels, sizeof(Header) + h.levels * sizeof(LevelIndex), bytes_.size()));
}

void Reader::check_descriptor(const Header& h, const FormatInfo& f) const {
    const auto dfd = part("data format descriptor", h.dfd_offset, h.dfd_size);
    const std::vector<std::uint32_t> expected = descriptor(f);
    // Version, primaries and alpha premultiplication may differ: nothing here depends on them.
    const auto equal = [&](std::size_t word, std::uint32_t mask) {
        return (at<std::uint32_t>(h.dfd_offset + 4 * word) & mask) == (expected[word] & mask);
    };
    bool same = dfd.size() == 4 * expected.size() && equal(0, ~0u) && equal(1, ~0u) &&
                equal(2, 0xFFFF0000u) && equal(3, 0x00FF00FFu) && equal(4, ~0u) && equal(5, ~0u);
    for (std::size_t word = 7; same && word < expected.size(); ++word)
        same = equal(word, ~0u);
    if (!same) bad(fmt::format("its data format descriptor does not describe {}", f.name));
}

std::map<std::string, std::string> Reader::metadata(const Header& h) const {
    std::map<std::string, std::string> pairs;
    const auto kvd = part("key/value data", h.kvd_offset, h.kvd_size);
    for (std::size_t offset = 0; offset < kvd.size();) {
        if (kvd.size() - offset < 4) bad("key/value data ends inside a length");
        const auto size = at<std::uint32_t>(h.kvd_offset + offset);
        offset += 4;
        if (size > kvd.size() - offset)
            bad(fmt::format("key/value pair of {} bytes, expected at most {}", size,
                            kvd.size() - offset));
        const std::string_view pair(reinterpret_cast<const char*>(kvd.data() + offset), size);
        const std::size_t nul = pair.find('\0');
        if (nul == std::string_view::npos || nul == 0)
            bad("key/value pair without a key that ends in NUL");
        std::string_view value = pair.substr(nul + 1);
        if (!value.empty() && value.back() == '\0') value.remove_suffix(1);
        if (!pairs.emplace(pair.substr(0, nul), value).second)
            bad(fmt::format("two values for the key {}", pair.substr(0, nul)));
        offset = aligned(offset + size, 4);
    }
    return pairs;
}

std::vector<std::size_t> Reader::level_offsets(const Header& h, const FormatInfo& f) const {
    std::vector<std::size_t> offsets;
    for (std::uint32_t l = 0; l < h.levels; ++l) {
        const auto index = at<LevelIndex>(sizeof(Header) + l * sizeof(LevelIndex));
        const std::size_t expected =
            level_bytes(f, static_cast<int>(h.width), static_cast<int>(h.height),
                        std::max(1, static_cast<int>(h.depth)),
                        std::max(1, static_cast<int>(h.layers)), static_cast<int>(l));
        if (index.size != expected || index.uncompressed_size != expected)
            bad(fmt::format("level {}, expected {} bytes but got {}", l, expected,
                            index.size != expected ? index.size : index.uncompressed_size));
        part(fmt::format("level {}", l), index.offset, index.size);
        if (index.offset % std::max<std::size_t>(4, f.bytes()) != 0)
            bad(fmt::format("level {} at {}, expected a multiple of 4", l, index.offset));
        if (index.offset < sizeof(Header) + h.levels * sizeof(LevelIndex))
            bad(fmt::format("level {} at {} lies over the header", l, index.offset));
        offsets.push_back(index.offset);
    }
    return offsets;
}

/// The key/value data of a file, with what wrote it.
std::string key_values(std::map<std::string, std::string> pairs) {
    pairs.emplace("KTXwriter", "relevo");
    std::string data;  // std::map has the keys in the order the specification asks for
    for (const auto& [key, value] : pairs) {
        const auto size = static_cast<std::uint32_t>(key.size() + 1 + value.size() + 1);
        data.append(reinterpret_cast<const char*>(&size), 4);
        data.append(key).push_back('\0');
        data.append(value).push_back('\0');
        data.resize(aligned(data.size(), 4));
    }
    return data;
}

}  // namespace

int full_chain_levels(int width, int height, int depth) {
    return static_cast<int>(
        std::bit_width(static_cast<unsigned>(std::max({width, height, depth}))));
}

TextureData::TextureData(PixelFormat format, int width, int height, int depth, int layers,
                         int levels)
    : format_(format),
      width_(width),
      height_(height),
      depth_(depth),
      layers_(layers),
      levels_(levels) {
    assert(width >= 1 && height >= 1 && depth >= 1 && layers >= 1 && levels >= 1);
    assert(width <= kGreatestSide && height <= kGreatestSide && depth <= kGreatestSide);
    assert(layers <= kMaxLayers && (layers == 1 || depth == 1));
    assert(levels <= full_chain_levels(width, height, depth));
    std::size_t size = 0;
    for (int l = 0; l < levels; ++l) {
        offsets_.push_back(size);
        size += level_bytes(info(format), width, height, depth, layers, l);
    }
    owned_.resize(size);
}

int TextureData::level_width(int level) const {
    return std::max(1, width_ >> level);
}

int TextureData::level_height(int level) const {
    return std::max(1, height_ >> level);
}

int TextureData::level_depth(int level) const {
    return std::max(1, depth_ >> level);
}

std::span<const std::byte> TextureData::level(int level) const {
    assert(level >= 0 && level < levels_);
    const std::byte* bytes = mapped_ ? mapped_.get() : owned_.data();
    return {bytes + offsets_[static_cast<std::size_t>(level)],
            level_bytes(info(format_), width_, height_, depth_, layers_, level)};
}

std::span<std::byte> TextureData::writable_level(int level) {
    assert(!mapped_ && level >= 0 && level < levels_);
    return {owned_.data() + offsets_[static_cast<std::size_t>(level)],
            level_bytes(info(format_), width_, height_, depth_, layers_, level)};
}

void TextureData::Unmap::operator()(const std::byte* bytes) const {
    munmap(const_cast<std::byte*>(bytes), size);
}

TextureData read_ktx(const std::filesystem::path& path) {
    const InputFile file(AllowedName(path.string()), "texture");
    const auto size = static_cast<std::size_t>(file.size());

    TextureData texture;
    std::span<const std::byte> bytes;
    if (size > 0) {
        void* memory = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.descriptor(), 0);
        if (memory == MAP_FAILED)
            bad_input(fmt::format("texture: {}: cannot be read, {}", path.string(),
                                  std::strerror(errno)));
        texture.mapped_ = {static_cast<const std::byte*>(memory), TextureData::Unmap{size}};
        bytes = {texture.mapped_.get(), size};
    }
    const Reader reader(path, bytes);
    const Header header = reader.header();
    const FormatInfo& format = reader.format(header);
    reader.check_shape(header);
    reader.check_descriptor(header, format);
    texture.metadata = reader.metadata(header);
    texture.offsets_ = reader.level_offsets(header, format);
    texture.format_ = format.format;
    texture.width_ = static_cast<int>(header.width);
    texture.height_ = static_cast<int>(header.height);
    texture.depth_ = std::max(1, static_cast<int>(header.depth));
    texture.layers_ = std::max(1, static_cast<int>(header.layers));
    texture.levels_ = static_cast<int>(header.levels);
    return texture;
}

void write_ktx(const std::filesystem::path& path, const TextureData& texture) {
    const FormatInfo& format = info(texture.format());
    const std::vector<std::uint32_t> dfd = descriptor(format);
    const std::string kvd = key_values(texture.metadata);

    Header header{};
    header.identifier = kIdentifier;
    header.vk_format = format.vk_format;
    header.type_size = format.channel_bytes();
    header.width = static_cast<std::uint32_t>(texture.width());
    header.height = static_cast<std::uint32_t>(texture.height());
    header.depth = texture.depth() > 1 ? static_cast<std::uint32_t>(texture.depth()) : 0;
    header.layers = texture.layers() > 1 ? static_cast<std::uint32_t>(texture.layers()) : 0;
    header.faces = 1;
    header.levels = static_cast<std::uint32_t>(texture.levels());
    std::size_t offset = sizeof(Header) + header.levels * sizeof(LevelIndex);
    header.dfd_offset = static_cast<std::uint32_t>(offset);
    header.dfd_size = static_cast<std::uint32_t>(4 * dfd.size());
    offset += header.dfd_size;
    header.kvd_offset = static_cast<std::uint32_t>(offset);
    header.kvd_size = static_cast<std::uint32_t>(kvd.size());
    offset += header.kvd_size;

    // The smallest level lies first, so that a reader over a network has something to show early.
    const std::size_t alignment = std::max<std::size_t>(4, format.bytes());
    std::vector<LevelIndex> index(header.levels);
    for (std::size_t l = header.levels; l-- > 0;) {
        offset = aligned(offset, alignment);
        const std::size_t size = texture.level(static_cast<int>(l)).size();
        index[l] = {offset, size, size};
        offset += size;
    }

    OutputFile file(path, /*overwrite=*/true, "texture");
    const auto write = [&](const void* bytes, std::size_t size) {
        file.write({static_cast<const std::byte*>(bytes), size});
    };
    write(&header, sizeof header);
    write(index.data(), index.size() * sizeof(LevelIndex));
    write(dfd.data(), header.dfd_size);
    write(kvd.data(), kvd.size());
    std::size_t written = header.kvd_offset + kvd.size();
    for (std::size_t l = header.levels; l-- > 0;) {
        constexpr std::array<char, 8> kZeros{};
        write(kZeros.data(), index[l].offset - written);
        const auto level = texture.level(static_cast<int>(l));
        write(level.data(), level.size());
        written = index[l].offset + level.size();
    }
    file.finish();
}

}  // namespace relevo::image
