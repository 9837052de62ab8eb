#include "render/footprint_texture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace relevo::render {
namespace {

/// Three box blurs along each axis, which approximate a Gaussian. @param reach  in squares
Array2d<float> blurred(const Array2d<float>& sharp, int reach) {
    Array2d<float> from = sharp, to = sharp;
    for (int turn = 0; turn < 6; ++turn) {
        const bool along = turn % 2 == 0;
        for (int y = 0; y < from.height(); ++y)
            for (int x = 0; x < from.width(); ++x) {
                float sum = 0;
                for (int i = -reach; i <= reach; ++i) {
                    const int u = along ? x + i : x, v = along ? y : y + i;
                    if (u >= 0 && v >= 0 && u < from.width() && v < from.height())
                        sum += from.at(u, v);
                }
                to.at(x, y) = sum / static_cast<float>(2 * reach + 1);
            }
        std::swap(from, to);
    }
    return from;
}

}  // namespace

gl::Texture footprint_texture(const Footprint& footprint) {
    const Array2d<float> near = blurred(footprint.share, 1), far = blurred(footprint.share, 4);
    std::vector<std::uint8_t> texels;
    for (std::size_t i = 0; i < near.size(); ++i)
        for (const float share : {near.data()[i], far.data()[i]})
            texels.push_back(static_cast<std::uint8_t>(std::lround(255 * std::min(share, 1.0f))));
    const gl::Extent size{near.width(), near.height(), 1};
    gl::Texture texture(gl::TextureKind::D2, gl::Format::RG8, size, 1, "floor_ground");
    texture.set_sampling(gl::Filter::Linear, gl::Wrap::Clamp);
    texture.write(0, {0, 0, 0}, size, std::as_bytes(std::span(texels)));
    return texture;
}

}  // namespace relevo::render
