#include "viewer/picture.h"

#include "render/readback.h"

namespace relevo::viewer {

float Picture::depth_m(int x, int y) const {
    if (!shared) return depths_m[index(x, y)];
    const auto found = fetched_m_.find(index(x, y));
    if (found != fetched_m_.end()) return found->second;
    const glm::ivec2 pixel(x, y);
    fetch_depths({&pixel, 1});
    return fetched_m_.at(index(x, y));
}

void Picture::fetch_depths(std::span<const glm::ivec2> pixels) const {
    if (!shared) return;
    std::vector<glm::ivec2> missing;
    for (const glm::ivec2& pixel : pixels)
        if (!fetched_m_.contains(index(pixel.x, pixel.y))) missing.push_back(pixel);
    if (missing.empty()) return;
    const gl::Framebuffer depth({}, &shared->depth, "depth of a shared frame");
    const std::vector<float> depths = depth.read_depths(missing);
    for (std::size_t i = 0; i < missing.size(); ++i)
        fetched_m_[index(missing[i].x, missing[i].y)] = render::distance_m(depths[i]);
}

std::vector<std::uint8_t> Picture::read_rgba() const {
    if (!shared) return rgba;
    std::vector<std::uint8_t> read(4 * index(0, height_px));
    shared->colour.read(0, std::as_writable_bytes(std::span(read)));
    return read;
}

std::vector<float> Picture::read_depths_m() const {
    return shared ? render::read_depths(shared->depth) : depths_m;
}

}  // namespace relevo::viewer
