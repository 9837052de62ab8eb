#include "render/graph_targets.h"

#include <algorithm>

namespace relevo::render {
namespace {

gl::TextureKind kind_of(ResourceKind kind) {
    switch (kind) {
        case ResourceKind::Texture2DArray:
            return gl::TextureKind::D2Array;
        case ResourceKind::Texture3D:
            return gl::TextureKind::D3;
        default:
            return gl::TextureKind::D2;
    }
}

gl::Extent extent_of(const ResourceSize& size, int width_px, int height_px) {
    const auto [width, height] = size.sides_px(width_px, height_px);
    return {width, height, size.depth};
}

}  // namespace

GraphTargets::GraphTargets(const FrameGraph& graph, const Plan& plan, int width_px, int height_px,
                           TexturePool& pool)
    : textures_(plan.memory.size()), buffers_(plan.memory.size()), views_(plan.memory.size()) {
    for (std::size_t m = 0; m < plan.memory.size(); ++m) {
        std::string label;
        for (const int r : plan.memory[m].resources) {
            const std::string& name = graph.resources[static_cast<std::size_t>(r)].name;
            label += (label.empty() ? "" : ", ") + name;
            names_.push_back({name, static_cast<int>(m)});
        }
        const Resource& first =
            graph.resources[static_cast<std::size_t>(plan.memory[m].resources.front())];
        if (first.kind == ResourceKind::Buffer) {
            buffers_[m] = gl::Buffer(std::vector<std::byte>(first.size.bytes), label);
            views_[m] = gl::BufferTexture(buffers_[m], first.format, label);
            continue;
        }
        textures_[m] = pool.take(kind_of(first.kind), first.format,
                                 extent_of(first.size, width_px, height_px), label);
        // Stencils are not sampled.
        if (first.format != gl::Format::Stencil8)
            textures_[m]->set_sampling(first.linear ? gl::Filter::Linear : gl::Filter::Nearest,
                                       gl::Wrap::Clamp);
        if (first.lifetime == Lifetime::Kept) textures_[m]->fill(std::byte{0});
    }
    for (const Plan::Step& step : plan.steps)
        framebuffers_.push_back(
            make_framebuffer(graph.passes[static_cast<std::size_t>(step.pass)]));
}

gl::Framebuffer GraphTargets::make_framebuffer(const Pass& pass) {
    std::vector<const gl::Texture*> colours;
    for (const Colour& colour : pass.colours)
        colours.push_back(texture(colour.resource));
    const gl::Texture* const depth = pass.depth
                                         ? texture(Version::of(pass.depth->resource).resource)
                                     : pass.stencil ? texture(pass.stencil->resource)
                                                    : nullptr;
    if (colours.empty() && !depth) return {};
    return gl::Framebuffer(colours, depth, pass.name);
}

int GraphTargets::memory_of(std::string_view resource) const {
    const auto found = std::ranges::find(names_, resource, &Named::name);
    return found == names_.end() ? -1 : found->memory;
}

gl::Texture* GraphTargets::texture(std::string_view resource) {
    const int memory = memory_of(resource);
    return memory < 0 ? nullptr : textures_[static_cast<std::size_t>(memory)].get();
}

const gl::Buffer* GraphTargets::buffer(std::string_view resource) const {
    const int memory = memory_of(resource);
    if (memory < 0) return nullptr;
    const gl::Buffer& found = buffers_[static_cast<std::size_t>(memory)];
    return found.name() != 0 ? &found : nullptr;
}

bool GraphTargets::bind(std::string_view resource, unsigned unit) {
    const int memory = memory_of(resource);
    if (memory < 0) return false;
    const auto m = static_cast<std::size_t>(memory);
    if (const gl::Texture* const found = textures_[m].get())
        found->bind(unit);
    else
        views_[m].bind(unit);
    return true;
}

void GraphTargets::begin_output(std::string_view resource) {
    const auto m = static_cast<std::size_t>(memory_of(resource));
    if (gl::Texture* const found = textures_[m].get()) {
        found->fill(std::byte{0});
        found->bind_image(0, 0, found->format());
    } else {
        buffers_[m].fill(0);
        buffers_[m].bind_storage(0);
    }
}

const gl::Framebuffer* GraphTargets::framebuffer(std::size_t step) const {
    const gl::Framebuffer& found = framebuffers_[step];
    return found.name() != 0 ? &found : nullptr;
}

void GraphTargets::poison(const FrameGraph& graph, const Plan::Step& step) {
    for (const int r : step.begins)
        if (gl::Texture* const begun = texture(graph.resources[static_cast<std::size_t>(r)].name))
            begun->fill(std::byte{0xff});
}

}  // namespace relevo::render
