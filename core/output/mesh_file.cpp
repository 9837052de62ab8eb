#include "output/mesh_file.h"

#include <algorithm>
#include <filesystem>
#include <limits>

#include <fmt/format.h>

#include "base/text.h"
#include "mesh/write.h"
#include "output/export_text.h"

namespace relevo::output {
namespace {

glm::dvec3 size_of(const mesh::Surface& surface) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (const glm::vec3& position : surface.position_m) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    return glm::dvec3(high) - glm::dvec3(low);
}

}  // namespace

MeshFile write_mesh(OutputFile& file, ExportedGround ground, MeshFileOptions options) {
    options.mesh.name = ground.field.about.path;
    options.mesh.flat = options.mesh.flat || options.mesh.solid;
    const GroundFrame frame(ground.field.grid, options.mesh.flat);
    MeshFile made{.mesh = terrain_mesh(std::move(ground.field.height_m), ground.field.grid, frame,
                                       options.mesh),
                  .is_flat = frame.is_flat()};
    made.size_m = size_of(made.mesh.surface);
    made.mm_per_m =
        options.mm_per_m.value_or(options.width_mm / std::max(made.size_m.x, made.size_m.y));
    const std::string name =
        printable(std::filesystem::path(ground.field.about.path).stem().string());
    if (options.is_stl)
        mesh::write_stl(
            file, made.mesh.surface,
            fmt::format("{}: {}, 1:{:.6g}, mm", options.generator, name, 1000 / made.mm_per_m),
            made.mm_per_m);
    else
        mesh::write_glb(
            file, made.mesh.surface,
            {options.generator, name,
             mesh_json(ground, options.generator, frame, made.mesh, options.mesh.error_m)});
    return made;
}

}  // namespace relevo::output
