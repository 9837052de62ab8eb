#include "render/instances.h"

#include <algorithm>
#include <optional>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace relevo::render {
namespace {

constexpr int kPositionBinding = 0, kBlockBinding = 1, kNormalBinding = 2;
constexpr int kBlockInput = 1, kNormalInput = 15;
constexpr int kVectorComponents = 4;  // of a vector

// Share of the distance by which an instance may change its mesh sooner or later: kDetailJitter of
// instance.vert.glsl, half of it either way.
constexpr double kJitter = 0.1;

/// Inputs of a draw: the tile's, the cells, the distances of the mesh.
struct BlockInputs {
    TileMesh::Instance tile;
    glm::vec4 cells, detail;
};
constexpr int kBlockVectors = TileMesh::kInstanceVectors + 2;
static_assert(sizeof(BlockInputs) == kBlockVectors * sizeof(glm::vec4));

double pixel_of(const PassContext& frame) {
    return length(glm::vec3(frame.block.pixel_ray_dx));
}

LodView view_of(const PassContext& frame) {
    const glm::ivec2 picture = frame.picture_px();
    return LodView::of_camera(frame.inputs.camera, picture.x, picture.y, 1,
                              frame.inputs.exaggeration);
}

/// A cube around the eye, with the frame's levels of detail.
LodView view_around(const PassContext& frame, double range_m) {
    LodView view{.eye_m = frame.inputs.camera.eye_m,
                 .tolerance = frame.tiles.tolerance(),
                 .exaggeration = frame.inputs.exaggeration};
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            glm::dvec3 inwards(0);
            inwards[axis] = sign;
            view.planes.emplace_back(inwards, range_m - dot(inwards, *view.eye_m));
        }
    return view;
}

/// The drawn ground below the eye, or the eye where there is none.
glm::dvec3 ground_below(PassContext& frame) {
    const glm::dvec4 post(frame.block.eye_post);
    const glm::dvec2 at = floor(glm::dvec2(post.x + post.z, post.y + post.w));
    const dem::Pyramid& posts = frame.terrain.pyramid();
    if (!(at.x >= 0 && at.y >= 0 && at.x < posts.columns() - 1 && at.y < posts.rows() - 1))
        return frame.inputs.camera.eye_m;
    const std::optional<Box> box = frame.terrain.box(at, at + 1.0, frame.inputs.exaggeration);
    return box ? 0.5 * (box->low + box->high) : frame.inputs.camera.eye_m;
}

}  // namespace

/// Draws with their inputs.
struct Instances::Batch {
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

Instances::Set::Set(const shader::InstanceSet& of) : set(of), mesh(of) {
    array.attributes(kPositionBinding, mesh.positions, 0, 1, kVectorComponents, false);
    array.attributes(kNormalBinding, mesh.normals, kNormalInput, 1, kVectorComponents, false);
    array.attributes(kBlockBinding, kBlockInput, kBlockVectors, kVectorComponents, true);
    array.hold(kBlockBinding);
    array.indices(mesh.indices);
}

Instances::Instances(const std::vector<shader::InstanceSet>& sets, const shader::ParamStore& values)
    : values_(values), shadows_(sets) {
    for (const shader::InstanceSet& set : sets)
        sets_.push_back(std::make_unique<Set>(set));
}

Instances::Set& Instances::find(std::string_view resource) {
    return **std::ranges::find_if(sets_,
                                  [&](const auto& each) { return each->set.resource == resource; });
}

void Instances::draw(std::string_view resource, bool sprites, PassContext& frame) {
    Set& set = find(resource);
    const InstanceView view(set.set, frame.terrain, view_of(frame), pixel_of(frame));
    const std::vector<InstanceBlock> blocks =
        instance_blocks(set.set, frame.terrain, frame.tiles, view);
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
    draw(set, batch, sprites);
}

void Instances::place_shadows(PassContext& frame) {
    shadows_.prepare(frame.terrain, frame.inputs, ground_below(frame), pixel_of(frame), values_,
                     frame.block);
}

void Instances::draw_shadows(std::string_view resource, PassContext& frame) {
    if (!shadows_.is_any_due()) return;
    const auto first =
        std::ranges::find_if(sets_, [](const auto& each) { return each->set.casts_shadow; });
    Set& set = find(resource);
    if (first->get() == &set) shadows_.clear_due();
    const LodView around = view_around(frame, shadows_.range_m());
    const TileSelection tiles = frame.terrain.select(around, &frame.tiles);
    const InstanceView view(set.set, frame.terrain, around, pixel_of(frame));
    const std::vector<InstanceBlock> blocks = instance_blocks(set.set, frame.terrain, tiles, view);
    Batch batch;
    for (int map = 0; map < InstanceShadows::kMaps; ++map) {
        if (!shadows_.is_due(map)) continue;
        for (const InstanceBlock& block : blocks)
            if (shadows_.meets(map, block.box))
                batch.add(set.mesh.point, 0, block, glm::vec4(map, 0, view.cells_per_post));
    }
    draw(set, batch, /*points=*/true);
}

void Instances::draw(Set& set, const Batch& batch, bool points) {
    if (batch.draws.empty()) return;
    set.array.feed(kBlockBinding,
                   set.blocks.write(std::as_bytes(std::span(batch.inputs)), sizeof(glm::vec4)),
                   sizeof(BlockInputs));
    const auto draws =
        set.draws.write(std::as_bytes(std::span(batch.draws)), sizeof(std::uint32_t));
    points ? set.array.draw_points(draws) : set.array.draw(draws);
}

}  // namespace relevo::render
