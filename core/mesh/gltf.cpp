#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "mesh/builder.h"
#include "mesh/gltf_buffers.h"
#include "mesh/mesh.h"

// Libraries for glTF were rejected. tinygltf (Debian 2.7) does not check the bounds of accessors
// and opens any file that a URI names; assimp brings forty formats. Each defect that this reader
// refuses has a test.
namespace relevo::mesh {
namespace {

using json::Value;

/// Component types by their numbers in glTF.
enum class Component { U8 = 5121, U16 = 5123, U32 = 5125, F32 = 5126 };

/// Elements of an accessor, checked against its buffer.
struct Accessor {
    std::string_view bytes;  ///< from the first element on
    std::size_t count = 0, stride = 0;
    int components = 1;
    Component component = Component::F32;

    /// A component as a number; whole numbers of colours are not yet divided.
    double at(std::size_t element, int index) const {
        const auto read = [&](auto value) {
            const std::size_t from =
                element * stride + static_cast<std::size_t>(index) * sizeof(value);
            std::memcpy(&value, bytes.data() + from, sizeof(value));
            return static_cast<double>(value);
        };
        switch (component) {
            case Component::U8:
                return read(std::uint8_t{});
            case Component::U16:
                return read(std::uint16_t{});
            case Component::U32:
                return read(std::uint32_t{});
            default:
                return read(float{});
        }
    }
    glm::vec3 vector(std::size_t element) const {
        const double most = component == Component::U8    ? 255.0
                            : component == Component::U16 ? 65535.0
                                                          : 1.0;
        return {at(element, 0) / most, at(element, 1) / most, at(element, 2) / most};
    }
};

/// Reads the default scene of a glTF file.
/// @source  Khronos, glTF 2.0 Specification (ISO/IEC 12113:2022)
class GltfReader {
  public:
    GltfReader(const std::filesystem::path& file, std::string_view bytes)
        : file_(file), parts_(gltf_parts(file, bytes)) {}

    Mesh read() {
        if (const Value* const needed = find(parts_.root, "extensionsRequired");
            needed && !needed->items.empty())
            fail(file_, fmt::format("expected no required extension but got {}",
                                    json::describe(needed->items.front())));
        const Value& scene = element("scenes", whole(parts_.root, "scene", 0));
        if (const Value* const nodes = find(scene, "nodes"))
            for (const Value& node : nodes->items)
                add_node(index_of(node, "nodes"), glm::mat4(1), 0);
        return finished(file_, std::move(mesh_), has_normals_);
    }

  private:
    std::size_t index_of(const Value& value, std::string_view what) const {
        if (value.kind != Value::Kind::Number || value.number < 0 || value.number > 4294967295.0 ||
            value.number != std::floor(value.number))
            fail(file_, fmt::format("{}: expected a whole number but got {}", what,
                                    json::describe(value)));
        return static_cast<std::size_t>(value.number);
    }
    std::size_t whole(const Value& object, std::string_view key, std::size_t otherwise) const {
        const Value* const value = find(object, key);
        return value ? index_of(*value, key) : otherwise;
    }
    const Value& element(std::string_view list, std::size_t index) const {
        const Value* const values = find(parts_.root, list);
        const std::size_t count = values ? values->items.size() : 0;
        if (index >= count)
            fail(file_,
                 fmt::format("{}: expected a number below {} but got {}", list, count, index));
        return values->items[index];
    }
    template <std::size_t N>
    std::array<float, N> floats(const Value& object, std::string_view key,
                                std::array<float, N> otherwise) const {
        const Value* const list = find(object, key);
        if (!list) return otherwise;
        if (list->items.size() != N)
            fail(file_,
                 fmt::format("{}: expected {} numbers but got {}", key, N, list->items.size()));
        for (std::size_t i = 0; i < N; ++i)
            otherwise[i] = static_cast<float>(list->items[i].number);
        return otherwise;
    }

