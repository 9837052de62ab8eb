#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace relevo::shader {

/// Meshes that a plugin places on the ground, such as trees. Its function
/// `void <id>_place_<name>(in InstanceSite at, inout Instance it)` is called for each site.
struct InstanceSet {
    struct Level {
        /// One of each kind: .obj, .gltf or .glb. They exist. None: points that look like crowns.
        std::vector<std::filesystem::path> meshes;
        bool is_sprite() const { return meshes.empty(); }
        /// Drawn where an instance of height_m is lower than this on the screen [px]; 0: the first.
        double below_px = 0;
    };
    std::string name;           ///< "tree"
    std::string resource;       ///< "trees.tree", also the name of its pass
    std::string function;       ///< "trees_place_tree"
    double spacing_m = 10;      ///< side of a cell of the grid of sites, at the DEM's centre
    double height_m = 1;        ///< of the highest instance
    bool casts_shadow = true;   ///< on the ground and on other instances
    double light_through = 0;   ///< share of the sun's light that passes an instance, 0 to 1
    std::vector<Level> levels;  ///< finest first; the first has meshes, the last may be sprites
    int line = 0;               ///< in plugin.json
    bool has_sprites() const { return levels.back().is_sprite(); }
};

}  // namespace relevo::shader
