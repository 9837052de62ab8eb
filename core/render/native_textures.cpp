#include "render/native_textures.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "effect/texture_format.h"

namespace relevo::render {

NativeTextures::NativeTextures(std::string plugin, const gl::DeviceInfo& device)
    : plugin_(std::move(plugin)), device_(device) {}

const NativeTextures::Made& NativeTextures::at(relevo_texture name) const {
    const auto found = textures_.find(name);
    if (found == textures_.end()) failed(fmt::format("there is no texture {}", name));
    return found->second;
}

gl::Texture& NativeTextures::get(relevo_texture name) {
    return const_cast<gl::Texture&>(std::as_const(*this).get(name));
}

relevo_texture NativeTextures::create(const relevo_texture_info& info) {
    const std::optional<PixelFormat> format = effect::texture_format(info.format);
    if (!format) failed(fmt::format("{} is no format of a texture", info.format));
    const int most = device_.max_texture_size;
    if (info.width < 1 || info.height < 1 || info.width > most || info.height > most ||
        info.layers < 0 || info.layers > device_.max_array_layers)
        failed(fmt::format("expected a texture of up to {0} x {0} but got {1} x {2}, {3} layers",
                           most, info.width, info.height, info.layers));
    const int longest = std::max(info.width, info.height);
    const int full = std::bit_width(static_cast<unsigned>(longest));
    if (info.levels < 0 || info.levels > full)
        failed(fmt::format("expected 0 to {} levels of {} x {} texels but got {}", full, info.width,
                           info.height, info.levels));
    if (info.filter < RELEVO_FILTER_NEAREST || info.filter > RELEVO_FILTER_MIPMAP)
        failed(fmt::format("{} is no filter of a texture", info.filter));
    Made made;
    made.resource = info.name ? plugin_ + '.' + info.name : std::string();
    made.texture = gl::Texture(info.layers > 0 ? gl::TextureKind::D2Array : gl::TextureKind::D2,
                               *format, {info.width, info.height, std::max(info.layers, 1)},
                               info.levels, made.resource.empty() ? plugin_ : made.resource);
    made.texture.set_sampling(info.filter == RELEVO_FILTER_NEAREST  ? gl::Filter::Nearest
                              : info.filter == RELEVO_FILTER_LINEAR ? gl::Filter::Linear
                                                                    : gl::Filter::Mipmap,
                              gl::Wrap::Clamp);
    if (!made.resource.empty())
        for (auto& [other, texture] : textures_)
            if (texture.resource == made.resource) texture.resource.clear();
    textures_.emplace(++last_, std::move(made));
    return last_;
}

void NativeTextures::destroy(relevo_texture name) {
    at(name);
    textures_.erase(name);
}

void NativeTextures::write(const relevo_texels& texels) {
    gl::Texture& to = get(texels.texture);
    if (texels.level < 0 || texels.level >= to.levels() || texels.layer < 0 ||
        texels.layer >= to.extent().depth)
        failed(fmt::format("expected a level below {} and a layer below {} but got {} and {}",
                           to.levels(), to.extent().depth, texels.level, texels.layer));
    const gl::Extent level = to.level_extent(texels.level);
    if (texels.x < 0 || texels.y < 0 || texels.width < 1 || texels.height < 1 ||
        texels.x > level.width - texels.width || texels.y > level.height - texels.height)
        failed(fmt::format("expected a rectangle within {} x {} texels but got {} x {} at {}, {}",
                           level.width, level.height, texels.width, texels.height, texels.x,
                           texels.y));
    if (to.format() == gl::Format::Depth32F) failed("a texture of depth is drawn, not written");
    const std::uint64_t bytes = std::uint64_t{1} * static_cast<unsigned>(texels.width) *
                                static_cast<unsigned>(texels.height) *
                                static_cast<unsigned>(layout_of(to.format()).bytes());
    if (texels.bytes != bytes)
        failed(fmt::format("expected {} bytes for {} x {} texels but got {}", bytes, texels.width,
                           texels.height, texels.bytes));
    to.write(texels.level, {texels.x, texels.y, texels.layer}, {texels.width, texels.height, 1},
             {static_cast<const std::byte*>(texels.texels), static_cast<std::size_t>(bytes)});
}

void NativeTextures::read(relevo_texture name, int layer, std::span<float> out) const {
    const Made& from = at(name);
    const gl::Extent extent = from.texture.extent();
    const int floats = effect::readable_floats(from.texture.format());
    const std::uint64_t a_layer = std::uint64_t{1} * static_cast<unsigned>(extent.width) *
                                  static_cast<unsigned>(extent.height) *
                                  static_cast<unsigned>(floats);
    if (floats == 0) failed("only textures of 32-bit floats can be read");
    if (layer < 0 || layer >= extent.depth || out.size() < a_layer)
        failed(fmt::format("expected room for {} floats and a layer below {} but got {} and {}",
                           a_layer, extent.depth, out.size(), layer));
    std::vector<float> all(a_layer * static_cast<unsigned>(extent.depth));
    from.texture.read(0, std::as_writable_bytes(std::span(all)));
    std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(a_layer) * layer, a_layer, out.begin());
}

const gl::Texture* NativeTextures::find(std::string_view resource) const {
    for (const auto& [name, made] : textures_)
        if (!made.resource.empty() && made.resource == resource) return &made.texture;
    return nullptr;
}

}  // namespace relevo::render
