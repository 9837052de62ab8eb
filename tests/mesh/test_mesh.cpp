#include <chrono>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "base/error.h"
#include "mesh/mesh.h"
#include "support/support.h"

namespace relevo::mesh {
namespace {

void expect_near(const glm::vec3& found, const glm::vec3& expected) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found[i], expected[i], 1e-6) << i;
}

TEST(Obj, YUpBecomesZUpAndZSouth) {
    const Mesh mesh = parse_obj("a.obj",
                                "v 1 2 3\nv 0 0 0 0.5 0.25 0 # a colour\nv 1 0 0\n"
                                "vn 0 1 0\nf 1//1 2//1 3//1\n");
    ASSERT_EQ(mesh.vertices.size(), 3U);
    expect_near(mesh.vertices[0].position_m, {1, -3, 2});
    expect_near(mesh.vertices[0].normal, {0, 0, 1});
    expect_near(mesh.vertices[1].colour, {0.5, 0.25, 0});
    expect_near(mesh.high_m(), {1, 0, 2});
}

TEST(Obj, PolygonsBecomeFansAndNegativeNumbersCountFromTheEnd) {
    const Mesh mesh = parse_obj("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4 -3 -2 -1\r\n");
    EXPECT_EQ(mesh.indices, (std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}));
    // Counter-clockwise as seen from south, which normals point to.
    expect_near(mesh.vertices[0].normal, {0, -1, 0});
}

/// Three vertices as floats and three indices as bytes.
std::string triangle_buffer() {
    const float values[9] = {0, 0, 0, 0, 2, 0, 1, 0, 0};
    std::string bytes(sizeof(values), '\0');
    std::memcpy(bytes.data(), values, sizeof(values));
    return bytes + std::string("\0\1\2\0", 4);
}

std::string gltf_json(
    const std::string& buffer = R"({"byteLength": 40})", const std::string& node = R"({"mesh": 0})",
    const std::string& positions =
        R"({"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3})",
    const std::string& indices =
        R"({"bufferView": 1, "componentType": 5121, "type": "SCALAR", "count": 3})",
    const std::string& more = "") {
    return R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [)" + node +
           R"(], "buffers": [)" + buffer +
           R"(], "bufferViews": [{"buffer": 0, "byteLength": 36},
               {"buffer": 0, "byteOffset": 36, "byteLength": 3}], "accessors": [)" +
           positions + "," + indices + R"(], "materials": [{"pbrMetallicRoughness":
               {"baseColorFactor": [0.5, 1, 0, 1]}}], "meshes": [{"primitives": [
               {"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}])" +
           more + "}";
}

std::string le(std::uint32_t word) {
    std::string bytes(4, '\0');
    for (std::size_t i = 0; i < 4; ++i)
        bytes[i] = static_cast<char>(word >> (8 * i));
    return bytes;
}

std::string glb(std::string json, const std::string& binary) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::string body = le(static_cast<std::uint32_t>(json.size())) + "JSON" + json +
                             le(static_cast<std::uint32_t>(binary.size())) +
                             std::string("BIN\0", 4) + binary;
    return "glTF" + le(2) + le(static_cast<std::uint32_t>(body.size() + 12)) + body;
}

TEST(Gltf, BinaryFilesNodesAndMaterialsAreRead) {
    const std::string node =
        R"({"mesh": 0, "scale": [2, 2, 2], "translation": [10, 0, 0],
            "rotation": [0, 0.70710678, 0, 0.70710678]})";
    const Mesh mesh =
        parse_gltf("a.glb", glb(gltf_json(R"({"byteLength": 40})", node), triangle_buffer()));
    ASSERT_EQ(mesh.indices, (std::vector<std::uint16_t>{0, 1, 2}));
    expect_near(mesh.vertices[1].position_m, {10, 0, 4});
    // A quarter turn about the axis y brings x to -z, which is north.
    expect_near(mesh.vertices[2].position_m, {10, 2, 0});
    expect_near(mesh.vertices[0].colour, {0.5, 1, 0});
    EXPECT_NEAR(glm::length(mesh.vertices[0].normal), 1, 1e-6);
}

TEST(Gltf, BuffersOfDataUrisAreRead) {
    const Mesh from_uri = parse_gltf(
        "b.gltf", gltf_json(R"({"byteLength": 40, "uri": "data:application/octet-stream;base64,)"
                            "AAAAAAAAAAAAAAAAAAAAAAAAAEAAAAAAAACAPwAAAAAAAAAAAAECAA==\"}"));
    const Mesh from_chunk =
        parse_gltf("a.glb", glb(gltf_json(R"({"byteLength": 40})"), triangle_buffer()));
    ASSERT_EQ(from_uri.vertices.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i)
        expect_near(from_uri.vertices[i].position_m, from_chunk.vertices[i].position_m);
}

