#include "render/instances.h"

#include <algorithm>
#include <span>

namespace relevo::render {
namespace {

constexpr int kPositionBinding = 0, kBlockBinding = 1, kNormalBinding = 2;
constexpr int kBlockInput = 1, kNormalInput = 15;
constexpr int kComponents = 4;  // of a vector

// Share of the distance by which an instance may change its mesh sooner or later: kDetailJitter of
// instance.vert.glsl, half of it either way.
constexpr double kJitter = 0.1;

/// Inputs of a draw: the tile's, the cells, the distances of the mesh.
struct BlockInputs {
    TileMesh::Instance tile;
    glm::vec4 cells, detail;
};
constexpr int kBlockVectors = TileMesh::kInstanceVectors + 2;
/// Draws with their inputs.
struct Batch {
    std::vector<BlockInputs> inputs;
    std::vector<gl::VertexArray::Draw> draws;

    /// A copy of the mesh for each cell of a row, an instance for each row.
    void add(const InstanceMesh::Part& part, int kind, const InstanceBlock& block,
             const glm::vec4& detail) {
        for (int x = 0; x < block.count.x; x += part.copies) {
            const int copies = std::min(part.copies, block.count.x - x);
            draws.push_back({part.indices * static_cast<std::uint32_t>(copies),
                             static_cast<std::uint32_t>(block.count.y), part.first_index,
                             part.first_vertex, static_cast<std::uint32_t>(inputs.size())});
            inputs.push_back({block.tile, block.cells + glm::vec4(x, 0, kind, 0), detail});
        }
    }
};

static_assert(sizeof(BlockInputs) == kBlockVectors * sizeof(glm::vec4));

}  // namespace

Instances::Set::Set(const shader::InstanceSet& of) : set(of), mesh(of) {
    array.attributes(kPositionBinding, mesh.positions, 0, 1, kComponents, false);
    array.attributes(kNormalBinding, mesh.normals, kNormalInput, 1, kComponents, false);
    array.attributes(kBlockBinding, kBlockInput, kBlockVectors, kComponents, true);
    array.hold(kBlockBinding);
    array.indices(mesh.indices);
}

Instances::Instances(const std::vector<shader::InstanceSet>& sets) {
    for (const shader::InstanceSet& set : sets)
        sets_.push_back(std::make_unique<Set>(set));
}

Instances::Set& Instances::find(std::string_view resource) {
    return **std::ranges::find_if(sets_,
                                  [&](const auto& each) { return each->set.resource == resource; });
}

void Instances::draw(std::string_view resource, bool sprites, Terrain& terrain,
                     const TileSelection& selection, const LodView& lod_view, double pixel_rad) {
    Set& set = find(resource);
    const InstanceView view(set.set, terrain, lod_view, pixel_rad);
    const std::vector<InstanceBlock> blocks = instance_blocks(set.set, terrain, selection, view);
    Batch batch;
    const std::vector<shader::InstanceSet::Level>& levels = set.set.levels;
    for (std::size_t level = 0; level < levels.size(); ++level) {
        if (levels[level].is_sprite() != sprites) continue;
        const bool is_last = level + 1 == levels.size();
        const double from_m = level == 0 ? 0 : view.distance_m(set.set, levels[level].below_px);
        const double to_m =
            is_last ? 2 * view.range_m : view.distance_m(set.set, levels[level + 1].below_px);
        for (const InstanceBlock& block : blocks) {
            if (block.farthest_m * (1 + kJitter) < from_m || block.nearest_m * (1 - kJitter) > to_m)
                continue;
            const glm::vec4 detail(from_m, to_m, view.cells_per_post);
            for (std::size_t kind = 0; kind < set.mesh.levels[level].size(); ++kind)
                batch.add(set.mesh.levels[level][kind], static_cast<int>(kind), block, detail);
        }
    }
    if (batch.draws.empty()) return;
    set.array.feed(kBlockBinding,
                   set.blocks.write(std::as_bytes(std::span(batch.inputs)), sizeof(glm::vec4)),
                   sizeof(BlockInputs));
    const auto draws =
        set.draws.write(std::as_bytes(std::span(batch.draws)), sizeof(std::uint32_t));
    sprites ? set.array.draw_points(draws) : set.array.draw(draws);
}

}  // namespace relevo::render
