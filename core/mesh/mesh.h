#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

/// Small triangle meshes for instances of effects: Wavefront OBJ and glTF 2.0.
namespace relevo::mesh {

/// Vertices of a mesh are numbered with 16 bits.
inline constexpr std::size_t kMaxVertices = 65535;
inline constexpr std::size_t kMaxTriangles = 65536;

struct Vertex {
    glm::vec3 position_m{0};    ///< x east, y north, z up
    glm::vec3 normal{0, 0, 1};  ///< unit
    glm::vec3 colour{1, 1, 1};  ///< factor on reflectance, 0..1, linear
};

struct Mesh {
    std::vector<Vertex> vertices;
    std::vector<std::uint16_t> indices;  ///< three a triangle, counter-clockwise from outside

    glm::vec3 low_m() const;   ///< lower corner of the bounding box
    glm::vec3 high_m() const;  ///< upper corner
};

/// Reads a mesh by its file's extension: .obj, .gltf or .glb. Both formats have y up and metres: x
/// becomes east, -z north, y up. A mesh without normals gets means of its triangles' normals,
/// weighted by area.
///
/// Of OBJ it reads v (with r g b behind the position, if given), vn and f; polygons become fans. Of
/// glTF it reads the triangles of the default scene with their nodes' transformations, POSITION,
/// NORMAL, COLOR_0 and baseColorFactor; textures, skins and animations are ignored. Sparse
/// accessors and required extensions are refused.
/// @throws Error (BadInput) `mesh: file: what is wrong`, for a file that cannot be read or breaks
///     its format, that has numbers that are not finite, or more than kMaxVertices or kMaxTriangles
Mesh read(const std::filesystem::path& file);

/// Read a format from memory, as read() does.
/// @param file  its name for messages
Mesh parse_obj(const std::filesystem::path& file, std::string_view text);
Mesh parse_gltf(const std::filesystem::path& file, std::string_view bytes);

}  // namespace relevo::mesh
