#include "image/xmp.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <utility>

namespace relevo::image {
namespace {

constexpr std::string_view kPrefix = "relevo:";
/// Of Google's properties of panoramas, by which viewers show one as a sphere.
constexpr std::string_view kPanoramaPrefix = "GPano:";
constexpr std::string_view kPanoramaBegin =
    "<rdf:Description rdf:about=\"\" "
    "xmlns:GPano=\"http://ns.google.com/photos/1.0/panorama/\">";
constexpr std::string_view kBegin =
    "<rdf:Description rdf:about=\"\" "
    "xmlns:relevo=\"https://relevo.invalid/ns/1.0/\">";
constexpr std::string_view kEnd = "</rdf:Description>";

/// Letters that XML has words for.
constexpr std::array<std::pair<char, std::string_view>, 3> kEntities{
    {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}}};

std::string escaped(std::string_view text) {
    std::string result;
    for (const char letter : text) {
        std::string_view written(&letter, 1);
        for (const auto& [plain, entity] : kEntities)
            if (letter == plain) written = entity;
        result += written;
    }
    return result;
}

std::string plain(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        std::size_t taken = 1;
        char letter = text.front();
        for (const auto& [one, entity] : kEntities)
            if (text.starts_with(entity)) {
                letter = one;
                taken = entity.size();
            }
        result += letter;
        text.remove_prefix(taken);
    }
    return result;
}

void append(std::vector<std::byte>& to, std::string_view bytes) {
    for (const char byte : bytes)
        to.push_back(static_cast<std::byte>(byte));
}

void append_little(std::vector<std::byte>& to, std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i)
        to.push_back(static_cast<std::byte>(value >> (8 * i) & 0xff));
}

/// A chunk of RIFF, with the byte that makes its size even.
void append_chunk(std::vector<std::byte>& to, std::string_view name, std::string_view content) {
    append(to, name);
    append_little(to, static_cast<std::uint32_t>(content.size()), 4);
    append(to, content);
    if (content.size() % 2 == 1) to.push_back(std::byte{0});
}

}  // namespace

bool is_xmp_keyword(std::string_view keyword) {
    return keyword.starts_with(kPrefix) || keyword.starts_with(kPanoramaPrefix);
}

std::string xmp_packet(const Metadata& metadata) {
    const auto properties_of = [&](std::string_view prefix) {
        std::string properties;
        for (const auto& [keyword, text] : metadata)
            if (keyword.starts_with(prefix))
                properties += "<" + keyword + ">" + escaped(text) + "</" + keyword + ">";
        return properties;
    };
    const std::string properties = properties_of(kPrefix);
    const std::string panorama = properties_of(kPanoramaPrefix);
    if (properties.empty() && panorama.empty()) return {};
    return std::string("<?xpacket begin=\"\xef\xbb\xbf\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>") +
           "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF "
           "xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">" +
           std::string(kBegin) + properties + std::string(kEnd) +
           (panorama.empty() ? std::string()
                             : std::string(kPanoramaBegin) + panorama + std::string(kEnd)) +
           "</rdf:RDF></x:xmpmeta><?xpacket end=\"r\"?>";
}

Metadata texts_in_xmp(std::string_view file) {
    Metadata metadata;
    const std::size_t begin = file.find(kBegin);
    if (begin == std::string_view::npos) return metadata;
    std::string_view rest = file.substr(begin + kBegin.size());
    rest = rest.substr(0, rest.find(kEnd));
    while (rest.starts_with("<")) {
        const std::size_t name_end = rest.find('>');
        if (name_end == std::string_view::npos) break;
        const std::string keyword(rest.substr(1, name_end - 1));
        const std::string closing = "</" + keyword + ">";
        const std::size_t end = rest.find(closing);
        if (end == std::string_view::npos) break;
        metadata[keyword] = plain(rest.substr(name_end + 1, end - name_end - 1));
        rest.remove_prefix(end + closing.size());
    }
    return metadata;
}

std::string add_xmp_to_jpeg(std::vector<std::byte>& file, std::string_view packet) {
    constexpr std::string_view kName("http://ns.adobe.com/xap/1.0/\0", 29);
    if (packet.size() > kLongestXmpOfJpeg) return "its scene is too long for a JPEG; name a .png";
    if (file.size() < 4 || file[0] != std::byte{0xff} || file[1] != std::byte{0xd8})
        return "the encoder left no JPEG";
    // Behind what some readers want first, JFIF's and Exif's own.
    std::size_t at = 2;
    while (at + 4 <= file.size() && file[at] == std::byte{0xff} &&
           (file[at + 1] == std::byte{0xe0} || file[at + 1] == std::byte{0xe1}))
        at += 2 + (std::to_integer<std::size_t>(file[at + 2]) << 8 |
                   std::to_integer<std::size_t>(file[at + 3]));
    const std::size_t length = 2 + kName.size() + packet.size();
    std::vector<std::byte> segment{std::byte{0xff}, std::byte{0xe1},
                                   static_cast<std::byte>(length >> 8),
                                   static_cast<std::byte>(length & 0xff)};
    append(segment, kName);
    append(segment, packet);
    file.insert(file.begin() + static_cast<std::ptrdiff_t>(at), segment.begin(), segment.end());
    return {};
}

std::string add_xmp_to_webp(std::vector<std::byte>& file, std::string_view packet, int width_px,
                            int height_px) {
    constexpr std::size_t kHeader = 12;  // "RIFF", size, "WEBP"
    const std::string_view bytes(reinterpret_cast<const char*>(file.data()), file.size());
    if (!bytes.starts_with("RIFF") || bytes.size() < kHeader + 8) return "the encoder left no WebP";
    constexpr std::uint8_t kXmpFlag = 0x04;
    std::vector<std::byte> body;
    if (bytes.substr(kHeader, 4) == "VP8X") {
        body.assign(file.begin() + kHeader, file.end());
        body[8] |= std::byte{kXmpFlag};
    } else {
        append(body, "VP8X");
        append_little(body, 10, 4);
        append_little(body, kXmpFlag, 4);
        append_little(body, static_cast<std::uint32_t>(width_px - 1), 3);
        append_little(body, static_cast<std::uint32_t>(height_px - 1), 3);
        body.insert(body.end(), file.begin() + kHeader, file.end());
    }
    append_chunk(body, "XMP ", packet);
    std::vector<std::byte> result;
    append(result, "RIFF");
    append_little(result, static_cast<std::uint32_t>(body.size() + 4), 4);
    append(result, "WEBP");
    result.insert(result.end(), body.begin(), body.end());
    file = std::move(result);
    return {};
}

}  // namespace relevo::image
