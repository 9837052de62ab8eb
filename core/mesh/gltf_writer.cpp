#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "mesh/write.h"

namespace relevo::mesh {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kGltf = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;
constexpr int kFloat = 5126, kUnsignedInt = 5125, kArrayBuffer = 34962, kElementBuffer = 34963;

/// x east, y north, z up as glTF has it.
glm::vec3 y_up(const glm::vec3& v) {
    return {v.x, v.z, -v.y};
}

/// The parts of the binary chunk, as views and accessors of the JSON.
class Layout {
  public:
    /// @returns the index of the new accessor
    int add(std::uint64_t bytes, int target, Json accessor) {
        const int index = static_cast<int>(accessors.size());
        views.push_back(
            {{"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", bytes}, {"target", target}});
        accessor["bufferView"] = index;
        accessors.push_back(std::move(accessor));
        bytes_ += bytes;
        return index;
    }
    std::uint64_t bytes() const { return bytes_; }

    Json views = Json::array(), accessors = Json::array();

  private:
    std::uint64_t bytes_ = 0;
};

Json position_accessor(const Surface& surface) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (const glm::vec3& position : surface.position_m) {
        low = glm::min(low, y_up(position));
        high = glm::max(high, y_up(position));
    }
    return {{"componentType", kFloat},
            {"count", surface.position_m.size()},
            {"type", "VEC3"},
            {"min", {low.x, low.y, low.z}},
            {"max", {high.x, high.y, high.z}}};
}

Json document(const Surface& surface, const GltfText& text, Layout& layout) {
    const std::uint64_t count = surface.position_m.size();
    const auto of = [&](const char* type) {
        return Json{{"componentType", kFloat}, {"count", count}, {"type", type}};
    };
    Json attributes;
    attributes["POSITION"] =
        layout.add(sizeof(glm::vec3) * count, kArrayBuffer, position_accessor(surface));
    if (!surface.normal.empty())
        attributes["NORMAL"] = layout.add(sizeof(glm::vec3) * count, kArrayBuffer, of("VEC3"));
    if (!surface.texture.empty())
        attributes["TEXCOORD_0"] = layout.add(sizeof(glm::vec2) * count, kArrayBuffer, of("VEC2"));
    const int indices = layout.add(
        sizeof(std::uint32_t) * surface.corners.size(), kElementBuffer,
        {{"componentType", kUnsignedInt}, {"count", surface.corners.size()}, {"type", "SCALAR"}});
    const Json primitive{
        {"attributes", attributes}, {"indices", indices}, {"material", 0}, {"mode", 4}};
    return {
        {"asset",
         {{"version", "2.0"}, {"generator", text.generator}, {"extras", Json::parse(text.extras)}}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"mesh", 0}, {"name", text.name}}}},
        {"meshes", {{{"name", text.name}, {"primitives", {primitive}}}}},
        {"materials",
         {{{"name", "ground"},
           {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}}}},
        {"accessors", layout.accessors},
        {"bufferViews", layout.views},
        {"buffers", {{{"byteLength", layout.bytes()}}}}};
}

/// In the order of this machine, which is little-endian as the format is.
template <typename T>
void write_values(OutputFile& file, std::span<const T> values) {
    file.write(std::as_bytes(values));
}

/// A piece at a time: a mesh need not be in memory twice.
void write_turned(OutputFile& file, const std::vector<glm::vec3>& vectors) {
    constexpr std::size_t kAtOnce = 1 << 16;
    std::vector<glm::vec3> turned;
    for (std::size_t begin = 0; begin < vectors.size(); begin += kAtOnce) {
        turned.clear();
        for (std::size_t i = begin; i < std::min(vectors.size(), begin + kAtOnce); ++i)
            turned.push_back(y_up(vectors[i]));
        write_values<glm::vec3>(file, turned);
    }
}

void write_words(OutputFile& file, std::initializer_list<std::uint32_t> words) {
    write_values<std::uint32_t>(file, std::span(words.begin(), words.size()));
}

}  // namespace

void write_glb(OutputFile& file, const Surface& surface, const GltfText& text) {
    Layout layout;
    std::string json =
        document(surface, text, layout).dump(-1, ' ', false, Json::error_handler_t::replace);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    // All parts are of whole words: the chunk needs no padding.
    const std::uint64_t bytes = 12 + 8 + json.size() + 8 + layout.bytes();
    if (bytes > std::numeric_limits<std::uint32_t>::max())
        bad_input(
            fmt::format("{}: {} triangles take more than the 4 GiB that glTF has room for; "
                        "pass a larger --error, or --crop W,S,E,N",
                        printable(file.path().string()), surface.triangles()));
    write_words(file, {kGltf, 2, static_cast<std::uint32_t>(bytes),
                       static_cast<std::uint32_t>(json.size()), kJsonChunk});
    file.write(json);
    write_words(file, {static_cast<std::uint32_t>(layout.bytes()), kBinChunk});
    write_turned(file, surface.position_m);
    write_turned(file, surface.normal);
    write_values<glm::vec2>(file, surface.texture);
    write_values<std::uint32_t>(file, surface.corners);
}

}  // namespace relevo::mesh
