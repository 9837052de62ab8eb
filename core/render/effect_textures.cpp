#include "render/effect_textures.h"

namespace relevo::render {
namespace {

gl::TextureKind kind_of(effect::TextureSpec::Kind kind) {
    switch (kind) {
        case effect::TextureSpec::Kind::D2:
        case effect::TextureSpec::Kind::Table:
            return gl::TextureKind::D2;
        case effect::TextureSpec::Kind::D2Array:
            return gl::TextureKind::D2Array;
        case effect::TextureSpec::Kind::D3:
        case effect::TextureSpec::Kind::Cube:
            return gl::TextureKind::D3;
    }
    return gl::TextureKind::D2;
}

gl::Texture make(const effect::LoadedTexture& from, double anisotropy) {
    const effect::TextureSpec& spec = from.spec;
    const bool array = spec.kind == effect::TextureSpec::Kind::D2Array;
    const image::TextureData& first = from.layers.front();
    const bool ready = from.has_mipmaps();
    const int levels = !spec.mipmaps ? 1 : ready ? first.levels() : 0;
    const int layers = static_cast<int>(from.layers.size());
    gl::Texture texture(kind_of(spec.kind), first.format(),
                        gl::Extent{first.width(), first.height(), array ? layers : first.depth()},
                        levels, spec.resource);
    for (int layer = 0; layer < layers; ++layer) {
        const image::TextureData& data = from.layers[static_cast<std::size_t>(layer)];
        for (int level = 0; level < (levels == 0 ? 1 : levels); ++level)
            texture.write(level, {0, 0, array ? layer : 0},
                          {data.level_width(level), data.level_height(level),
                           array ? 1 : data.level_depth(level)},
                          data.level(level));
    }
    if (spec.mipmaps && !ready) texture.make_mipmaps();
    texture.set_sampling(
        spec.mipmaps ? gl::Filter::Mipmap : gl::Filter::Linear,
        spec.wrap == effect::TextureSpec::Wrap::Repeat ? gl::Wrap::Repeat : gl::Wrap::Clamp,
        first.depth() > 1 ? 1 : anisotropy);
    return texture;
}

}  // namespace

std::shared_ptr<const gl::Texture> EffectTextureCache::find_or_make(
    const effect::LoadedTexture& from, double anisotropy) {
    std::erase_if(known_, [](const Known& known) { return known.texture.expired(); });
    for (const Known& known : known_)
        if (known.spec.same_texels(from.spec) && known.files == from.stamps && from.stamps.hold())
            return known.texture.lock();
    auto texture = std::make_shared<const gl::Texture>(make(from, anisotropy));
    known_.push_back({from.spec, from.stamps, texture});
    return texture;
}

EffectTextures::EffectTextures(const std::vector<const effect::LoadedTexture*>& textures,
                               double anisotropy, EffectTextureCache& cache) {
    for (const effect::LoadedTexture* texture : textures)
        textures_.emplace(texture->spec.resource, cache.find_or_make(*texture, anisotropy));
}

const gl::Texture* EffectTextures::find(const std::string& resource) const {
    const auto found = textures_.find(resource);
    return found == textures_.end() ? nullptr : found->second.get();
}

}  // namespace relevo::render
