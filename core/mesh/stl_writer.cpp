#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "mesh/write.h"

namespace relevo::mesh {
namespace {

constexpr std::size_t kHeaderBytes = 80, kFacetBytes = 50;

}  // namespace

void write_stl(OutputFile& file, const Surface& surface, const std::string& title,
               double mm_per_m) {
    glm::vec3 low(std::numeric_limits<float>::max());
    for (const glm::vec3& position : surface.position_m)
        low = glm::min(low, position);
    std::string header = title.substr(0, kHeaderBytes);
    header.resize(kHeaderBytes, ' ');
    file.write(header);
    const auto count = static_cast<std::uint32_t>(surface.triangles());
    file.write(std::as_bytes(std::span(&count, 1)));
    std::vector<std::byte> bytes;
    constexpr std::size_t kAtOnce = 1 << 14;
    for (std::size_t begin = 0; begin < surface.triangles(); begin += kAtOnce) {
        const std::size_t end = std::min(surface.triangles(), begin + kAtOnce);
        bytes.assign((end - begin) * kFacetBytes, std::byte{0});
        for (std::size_t triangle = begin; triangle < end; ++triangle) {
            std::array<glm::vec3, 4> facet{};  // the normal, then the corners
            for (std::size_t i = 0; i < 3; ++i) {
                const glm::vec3& at = surface.position_m[surface.corners[3 * triangle + i]];
                facet[i + 1] = glm::vec3(mm_per_m * glm::dvec3(at - low));
            }
            const glm::dvec3 normal =
                glm::cross(glm::dvec3(facet[2] - facet[1]), glm::dvec3(facet[3] - facet[1]));
            if (const double length = glm::length(normal); length > 0)
                facet[0] = glm::vec3(normal / length);
            std::memcpy(bytes.data() + (triangle - begin) * kFacetBytes, facet.data(),
                        sizeof facet);
        }
        file.write(std::span<const std::byte>(bytes));
    }
}

}  // namespace relevo::mesh
