#include "render/texture_pool.h"

#include <algorithm>

namespace relevo::render {

void TexturePool::Return::operator()(gl::Texture* texture) const {
    pool->give(texture);
}

TexturePool::Lease TexturePool::take(gl::TextureKind kind, gl::Format format, gl::Extent extent,
                                     std::string_view label) {
    const auto found = std::ranges::find_if(free_, [&](const auto& texture) {
        return texture->kind() == kind && texture->format() == format &&
               texture->extent() == extent;
    });
    if (found == free_.end())
        return Lease(new gl::Texture(kind, format, extent, 1, label), Return{this});
    Lease texture(found->release(), Return{this});
    free_.erase(found);
    texture->set_label(label);
    return texture;
}

void TexturePool::give(gl::Texture* texture) {
    free_.emplace_back(texture);
}

}  // namespace relevo::render
