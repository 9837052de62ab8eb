#include "render/effect_textures.h"

#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "image/image.h"
#include "image/ktx.h"

namespace relevo::render {
namespace {

/// A file's texels: mapped KTX levels, or one level of a decoded picture.
struct Source {
    image::TextureData data;
    bool has_mipmaps = false;
};

Source read_source(const std::filesystem::path& path, const effect::TextureSpec& spec) {
    if (path.extension() == ".ktx2") {
        image::TextureData data = image::read_ktx(path);
        const bool mipmaps = data.levels() > 1;
        return {std::move(data), mipmaps};
    }
    const image::Image8 picture = image::read(path);
    if (picture.height % spec.slices != 0)
        bad_input(fmt::format("render: {}: {} rows do not make {} slices", path.string(),
                              picture.height, spec.slices));
    const image::TextureFormat format = picture.channels == 1   ? image::TextureFormat::R8
                                        : picture.channels == 2 ? image::TextureFormat::Rg8
                                        : spec.srgb             ? image::TextureFormat::SrgbA8
                                                                : image::TextureFormat::Rgba8;
    const int rows = picture.height / spec.slices;
    image::TextureData data(format, picture.width, rows, spec.slices, 1, 1);
    std::span<std::byte> texels = data.writable_level(0);
    const int wide = picture.channels == 3 ? 4 : picture.channels;
    std::size_t at = 0;
    for (int slice = 0; slice < spec.slices; ++slice) {
        // Rows run up in a texture and down in a picture.
        for (int y = rows - 1; y >= 0; --y) {
            const std::uint8_t* from = picture.row(slice * rows + y);
            for (int x = 0; x < picture.width; ++x, from += picture.channels) {
                for (int c = 0; c < wide; ++c)
                    texels[at++] = std::byte{c < picture.channels ? from[c] : std::uint8_t{255}};
            }
        }
    }
    return {std::move(data), false};
}

gl::Format format_of(image::TextureFormat format) {
    switch (format) {
        case image::TextureFormat::R8:
            return gl::Format::R8;
        case image::TextureFormat::Rg8:
            return gl::Format::RG8;
        case image::TextureFormat::Rgba8:
            return gl::Format::RGBA8;
        case image::TextureFormat::SrgbA8:
            return gl::Format::Srgb8A8;
        case image::TextureFormat::R16:
            return gl::Format::R16;
        case image::TextureFormat::Rgba16F:
            return gl::Format::RGBA16F;
    }
    return gl::Format::RGBA8;
}

gl::TextureKind kind_of(effect::TextureSpec::Kind kind) {
    switch (kind) {
        case effect::TextureSpec::Kind::D2:
            return gl::TextureKind::D2;
        case effect::TextureSpec::Kind::D2Array:
            return gl::TextureKind::D2Array;
        case effect::TextureSpec::Kind::D3:
            return gl::TextureKind::D3;
    }
    return gl::TextureKind::D2;
}

gl::Texture make(const effect::TextureSpec& spec, double anisotropy) {
    const bool array = spec.kind == effect::TextureSpec::Kind::D2Array;
    std::optional<gl::Texture> texture;
    const image::TextureData* first = nullptr;
    std::vector<Source> sources;
    for (const std::filesystem::path& path : spec.files)
        sources.push_back(read_source(path, spec));
    first = &sources.front().data;
    const bool ready = sources.front().has_mipmaps;
    const int levels = !spec.mipmaps ? 1 : ready ? first->levels() : 0;
    const int layers = static_cast<int>(sources.size());
    texture.emplace(kind_of(spec.kind), format_of(first->format()),
                    gl::Extent{first->width(), first->height(), array ? layers : first->depth()},
                    levels, spec.resource);
    for (int layer = 0; layer < layers; ++layer) {
        const Source& source = sources[static_cast<std::size_t>(layer)];
        const image::TextureData& data = source.data;
        if (data.width() != first->width() || data.height() != first->height() ||
            data.format() != first->format() || source.has_mipmaps != ready)
            bad_input(fmt::format(
                "render: {}: expected {} x {} texels of the same kind as in {} but got "
                "{} x {}",
                spec.files[static_cast<std::size_t>(layer)].string(), first->width(),
                first->height(), spec.files.front().string(), data.width(), data.height()));
        for (int level = 0; level < (levels == 0 ? 1 : levels); ++level)
            texture->write(level, {0, 0, array ? layer : 0},
                           {data.level_width(level), data.level_height(level),
                            array ? 1 : data.level_depth(level)},
                           data.level(level));
    }
    if (spec.mipmaps && !ready) texture->make_mipmaps();
    texture->set_sampling(
        spec.mipmaps ? gl::Filter::Mipmap : gl::Filter::Linear,
        spec.wrap == effect::TextureSpec::Wrap::Repeat ? gl::Wrap::Repeat : gl::Wrap::Clamp,
        spec.kind == effect::TextureSpec::Kind::D3 ? 1 : anisotropy);
    return std::move(*texture);
}

}  // namespace

EffectTextures::EffectTextures(const std::vector<effect::TextureSpec>& specs, double anisotropy) {
    for (const effect::TextureSpec& spec : specs)
        textures_.emplace(spec.resource, make(spec, anisotropy));
}

const gl::Texture* EffectTextures::find(const std::string& resource) const {
    const auto found = textures_.find(resource);
    return found == textures_.end() ? nullptr : &found->second;
}

}  // namespace relevo::render
