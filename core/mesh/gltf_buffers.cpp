#include "mesh/gltf_buffers.h"

#include <array>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "base/text.h"
#include "mesh/builder.h"

namespace relevo::mesh {
namespace {

constexpr std::size_t kMaxBuffers = 16;

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i)
        word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
    return word;
}

/// The chunks of .glb, or the whole of .gltf as JSON.
struct Chunks {
    std::string_view json, binary;
};

Chunks chunks_of(const std::filesystem::path& file, std::string_view bytes) {
    if (!bytes.starts_with("glTF")) return {bytes, {}};
    constexpr std::uint32_t kVersion = 2, kJson = 0x4e4f534a, kBinary = 0x004e4942;
    if (bytes.size() < 20 || word_at(bytes, 4) != kVersion)
        fail(file, "expected version 2 of binary glTF");
    Chunks chunks;
    std::size_t at = 12;
    while (at + 8 <= bytes.size()) {
        const std::size_t length = word_at(bytes, at);
        const std::uint32_t kind = word_at(bytes, at + 4);
        if (length > bytes.size() - at - 8)
            fail(file, fmt::format("expected a chunk of {} bytes but the file ends after {}",
                                   length, bytes.size() - at - 8));
        if (kind == kJson) chunks.json = bytes.substr(at + 8, length);
        if (kind == kBinary) chunks.binary = bytes.substr(at + 8, length);
        at += 8 + length;
    }
    return chunks;
}

std::string from_base64(const std::filesystem::path& file, std::string_view text) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text.substr(0, text.find('='))) {
        const std::size_t digit = kDigits.find(c);
        if (digit == kDigits.npos) fail(file, "buffers: expected base64 in its data URI");
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes.push_back(static_cast<char>(bits >> count & 0xff));
    }
    return bytes;
}

std::string load(const std::filesystem::path& file, const std::string& uri) {
    if (!uri.starts_with("data:"))
        fail(file,
             fmt::format("buffers: expected them in the file itself but got \"{}\"; save it as "
                         ".glb, or embed them",
                         printable(uri)));
    const std::size_t comma = uri.find(";base64,");
    if (comma == uri.npos) fail(file, "buffers: expected base64 in its data URI");
    return from_base64(file, std::string_view(uri).substr(comma + 8));
}

}  // namespace

const json::Value* find(const json::Value& object, std::string_view key) {
    for (const auto& [name, value] : object.members)
        if (name == key) return &value;
    return nullptr;
}

GltfParts gltf_parts(const std::filesystem::path& file, std::string_view bytes) {
    const Chunks chunks = chunks_of(file, bytes);
    GltfParts parts{json::parse("mesh", printable(file.string()), chunks.json), {}};
    const json::Value* const buffers = find(parts.root, "buffers");
    if (!buffers) return parts;
    if (buffers->items.size() > kMaxBuffers)
        fail(file, fmt::format("expected at most {} buffers but got {}", kMaxBuffers,
                               buffers->items.size()));
    for (const json::Value& buffer : buffers->items) {
        const json::Value* const uri = find(buffer, "uri");
        parts.buffers.push_back(uri ? load(file, uri->text) : std::string(chunks.binary));
    }
    return parts;
}

}  // namespace relevo::mesh
