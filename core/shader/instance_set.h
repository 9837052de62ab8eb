#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace relevo::shader {

/// Meshes that a plugin places on the ground, such as trees. Its function
/// `void <id>_place_<name>(in InstanceSite at, inout Instance it)` is called for each site.
struct InstanceSet {
    struct Level {
        std::filesystem::path mesh;  ///< .obj, .gltf or .glb. It exists
        /// Drawn where an instance of height_m is lower than this on the screen [px]; 0: the first.
        double below_px = 0;
    };
    std::string name;           ///< "conifer"
    std::string resource;       ///< "trees.conifer", also the name of its pass
    std::string function;       ///< "trees_place_conifer"
    double spacing_m = 10;      ///< side of a cell of the grid of sites, at the DEM's centre
    double height_m = 1;        ///< of the highest instance
    std::vector<Level> levels;  ///< finest first; at least one
    int line = 0;               ///< in plugin.json
};

}  // namespace relevo::shader
