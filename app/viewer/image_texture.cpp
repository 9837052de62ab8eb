#include "viewer/image_texture.h"

#include <cstdint>
#include <span>
#include <vector>

namespace relevo::viewer {

gl::Texture texture_of(const image::Image8& picture) {
    std::vector<std::uint8_t> rgba;
    rgba.reserve(picture.values.size() / static_cast<std::size_t>(picture.channels) * 4);
    for (std::size_t i = 0; i < picture.values.size();
         i += static_cast<std::size_t>(picture.channels)) {
        for (std::size_t c = 0; c < 3; ++c)
            rgba.push_back(picture.values[i + c]);
        rgba.push_back(picture.channels == 4 ? picture.values[i + 3] : 255);
    }
    const gl::Extent extent{picture.width, picture.height, 1};
    gl::Texture texture(gl::TextureKind::D2, gl::Format::RGBA8, extent, 1, "panel's picture");
    texture.write(0, {0, 0, 0}, extent, std::as_bytes(std::span(rgba)));
    return texture;
}

}  // namespace relevo::viewer