    glm::mat4 matrix_of(const Value& node) const {
        const auto m = floats<16>(node, "matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
        glm::mat4 matrix;
        for (int i = 0; i < 16; ++i)
            matrix[i / 4][i % 4] = m[static_cast<std::size_t>(i)];
        const auto t = floats<3>(node, "translation", {0, 0, 0});
        const auto r = floats<4>(node, "rotation", {0, 0, 0, 1});
        const auto s = floats<3>(node, "scale", {1, 1, 1});
        glm::mat4 placed = glm::mat4_cast(glm::quat(r[3], r[0], r[1], r[2]));
        for (int i = 0; i < 3; ++i)
            placed[i] *= s[static_cast<std::size_t>(i)];
        placed[3] = glm::vec4(t[0], t[1], t[2], 1);
        return matrix * placed;
    }

    /// Nodes are a tree: each is added once.
    void add_node(std::size_t index, const glm::mat4& parent, int depth) {
        constexpr int kMaxDepth = 64;
        if (depth > kMaxDepth)
            fail(file_, fmt::format("nodes: expected at most {} in each other", kMaxDepth));
        const Value& node = element("nodes", index);
        if (seen_.size() <= index) seen_.resize(index + 1);
        if (seen_[index])
            fail(file_,
                 fmt::format("nodes: node {} is its own ancestor, or has two parents", index));
        seen_[index] = true;
        const glm::mat4 matrix = parent * matrix_of(node);
        if (find(node, "mesh")) add_mesh(element("meshes", whole(node, "mesh", 0)), matrix);
        if (const Value* const children = find(node, "children"))
            for (const Value& child : children->items)
                add_node(index_of(child, "children"), matrix, depth + 1);
    }

    void add_mesh(const Value& mesh, const glm::mat4& matrix) {
        const Value* const primitives = find(mesh, "primitives");
        if (!primitives) return;
        for (const Value& primitive : primitives->items) {
            constexpr std::size_t kTriangles = 4;
            const std::size_t mode = whole(primitive, "mode", kTriangles);
            if (mode != kTriangles)
                fail(file_,
                     fmt::format("primitives: expected triangles (mode 4) but got mode {}", mode));
            add_primitive(primitive, matrix);
        }
    }

    void add_primitive(const Value& primitive, const glm::mat4& matrix) {
        const Value* const attributes = find(primitive, "attributes");
        const auto attribute = [&](std::string_view name) -> std::optional<Accessor> {
            const Value* const index = attributes ? find(*attributes, name) : nullptr;
            if (!index) return {};
            return accessor(index_of(*index, name), name);
        };
        const std::optional<Accessor> positions = attribute("POSITION");
        if (!positions) fail(file_, "primitives: expected an attribute POSITION");
        const std::optional<Accessor> normals = attribute("NORMAL"), colours = attribute("COLOR_0");
        const std::size_t first = mesh_.vertices.size(), count = positions->count;
        if (count > kMaxVertices - first)
            fail(file_, fmt::format("expected at most {} vertices but got {}", kMaxVertices,
                                    first + count));
        for (const auto* const other : {&normals, &colours})
            if (*other && (*other)->count < count)
                fail(file_, fmt::format("accessors: expected {} elements, as POSITION has, but got "
                                        "{}",
                                        count, (*other)->count));
        if (!normals) has_normals_ = false;
        const glm::mat3 of_normals = transpose(inverse(glm::mat3(matrix)));
        const glm::vec3 base = base_colour(primitive);
        for (std::size_t i = 0; i < count; ++i) {
            Vertex vertex;
            vertex.position_m = turned(glm::vec3(matrix * glm::vec4(positions->vector(i), 1)));
            if (normals) vertex.normal = turned(of_normals * normals->vector(i));
            vertex.colour = colours ? base * colours->vector(i) : base;
            mesh_.vertices.push_back(vertex);
        }
        add_indices(primitive, first, count, glm::determinant(glm::mat3(matrix)) < 0);
    }

    /// @param mirrored  the node turns triangles over
    void add_indices(const Value& primitive, std::size_t first, std::size_t count, bool mirrored) {
        std::optional<Accessor> indices;
        if (find(primitive, "indices")) {
            indices = accessor(whole(primitive, "indices", 0), "indices");
            if (indices->component == Component::F32)
                fail(file_, "indices: expected whole numbers but got floats");
        }
        const std::size_t corners = indices ? indices->count : count;
        if (corners % 3 != 0 || corners > 3 * kMaxTriangles - mesh_.indices.size())
            fail(file_, fmt::format("indices: expected three for each of at most {} triangles but "
                                    "got {}",
                                    kMaxTriangles, corners));
        for (std::size_t corner = 0; corner < corners; ++corner) {
            const std::size_t i = mirrored ? corner / 3 * 3 + 2 - corner % 3 : corner;
            const auto index = indices ? static_cast<std::size_t>(indices->at(i, 0)) : i;
            if (index >= count)
                fail(file_,
                     fmt::format("indices: expected a number below {} but got {}", count, index));
            mesh_.indices.push_back(static_cast<std::uint16_t>(first + index));
        }
    }

    glm::vec3 base_colour(const Value& primitive) const {
        if (!find(primitive, "material")) return glm::vec3(1);
        const Value& material = element("materials", whole(primitive, "material", 0));
        const Value* const rough = find(material, "pbrMetallicRoughness");
        if (!rough) return glm::vec3(1);
        const auto colour = floats<4>(*rough, "baseColorFactor", {1, 1, 1, 1});
        return {colour[0], colour[1], colour[2]};
    }

    /// @param what  attribute; decides how many components it has
    Accessor accessor(std::size_t index, std::string_view what) const {
        const Value& given = element("accessors", index);
        if (find(given, "sparse"))
            fail(file_, "accessors: sparse ones are not read; export without them");
        Accessor result;
        const std::size_t type = whole(given, "componentType", 0);
        const bool is_vector = what != "indices", is_colour = what == "COLOR_0";
        const bool is_known = type == 5121 || type == 5123 || type == 5125 || type == 5126;
        if (!is_known || (is_vector && !is_colour && type != 5126) || (is_colour && type == 5125))
            fail(file_, fmt::format("{}: expected another componentType than {}", what, type));
        result.component = static_cast<Component>(type);
        const Value* const shape = find(given, "type");
        const std::string name = shape ? shape->text : "";
        const bool fits = is_colour   ? name == "VEC3" || name == "VEC4"
                          : is_vector ? name == "VEC3"
                                      : name == "SCALAR";
        if (!fits) fail(file_, fmt::format("{}: expected another type than \"{}\"", what, name));
        result.components = name == "SCALAR" ? 1 : name == "VEC3" ? 3 : 4;
        result.count = whole(given, "count", 0);
        place(given, result, what);
        return result;
    }

    /// Finds an accessor's bytes.
    void place(const Value& given, Accessor& accessor, std::string_view what) const {
        const std::size_t size = accessor.component == Component::U8    ? 1
                                 : accessor.component == Component::U16 ? 2
                                                                        : 4;
        const std::size_t bytes = size * static_cast<std::size_t>(accessor.components);
        const Value& view = element("bufferViews", whole(given, "bufferView", SIZE_MAX));
        const std::size_t buffer = whole(view, "buffer", 0);
        if (buffer >= parts_.buffers.size())
            fail(file_, fmt::format("buffers: expected a number below {} but got {}",
                                    parts_.buffers.size(), buffer));
        const std::string& all = parts_.buffers[buffer];
        accessor.stride = whole(view, "byteStride", bytes);
        constexpr std::size_t kMaxStride = 252;  // of the format
        // Each number has at most 32 bits, so that sums and products do not overflow.
        const std::size_t from = whole(view, "byteOffset", 0) + whole(given, "byteOffset", 0);
        const std::size_t end =
            accessor.count == 0 ? from : from + (accessor.count - 1) * accessor.stride + bytes;
        if (accessor.stride < bytes || accessor.stride > kMaxStride || end > all.size())
            fail(file_, fmt::format("{}: expected {} elements in a buffer of {} bytes but they end "
                                    "at byte {}",
                                    what, accessor.count, all.size(), end));
        accessor.bytes = std::string_view(all).substr(from);
    }

    const std::filesystem::path& file_;
    GltfParts parts_;
    std::vector<bool> seen_;  // nodes
    bool has_normals_ = true;
    Mesh mesh_;
};

}  // namespace

Mesh parse_gltf(const std::filesystem::path& file, std::string_view bytes) {
    return GltfReader(file, bytes).read();
}

}  // namespace relevo::mesh
