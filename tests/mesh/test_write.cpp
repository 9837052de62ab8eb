#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "mesh/mesh.h"
#include "mesh/write.h"
#include "support/support.h"

namespace relevo::mesh {
namespace {

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

template <typename T>
T value_at(const std::string& bytes, std::size_t offset) {
    T value{};
    EXPECT_LE(offset + sizeof(T), bytes.size());
    std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
}

/// A roof: its ridge runs north, its west side is wider.
Surface roof() {
    Surface surface;
    surface.position_m = {{0, 0, 1}, {3, 0, 5}, {4, 0, 1}, {0, 2, 1}, {3, 2, 5}, {4, 2, 1}};
    surface.normal.assign(6, {0, 0, 1});
    surface.texture = {{0, 1}, {0.75, 1}, {1, 1}, {0, 0}, {0.75, 0}, {1, 0}};
    surface.corners = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
    return surface;
}

std::filesystem::path glb_of(const Surface& surface) {
    const std::filesystem::path path = test::scratch_dir() / "a.glb";
    OutputFile file(path, true, "test");
    write_glb(file, surface, {"Relevo test", "roof", R"({"origin": {"lat_deg": 47}})"});
    file.finish();
    return path;
}

/// What the specification of glTF 2.0 asks of a binary file and its accessors (3.6, 4.4).
TEST(WriteGlb, IsValid) {
    const std::string bytes = bytes_of(glb_of(roof()));
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(value_at<std::uint32_t>(bytes, 4), 2U);
    EXPECT_EQ(value_at<std::uint32_t>(bytes, 8), bytes.size());
    const auto json_bytes = value_at<std::uint32_t>(bytes, 12);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    EXPECT_EQ(json_bytes % 4, 0U);
    const std::size_t chunk = 20 + json_bytes;
    EXPECT_EQ(bytes.substr(chunk + 4, 4), std::string("BIN\0", 4));
    EXPECT_EQ(chunk + 8 + value_at<std::uint32_t>(bytes, chunk), bytes.size());
    const nlohmann::json json = nlohmann::json::parse(bytes.substr(20, json_bytes));
    EXPECT_EQ(json["asset"]["version"], "2.0");
    EXPECT_EQ(json["asset"]["extras"]["origin"]["lat_deg"], 47);
    EXPECT_EQ(json["buffers"][0]["byteLength"], value_at<std::uint32_t>(bytes, chunk));
    const nlohmann::json primitive = json["meshes"][0]["primitives"][0];
    std::size_t end = 0;
    for (const nlohmann::json& accessor : json["accessors"]) {
        const nlohmann::json view = json["bufferViews"][accessor["bufferView"].get<int>()];
        const std::string type = accessor["type"];
        const std::size_t parts = type == "VEC3" ? 3 : type == "VEC2" ? 2 : 1;
        EXPECT_EQ(view["byteOffset"], end);  // one after the other
        EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0U);
        EXPECT_EQ(view["byteLength"], 4 * parts * accessor["count"].get<std::size_t>());
        end += view["byteLength"].get<std::size_t>();
    }
    EXPECT_EQ(end, json["buffers"][0]["byteLength"]);
    const nlohmann::json position =
        json["accessors"][primitive["attributes"]["POSITION"].get<int>()];
    EXPECT_EQ(position["min"], (nlohmann::json{0, 1, -2}));
    EXPECT_EQ(position["max"], (nlohmann::json{4, 5, 0}));
    EXPECT_EQ(json["accessors"][primitive["indices"].get<int>()]["componentType"], 5125);
    EXPECT_EQ(json["bufferViews"].size(), 4U);
    EXPECT_EQ(json["bufferViews"][0]["target"], 34962);
    EXPECT_EQ(json["bufferViews"][3]["target"], 34963);
}

TEST(WriteGlb, IsReadAgainAsItWas) {
    const Surface surface = roof();
    const Mesh mesh = read(glb_of(surface));
    ASSERT_EQ(mesh.indices.size(), surface.corners.size());
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        EXPECT_EQ(mesh.vertices[mesh.indices[i]].position_m,
                  surface.position_m[surface.corners[i]]);
        EXPECT_EQ(mesh.vertices[mesh.indices[i]].normal, glm::vec3(0, 0, 1));
    }
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const auto at = [&](std::size_t k) {
            return mesh.vertices[mesh.indices[i + k]].position_m;
        };
        EXPECT_GT(glm::cross(at(1) - at(0), at(2) - at(0)).z, 0);  // seen from above
    }
}

TEST(WriteStl, HasMillimetresFromItsCornerAndOutwardNormals) {
    const std::filesystem::path path = test::scratch_dir() / "a.stl";
    OutputFile file(path, true, "test");
    write_stl(file, roof(), "Relevo test: solid", 10);
    file.finish();
    const std::string bytes = bytes_of(path);
    ASSERT_EQ(bytes.size(), 84U + 50 * 4);
    EXPECT_FALSE(bytes.starts_with("solid"));  // which marks the text form
    EXPECT_EQ(value_at<std::uint32_t>(bytes, 80), 4U);
    const auto vector = [&](std::size_t facet, std::size_t k) {
        return value_at<glm::vec3>(bytes, 84 + 50 * facet + 12 * k);
    };
    EXPECT_EQ(vector(0, 1), glm::vec3(0, 0, 0));
    EXPECT_EQ(vector(0, 2), glm::vec3(30, 0, 40));
    EXPECT_EQ(vector(0, 3), glm::vec3(30, 20, 40));
    EXPECT_NEAR(vector(0, 0).x, -0.8, 1e-6);
    EXPECT_NEAR(vector(0, 0).z, 0.6, 1e-6);
    for (std::size_t facet = 0; facet < 4; ++facet)
        EXPECT_GT(vector(facet, 0).z, 0);
}

}  // namespace
}  // namespace relevo::mesh
