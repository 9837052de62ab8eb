#include "scene/scene.h"

#include <string>

#include "fuzz/fuzz.h"

void relevo::fuzz::read(std::string_view bytes) {
    scene::read_scene_text(std::string(bytes), "scene.json", folder());
}
