#pragma once

#include <string>

#include "output/exported_ground.h"
#include "output/ground_frame.h"
#include "output/heightmap.h"
#include "output/terrain_mesh.h"

/// What the files of an export say of themselves: JSON objects.
namespace relevo::output {

/// The file beside a heightmap or a normal map: where it is and what its values mean.
/// @param generator  "Relevo 0.1.0"
/// @param scale      of a heightmap, else null
/// @param green      of a normal map, else null
std::string map_json(const ExportedGround& ground, const std::string& generator,
                     const HeightScale* scale, const Green* green);

/// The extras of a glTF: origin, axes, CRS and error of a mesh.
/// @param frame    that the mesh is in
/// @param error_m  that was asked for
std::string mesh_json(const ExportedGround& ground, const std::string& generator,
                      const GroundFrame& frame, const TerrainMesh& mesh, double error_m);

}  // namespace relevo::output
