#include "web/container.h"

#include <cassert>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>
#include <zlib.h>

#include "base/error.h"

namespace relevo::web {
namespace {

constexpr std::size_t kAlign = 8;  // the JSON ends at a multiple of it

void append(std::vector<std::byte>& to, std::span<const std::byte> bytes) {
    to.insert(to.end(), bytes.begin(), bytes.end());
}

void append(std::vector<std::byte>& to, std::string_view text) {
    append(to, std::as_bytes(std::span(text)));
}

void append(std::vector<std::byte>& to, std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8)
        to.push_back(static_cast<std::byte>(value >> shift));
}

const Bytef* bytes_of(std::span<const std::byte> bytes) {
    return reinterpret_cast<const Bytef*>(bytes.data());
}

nlohmann::ordered_json table_of(std::span<const Block> blocks) {
    auto table = nlohmann::ordered_json::array();
    std::size_t offset = 0;
    for (const Block& block : blocks) {
        const uLong sum = crc32_z(0, bytes_of(block.stored), block.stored.size());
        table.push_back({{"name", block.name},
                         {"offset", offset},
                         {"length", block.stored.size()},
                         {"size", block.size},
                         {"crc32", sum},
                         {"coding", block.coding}});
        offset += block.stored.size();
    }
    return table;
}

/// `<` is only inside of JSON's strings.
std::string without_tags(const std::string& json) {
    std::string result;
    for (const char c : json)
        if (c == '<')
            result += "\\u003c";
        else
            result += c;
    return result;
}

}  // namespace

Block deflated(std::string name, std::span<const std::byte> bytes) {
    uLongf length = compressBound(bytes.size());
    std::vector<std::byte> stored(length);
    const int status = compress2(reinterpret_cast<Bytef*>(stored.data()), &length, bytes_of(bytes),
                                 bytes.size(), Z_DEFAULT_COMPRESSION);
    if (status != Z_OK) failed("web: block " + name + ": not enough memory to deflate it");
    stored.resize(length);
    return {std::move(name), "deflate", bytes.size(), std::move(stored)};
}

Block as_is(std::string name, std::string coding, std::vector<std::byte> bytes) {
    const std::size_t size = bytes.size();
    return {std::move(name), std::move(coding), size, std::move(bytes)};
}

std::vector<std::byte> container(const std::string& about, std::span<const Block> blocks) {
    auto json = nlohmann::ordered_json::parse(about);
    assert(json.is_object());
    json["blocks"] = table_of(blocks);
    std::string text =
        without_tags(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    text.resize((text.size() + kAlign - 1) / kAlign * kAlign, ' ');
    std::vector<std::byte> file;
    append(file, std::string_view("RLVW"));
    append(file, kVersion);
    append(file, static_cast<std::uint32_t>(text.size()));
    append(file, std::string_view(text));
    for (const Block& block : blocks)
        append(file, block.stored);
    return file;
}

}  // namespace relevo::web
