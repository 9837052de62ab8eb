#include "render/graph/graph.h"

#include <algorithm>
#include <cmath>

namespace relevo::render {

std::array<int, 2> ResourceSize::sides_px(int frame_width_px, int frame_height_px) const {
    if (share <= 0) return {width, height};
    const auto side = [&](int whole) {
        return std::max(1, static_cast<int>(std::ceil(share * whole)));
    };
    return {side(frame_width_px), side(frame_height_px)};
}

std::array<int, 3> Dispatch::groups(int frame_width_px, int frame_height_px) const {
    if (work_groups[0] > 0) return work_groups;
    const auto [width, height] = over.sides_px(frame_width_px, frame_height_px);
    const std::array<int, 3> sides{width, height, over.depth};
    std::array<int, 3> result{};
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = (sides[i] + local_size[i] - 1) / local_size[i];
    return result;
}

const Resource* FrameGraph::find(std::string_view resource) const {
    const auto found = std::ranges::find(resources, resource, &Resource::name);
    return found == resources.end() ? nullptr : &*found;
}

Version Version::of(std::string_view text) {
    const std::size_t at = text.find('@');
    if (at == std::string_view::npos) return {std::string(text), ""};
    return {std::string(text.substr(0, at)), std::string(text.substr(at + 1))};
}

std::vector<Access> accesses(const Pass& pass) {
    using Mode = Access::Mode;
    std::vector<Access> all;
    const auto add = [&](Mode mode, const std::string& name) {
        const Access access{mode, Version::of(name)};
        if (std::ranges::find(all, access) == all.end()) all.push_back(access);
    };
    for (const Colour& colour : pass.colours)
        add(colour.updates ? Mode::Update : Mode::Write, colour.resource);
    if (const auto& depth = pass.depth)
        add(!depth->writes ? Mode::Read
            : depth->clear ? Mode::Write
                           : Mode::Update,
            depth->resource);
    if (const auto& stencil = pass.stencil)
        add(stencil->marks ? Mode::Write : Mode::Read, stencil->resource);
    for (const std::string& name : pass.writes)
        add(Mode::Write, name);
    for (const std::string& name : pass.updates)
        add(Mode::Update, name);
    for (const std::string& name : pass.reads)
        add(Mode::Read, name);
    return all;
}

}  // namespace relevo::render
