#include <string>

#include "fuzz/fuzz.h"
#include "mesh/mesh.h"

void relevo::fuzz::read(std::string_view bytes) {
    mesh::parse_gltf(bytes.starts_with("glTF") ? "mesh.glb" : "mesh.gltf", bytes);
}
