#include "effect/texture_files.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "base/error.h"
#include "effect/table_files.h"
#include "image/image.h"

namespace relevo::effect {
namespace {

[[noreturn]] void refuse_texture(const std::filesystem::path& file, std::string_view what) {
    bad_input(fmt::format("{}: {}: {}", kPluginWho, file.string(), what));
}

PixelFormat format_of(const image::Image8& picture, bool srgb) {
    if (picture.channels == 1) return PixelFormat::R8;
    if (picture.channels == 2) return PixelFormat::RG8;
    return srgb ? PixelFormat::Srgb8A8 : PixelFormat::RGBA8;
}

image::TextureData decode(const std::filesystem::path& file, const TextureSpec& spec) {
    const image::Image8 picture = image::read(file);
    if (picture.height % spec.slices != 0)
        refuse_texture(file,
                       fmt::format("{} rows do not make {} slices", picture.height, spec.slices));
    const int rows = picture.height / spec.slices;
    image::TextureData data(format_of(picture, spec.srgb), picture.width, rows, spec.slices, 1, 1);
    std::span<std::byte> texels = data.writable_level(0);
    const int wide = picture.channels == 3 ? 4 : picture.channels;
    std::size_t at = 0;
    for (int slice = 0; slice < spec.slices; ++slice) {
        // Rows go up in a texture and down in an image file.
        for (int y = rows - 1; y >= 0; --y) {
            const std::uint8_t* from = picture.row(slice * rows + y);
            for (int x = 0; x < picture.width; ++x, from += picture.channels) {
                for (int c = 0; c < wide; ++c)
                    texels[at++] = std::byte{c < picture.channels ? from[c] : std::uint8_t{255}};
            }
        }
    }
    return data;
}

/// "2d, 64 x 32 texels", "3d, 64 x 32 x 16 texels", "2d-array, 64 x 32 texels, 4 layers"
std::string shape_of(const image::TextureData& data) {
    if (data.depth() > 1)
        return fmt::format("3d, {} x {} x {} texels", data.width(), data.height(), data.depth());
    if (data.layers() > 1)
        return fmt::format("2d-array, {} x {} texels, {} layers", data.width(), data.height(),
                           data.layers());
    return fmt::format("2d, {} x {} texels", data.width(), data.height());
}

void check_kind(const std::filesystem::path& file, const TextureSpec& spec,
                const image::TextureData& data) {
    const bool volume = spec.kind == TextureSpec::Kind::D3;
    if (data.layers() > 1 || (data.depth() > 1 && !volume))
        refuse_texture(file, fmt::format("expected a file of kind {} for textures.{} but got {}",
                                         volume ? "3d" : "2d", spec.name, shape_of(data)));
    if (spec.slices > 1 && data.depth() != spec.slices)
        refuse_texture(file, fmt::format("expected {} slices, as the manifest says, but got {}",
                                         spec.slices, data.depth()));
    const bool colours = data.format() == PixelFormat::Srgb8A8;
    const bool numbers = data.format() == PixelFormat::RGBA8;
    if (spec.srgb ? numbers : colours)
        refuse_texture(
            file,
            fmt::format("expected texels of encoding {} for textures.{} but got {}",
                        spec.srgb ? "srgb" : "linear", spec.name, spec.srgb ? "linear" : "srgb"));
}

void check_alike(const TextureSpec& spec, const std::vector<image::TextureData>& layers) {
    const image::TextureData& first = layers.front();
    for (std::size_t i = 1; i < layers.size(); ++i) {
        const image::TextureData& layer = layers[i];
        const bool same = layer.width() == first.width() && layer.height() == first.height() &&
                          layer.format() == first.format() &&
                          (!spec.mipmaps || layer.levels() == first.levels());
        if (same) continue;
        const auto texels = [](const image::TextureData& data) {
            return fmt::format("{} x {} texels of {} bytes in {} levels", data.width(),
                               data.height(), layout_of(data.format()).bytes(), data.levels());
        };
        refuse_texture(spec.files[i], fmt::format("expected {} as in {} but got {}", texels(first),
                                                  spec.files.front().string(), texels(layer)));
    }
}

}  // namespace

LoadedTexture load_texture(const TextureSpec& spec) {
    LoadedTexture texture{.spec = spec};
    if (spec.kind == TextureSpec::Kind::Table || spec.kind == TextureSpec::Kind::Cube) {
        const std::filesystem::path file = spec.files.empty() ? "" : spec.files.front();
        texture.layers.push_back(spec.kind == TextureSpec::Kind::Table ? read_table(file)
                                                                       : read_cube(file));
        if (!file.empty()) texture.stamps.add(file);
        return texture;
    }
    for (const std::filesystem::path& file : spec.files) {
        texture.layers.push_back(file.extension() == ".ktx2" ? image::read_ktx(file)
                                                             : decode(file, spec));
        check_kind(file, spec, texture.layers.back());
        texture.stamps.add(file);
    }
    check_alike(spec, texture.layers);
    return texture;
}

void check_limits(const LoadedTexture& texture, const TextureLimits& limits) {
    const image::TextureData& first = texture.layers.front();
    const bool volume = first.depth() > 1;
    const int most_px = volume ? limits.volume_side_px : limits.side_px;
    const int longest_px = std::max({first.width(), first.height(), first.depth()});
    if (texture.spec.files.empty()) return;
    const std::filesystem::path& file = texture.spec.files.front();
    if (longest_px > most_px)
        refuse_texture(
            file, fmt::format("expected at most {} texels a side, as this device takes, but got "
                              "{}",
                              most_px, shape_of(first)));
    if (texture.spec.kind == TextureSpec::Kind::D2Array &&
        texture.layers.size() > static_cast<std::size_t>(limits.layers))
        refuse_texture(file,
                       fmt::format("expected at most {} layers, as this device takes, but got {}",
                                   limits.layers, texture.layers.size()));
}

}  // namespace relevo::effect
