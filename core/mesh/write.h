#pragma once

#include <string>

#include "base/output_file.h"
#include "mesh/surface.h"

/// Files of large meshes, for other programs.
namespace relevo::mesh {

struct GltfText {
    std::string generator;  ///< "Relevo 0.1.0"
    std::string name;       ///< of the mesh
    std::string extras;     ///< of the asset: a JSON object
};

/// Writes binary glTF 2.0, all of it but finish(): metres, y up, x east, z south, one node with one
/// mesh of indexed triangles (32 bits) and a rough white material.
/// @throws Error (BadInput) for more than the 4 GiB that the format has room for, (Failed) where
///     the disk refuses
void write_glb(OutputFile& file, const Surface& surface, const GltfText& text);

/// Writes binary STL, all of it but finish(): z up, x east, y north, the lower corner of the
/// bounding box at the origin, millimetres by convention.
/// @param title     the first 80 bytes of the file
/// @param mm_per_m  of the model for a metre of the surface
/// @throws Error (Failed) where the disk refuses
void write_stl(OutputFile& file, const Surface& surface, const std::string& title, double mm_per_m);

}  // namespace relevo::mesh
