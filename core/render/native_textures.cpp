#include "render/native_textures.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace relevo::render {

void NativeTextures::create(relevo_texture name, const effect::ModuleTexture& info) {
    Made made;
    if (!info.name.empty()) made.resource = plugin_ + '.' + info.name;
    made.texture = gl::Texture(info.layers > 0 ? gl::TextureKind::D2Array : gl::TextureKind::D2,
                               info.format, {info.width, info.height, std::max(info.layers, 1)},
                               info.levels, made.resource.empty() ? plugin_ : made.resource);
    made.texture.set_sampling(info.filter == RELEVO_FILTER_NEAREST  ? gl::Filter::Nearest
                              : info.filter == RELEVO_FILTER_LINEAR ? gl::Filter::Linear
                                                                    : gl::Filter::Mipmap,
                              gl::Wrap::Clamp);
    for (auto& [other, older] : textures_)
        if (older.resource == made.resource) older.resource.clear();
    textures_.emplace(name, std::move(made));
}

const gl::Framebuffer& NativeTextures::colour_framebuffer(relevo_texture name, int level,
                                                          int layer) {
    Made& made = textures_.at(name);
    const std::pair key(level, layer);
    if (!made.framebuffers.contains(key))
        made.framebuffers.emplace(key, gl::Framebuffer(made.texture, level, layer, plugin_));
    return made.framebuffers.at(key);
}

const gl::Framebuffer& NativeTextures::depth_framebuffer(relevo_texture name) {
    Made& made = textures_.at(name);
    const std::pair key(0, 0);
    if (!made.framebuffers.contains(key))
        made.framebuffers.emplace(key, gl::Framebuffer({}, &made.texture, plugin_));
    return made.framebuffers.at(key);
}

void NativeTextures::write(const relevo_texels& texels) {
    get(texels.texture)
        .write(
            texels.level, {texels.x, texels.y, texels.layer}, {texels.width, texels.height, 1},
            {static_cast<const std::byte*>(texels.texels), static_cast<std::size_t>(texels.bytes)});
}

void NativeTextures::read(relevo_texture name, int layer, std::span<float> out) const {
    const gl::Texture& from = textures_.at(name).texture;
    std::vector<float> all(out.size() * static_cast<std::size_t>(from.extent().depth));
    from.read(0, std::as_writable_bytes(std::span(all)));
    std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(out.size()) * layer, out.size(),
                out.begin());
}

const gl::Texture* NativeTextures::find(std::string_view resource) const {
    for (const auto& [name, made] : textures_)
        if (!made.resource.empty() && made.resource == resource) return &made.texture;
    return nullptr;
}

}  // namespace relevo::render
