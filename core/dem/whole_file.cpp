#include "dem/whole_file.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <vector>

#include "base/input_file.h"

namespace relevo::dem {
namespace {

constexpr std::uint32_t kDimension = 10;
constexpr std::uint32_t kVariable = 11;
constexpr std::uint32_t kAttribute = 12;
constexpr std::uint64_t kMaxItems = 1'000'000;  // of a list or a name: more is no header

/// A classic header, read from its beginning; after a failure every read gives 0.
class TiffHeader {
  public:
    explicit TiffHeader(const std::filesystem::path& path)
        : file_(input_stream(AllowedName(path.string()))) {
        std::array<char, 4> magic{};
        file_.read(magic.data(), 4);
        version_ = magic[3];
        if (magic[0] != 'C' || magic[1] != 'D' || magic[2] != 'F' ||
            (version_ != 1 && version_ != 2 && version_ != 5))
            file_.setstate(std::ios::failbit);
    }

    bool good() const { return file_.good(); }
    void fail() { file_.setstate(std::ios::failbit); }

    std::uint64_t integer(int bytes) {
        std::array<unsigned char, 8> data{};
        file_.read(reinterpret_cast<char*>(data.data()), bytes);
        if (!file_) return 0;
        std::uint64_t value = 0;
        for (int i = 0; i < bytes; ++i)
            value = value << 8 | data[static_cast<std::size_t>(i)];
        return value;
    }
    std::uint64_t tag() { return integer(4); }
    std::uint64_t count() { return integer(version_ == 5 ? 8 : 4); }
    std::uint64_t offset() { return integer(version_ == 1 ? 4 : 8); }

    /// The length of a list that begins with its tag, or with zeros where it is empty.
    std::uint64_t list(std::uint32_t expected) {
        const std::uint64_t found = tag();
        const std::uint64_t length = count();
        if (length > kMaxItems || (length > 0 && found != expected)) fail();
        return good() ? length : 0;
    }
    void skip(std::uint64_t bytes) {  // padded to four
        if (bytes > kMaxItems) fail();
        if (good()) file_.seekg(static_cast<std::streamoff>((bytes + 3) / 4 * 4), std::ios::cur);
    }
    void skip_name() { skip(count()); }
    void skip_attributes() {
        const std::uint64_t length = list(kAttribute);
        for (std::uint64_t i = 0; i < length && good(); ++i) {
            skip_name();
            const std::uint64_t bytes = bytes_of(tag());
            skip(count() * bytes);
        }
    }
    /// Bytes of one value of an external type.
    std::uint64_t bytes_of(std::uint64_t type) {
        constexpr std::array<std::uint64_t, 12> kBytes = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
        if (type == 0 || type >= kBytes.size()) fail();
        return good() ? kBytes[type] : 0;
    }

  private:
    InputStream file_;
    int version_ = 0;
};

}  // namespace

std::uint64_t classic_netcdf_size(const std::filesystem::path& path) {
    TiffHeader header(path);
    const std::uint64_t records = header.count();
    std::vector<std::uint64_t> lengths(header.list(kDimension));
    for (std::uint64_t& length : lengths) {
        header.skip_name();
        length = header.count();  // 0: the one that grows, a record for each step of it
    }
    header.skip_attributes();
    std::uint64_t size = 0;
    std::uint64_t record_begin = 0;
    std::uint64_t record_bytes = 0;  // of all variables, each padded
    std::uint64_t lone_bytes = 0;    // of the last one, as it is

    std::uint64_t record_variables = 0;
    const std::uint64_t variables = header.list(kVariable);
    for (std::uint64_t i = 0; i < variables && header.good(); ++i) {
        header.skip_name();
        const std::uint64_t rank = header.count();
        if (rank > lengths.size()) header.fail();
        std::uint64_t cells = 1;
        bool is_record = false;
        for (std::uint64_t d = 0; d < rank && header.good(); ++d) {
            const std::uint64_t dimension = header.count();
            if (dimension >= lengths.size()) {
                header.fail();
            } else if (lengths[dimension] == 0) {
                is_record = true;
            } else {
                cells *= lengths[dimension];
            }
        }
        header.skip_attributes();
        const std::uint64_t bytes = cells * header.bytes_of(header.tag());
        header.count();  // the size as written, which is not kept for large variables
        const std::uint64_t begin = header.offset();
        if (is_record) {
            record_begin = record_variables == 0 ? begin : std::min(record_begin, begin);
            record_bytes += (bytes + 3) / 4 * 4;
            lone_bytes = bytes;
            ++record_variables;
        } else {
            size = std::max(size, begin + bytes);
        }
    }
    if (!header.good()) return 0;
    // Records of a lone variable are not padded. All ones: written as a stream, nobody knows.
    const bool known = records != 0xFFFFFFFF && records != ~std::uint64_t{0};
    if (record_variables > 0 && records > 0 && known)
        size = std::max(
            size, record_begin + records * (record_variables == 1 ? lone_bytes : record_bytes));
    return size;
}

}  // namespace relevo::dem
