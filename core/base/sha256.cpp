#include "base/sha256.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <openssl/evp.h>
#include <unistd.h>

#include "base/error.h"
#include "base/input_file.h"

namespace relevo {

std::string sha256_of_file(const std::filesystem::path& path, std::string_view who) {
    const InputFile file(path, who);
    const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> digest(EVP_MD_CTX_new(),
                                                                         EVP_MD_CTX_free);
    if (!digest || EVP_DigestInit_ex(digest.get(), EVP_sha256(), nullptr) != 1)
        failed(fmt::format("{}: this OpenSSL has no SHA-256", who));
    std::array<unsigned char, 1 << 16> buffer{};
    for (;;) {
        const ssize_t got = read(file.descriptor(), buffer.data(), buffer.size());
        if (got < 0 && errno == EINTR) continue;
        if (got < 0)
            bad_input(fmt::format("{}: {}: cannot be read, {}", who, path.string(),
                                  std::strerror(errno)));
        if (got == 0) break;
        EVP_DigestUpdate(digest.get(), buffer.data(), static_cast<std::size_t>(got));
    }
    std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
    unsigned int count = 0;
    EVP_DigestFinal_ex(digest.get(), bytes.data(), &count);
    std::string text;
    for (unsigned int i = 0; i < count; ++i)
        text += fmt::format("{:02x}", bytes[i]);
    return text;
}

}  // namespace relevo
