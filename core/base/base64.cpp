#include "base/base64.h"

#include <algorithm>

#include <openssl/evp.h>

namespace relevo {

std::string base64(std::span<const std::byte> bytes) {
    constexpr std::size_t kPiece = std::size_t{3} << 20;  // OpenSSL counts in ints
    std::string text;
    while (!bytes.empty()) {
        const auto piece = bytes.first(std::min(bytes.size(), kPiece));
        const std::size_t before = text.size();
        text.resize(before + (piece.size() + 2) / 3 * 4 + 1);  // OpenSSL ends with a zero
        EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data() + before),
                        reinterpret_cast<const unsigned char*>(piece.data()),
                        static_cast<int>(piece.size()));
        text.pop_back();
        bytes = bytes.subspan(piece.size());
    }
    return text;
}

}  // namespace relevo
