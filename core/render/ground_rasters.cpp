#include "render/ground_rasters.h"

#include <algorithm>

namespace relevo::render {

void GroundRasters::set(NamedRasters rasters, const dem::Pyramid& pyramid, double spacing_m,
                        int slots) {
    std::erase_if(pages_, [&](const auto& entry) {
        const auto wanted = rasters.find(entry.first);
        return wanted == rasters.end() || wanted->second.get() != &entry.second->raster();
    });
    for (const auto& [name, raster] : rasters) {
        if (raster && !pages_.contains(name))
            pages_.emplace(name,
                           std::make_unique<OverlayPages>(raster, pyramid, spacing_m, slots, name));
        if (!raster && no_pages_.name() == 0) {
            no_pages_ =
                gl::Texture(gl::TextureKind::D2Array, gl::Format::RGBA8, {1, 1, 1}, 1, "no raster");
            no_table_ =
                gl::Texture(gl::TextureKind::D2, gl::Format::RG16UI, {1, 1, 1}, 1, "no raster");
            no_table_.set_sampling(gl::Filter::Nearest, gl::Wrap::Clamp);
        }
    }
    rasters_ = std::move(rasters);
}

bool GroundRasters::prepare(TileTree& tree, const LodView& view, Loading loading,
                            bool deterministic) {
    bool complete = true;
    for (const auto& [name, pages] : pages_)
        complete = pages->prepare(tree, view, loading, deterministic) && complete;
    return complete;
}

bool GroundRasters::is_making() const {
    return std::ranges::any_of(pages_, [](const auto& entry) { return entry.second->is_making(); });
}

const gl::Texture* GroundRasters::texture(std::string_view name) const {
    for (const auto& [raster, pages] : pages_)
        if (const gl::Texture* const found = pages->texture(name)) return found;
    for (const auto& [raster, given] : rasters_) {
        if (given || !name.starts_with(raster)) continue;
        if (name.substr(raster.size()) == "_pages") return &no_pages_;
        if (name.substr(raster.size()) == "_table") return &no_table_;
    }
    return nullptr;
}

RasterPlace GroundRasters::place(const std::string& name) const {
    const auto found = pages_.find(name);
    if (found == pages_.end()) return {};
    const OverlayTexels& texels = found->second->texels();
    return {glm::vec4(texels.first_post, texels.per_post),
            {texels.count.x - 1, texels.count.y - 1, texels.levels,
             found->second->raster().lit ? 1 : 0}};
}

}  // namespace relevo::render
