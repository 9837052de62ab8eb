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
#include "base/text.h"

namespace relevo {
namespace {

class Sha256 {
  public:
    explicit Sha256(std::string_view who) : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
        if (!context_ || EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1)
            failed(fmt::format("{}: this OpenSSL has no SHA-256", who));
    }

    void add(const void* bytes, std::size_t count) {
        EVP_DigestUpdate(context_.get(), bytes, count);
    }

    std::string hexadecimal() {
        std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
        unsigned int count = 0;
        EVP_DigestFinal_ex(context_.get(), bytes.data(), &count);
        std::string text;
        for (unsigned int i = 0; i < count; ++i)
            text += fmt::format("{:02x}", bytes[i]);
        return text;
    }

  private:
    std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string sha256_of_file(const std::filesystem::path& path, std::string_view who) {
    const InputFile file(AllowedName(path.string()), who);
    Sha256 sum(who);
    std::array<unsigned char, 1 << 16> buffer{};
    for (;;) {
        const ssize_t got = read(file.descriptor(), buffer.data(), buffer.size());
        if (got < 0 && errno == EINTR) continue;
        if (got < 0)
            bad_input(fmt::format("{}: {}: cannot be read, {}", who, printable(path.string()),
                                  std::strerror(errno)));
        if (got == 0) break;
        sum.add(buffer.data(), static_cast<std::size_t>(got));
    }
    return sum.hexadecimal();
}

std::string sha256_of_text(std::string_view text) {
    Sha256 sum("sha256");
    sum.add(text.data(), text.size());
    return sum.hexadecimal();
}

}  // namespace relevo
