#pragma once

#include <optional>
#include <string>

#include <glm/vec3.hpp>

#include "base/output_file.h"
#include "output/exported_ground.h"
#include "output/ground_frame.h"
#include "output/terrain_mesh.h"

namespace relevo::output {

struct MeshFileOptions {
    std::string generator;  ///< "Relevo 0.1.0"
    bool is_stl = false;    ///< millimetres, for printing; else binary glTF
    TerrainMeshOptions mesh{};
    std::optional<double> mm_per_m{};  ///< of a .stl; none: `width_mm`
    double width_mm = 150;             ///< longer side of a .stl
};

struct MeshFile {
    TerrainMesh mesh;
    bool is_flat = false;  ///< in the plane of the CRS
    glm::dvec3 size_m{0};
    double mm_per_m = 1;  ///< of a .stl
};

/// Writes the triangles of a DEM, all of the file but finish().
/// @param ground  its heights are taken
/// @throws Error as terrain_mesh(), mesh::write_glb() and mesh::write_stl()
MeshFile write_mesh(OutputFile& file, ExportedGround ground, MeshFileOptions options);

}  // namespace relevo::output
