#include <string>

#include "fuzz/fuzz.h"
#include "mesh/mesh.h"

namespace relevo::fuzz {

const Target kObj("obj", [](std::string_view bytes) { mesh::parse_obj("mesh.obj", bytes); });

}  // namespace relevo::fuzz
