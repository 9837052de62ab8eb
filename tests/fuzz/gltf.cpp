#include <string>

#include "fuzz/fuzz.h"
#include "mesh/mesh.h"

namespace relevo::fuzz {

const Target kGltf("gltf", [](std::string_view bytes) {
    mesh::parse_gltf(bytes.starts_with("glTF") ? "mesh.glb" : "mesh.gltf", bytes);
});

}  // namespace relevo::fuzz
