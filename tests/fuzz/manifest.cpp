#include "effect/manifest.h"

#include <string>

#include "fuzz/fuzz.h"

namespace relevo::fuzz {

// A manifest names files, which have to exist.
const Target kManifest("manifest", [](std::string_view bytes) {
    static const bool others [[maybe_unused]] = [] {
        for (const char* const name :
             {"haze.glsl", "a.glsl", "b.glsl", "a.png", "b.png", "a.csv", "a.obj"})
            file("", name);
        return true;
    }();
    file(bytes, "plugin.json");
    effect::load_manifest(folder(), folder());
});

}  // namespace relevo::fuzz