TEST(Gltf, AMirroredNodeKeepsItsOutside) {
    const auto with = [](const char* scale) {
        return parse_gltf("a.glb",
                          glb(gltf_json(R"({"byteLength": 40})", scale), triangle_buffer()));
    };
    const Mesh plain = with(R"({"mesh": 0})"),
               mirrored = with(R"({"mesh": 0, "scale": [-1, 1, 1]})");
    EXPECT_EQ(plain.indices, (std::vector<std::uint16_t>{0, 1, 2}));
    EXPECT_EQ(mirrored.indices, (std::vector<std::uint16_t>{2, 1, 0}));
}

struct Fault {
    std::string name, file, bytes, message;
};

class MeshFault : public testing::TestWithParam<Fault> {};

TEST_P(MeshFault, EndsSoonWithOneMessage) {
    const auto begin = std::chrono::steady_clock::now();
    try {
        GetParam().file.ends_with(".obj") ? parse_obj(GetParam().file, GetParam().bytes)
                                          : parse_gltf(GetParam().file, GetParam().bytes);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()), GetParam().message);
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
}

const std::string kPositions =
    R"({"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3})";
const std::string kPlain = R"({"byteLength": 40})", kNode = R"({"mesh": 0})";

std::string with_nan() {
    std::string bytes = triangle_buffer();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(bytes.data() + 4, &nan, sizeof(nan));
    return bytes;
}

INSTANTIATE_TEST_SUITE_P(
    , MeshFault,
    testing::Values(
        Fault{"obj_nan", "a.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
              "mesh: a.obj: expected finite numbers but got NaN or infinity"},
        Fault{"obj_word", "a.obj", "v 1 x 3\n", "mesh: a.obj:1: expected a number but got \"x\""},
        Fault{"obj_index", "a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 1000000000\n",
              "mesh: a.obj:3: expected a number from 1 to 2 but got 1000000000"},
        Fault{"obj_empty", "a.obj", "", "mesh: a.obj: expected triangles but got none"},
        Fault{"obj_point", "a.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n",
              "mesh: a.obj: expected a size of up to 10000 m but got 0 m"},
        Fault{"short", "a.glb", "glTF", "mesh: a.glb: expected version 2 of binary glTF"},
        Fault{"chunk", "a.glb", "glTF" + le(2) + le(30) + le(4000000000U) + "JSON{}",
              "mesh: a.glb: expected a chunk of 4000000000 bytes but the file ends after 2"},
        Fault{"nan", "a.glb", glb(gltf_json(), with_nan()),
              "mesh: a.glb: expected finite numbers but got NaN or infinity"},
        Fault{"many", "a.glb",
              glb(gltf_json(kPlain, kNode, kPositions,
                            R"({"bufferView": 1, "componentType": 5121, "type": "SCALAR",
                                "count": 1000000000})"),
                  triangle_buffer()),
              "mesh: a.glb: indices: expected 1000000000 elements in a buffer of 40 bytes but they "
              "end at byte 1000000036"},
        Fault{"beyond", "a.glb",
              glb(gltf_json(kPlain, kNode,
                            R"({"bufferView": 0, "byteOffset": 4294967295, "componentType": 5126,
                                "type": "VEC3", "count": 3})"),
                  triangle_buffer()),
              "mesh: a.glb: POSITION: expected 3 elements in a buffer of 40 bytes but they end at "
              "byte 4294967331"},
        Fault{"negative", "a.glb", glb(gltf_json(kPlain, R"({"mesh": -1})"), triangle_buffer()),
              "mesh: a.glb: mesh: expected a whole number but got -1"},
        Fault{"index", "a.glb",
              glb(gltf_json(kPlain, kNode, kPositions,
                            R"({"bufferView": 1, "componentType": 5121, "type": "SCALAR",
                                "count": 3, "byteOffset": 1})"),
                  triangle_buffer().replace(38, 2, "\x09\x01")),
              "mesh: a.glb: indices: expected a number below 3 but got 9"},
        Fault{"cycle", "a.glb",
              glb(gltf_json(kPlain, R"({"mesh": 0, "children": [0]})"), triangle_buffer()),
              "mesh: a.glb: nodes: node 0 is its own ancestor, or has two parents"},
        Fault{"sparse", "a.glb",
              glb(gltf_json(kPlain, kNode,
                            R"({"sparse": {}, "componentType": 5126, "type": "VEC3", "count": 3})"),
                  triangle_buffer()),
              "mesh: a.glb: accessors: sparse ones are not read; export without them"},
        Fault{"draco", "a.glb",
              glb(gltf_json(kPlain, kNode, kPositions, kPositions,
                            R"(, "extensionsRequired": ["KHR_draco_mesh_compression"])"),
                  triangle_buffer()),
              "mesh: a.glb: expected no required extension but got "
              "\"KHR_draco_mesh_compression\""},
        Fault{"outside", "a.gltf", gltf_json(R"({"byteLength": 40, "uri": "../a.bin"})"),
              "mesh: a.gltf: buffers: expected them in the file itself but got \"../a.bin\"; save "
              "it as .glb, or "
              "embed them"},
        Fault{"net", "a.gltf", gltf_json(R"({"byteLength": 40, "uri": "data:text/plain,abc"})"),
              "mesh: a.gltf: buffers: expected base64 in its data URI"}),
    [](const auto& fault) { return fault.param.name; });

}  // namespace
}  // namespace relevo::mesh
