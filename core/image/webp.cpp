#include "image/webp.h"

#include <webp/decode.h>
#include <webp/encode.h>

namespace relevo::image {

std::string encode_webp(std::vector<std::byte>& bytes, const Image8& image, int quality) {
    std::uint8_t* encoded = nullptr;
    const std::size_t size = WebPEncodeRGBA(image.values.data(), image.width, image.height,
                                            4 * image.width, static_cast<float>(quality), &encoded);
    if (size == 0) return "the encoder failed, most likely for want of memory";
    const auto* const first = reinterpret_cast<const std::byte*>(encoded);
    bytes.assign(first, first + size);
    WebPFree(encoded);
    return {};
}

std::string decode_webp(std::string_view bytes, Image8& image) {
    const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    int width = 0, height = 0;
    if (WebPGetInfo(data, bytes.size(), &width, &height) == 0 || width != image.width ||
        height != image.height ||
        !WebPDecodeRGBAInto(data, bytes.size(), image.values.data(), image.values.size(),
                            4 * image.width))
        return "is damaged";
    return {};
}

}  // namespace relevo::image
