#include "gl/texture.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "gl/errors.h"

namespace relevo::gl {

std::string_view sampler_name(TextureKind kind) {
    switch (kind) {
        case TextureKind::D2:
            return "sampler2D";
        case TextureKind::D2Array:
            return "sampler2DArray";
        case TextureKind::D3:
            return "sampler3D";
    }
    return "";
}

namespace {

/// Of one call that reads texels: GL counts them in 31 bits, and drivers in fewer.
constexpr std::size_t kMaxReadBytes = std::size_t{1} << 28;

/// GL's name of a format's storage.
GLenum storage(Format format) {
    switch (format) {
        case Format::R8:
            return GL_R8;
        case Format::RG8:
            return GL_RG8;
        case Format::RGBA8:
            return GL_RGBA8;
        case Format::Srgb8A8:
            return GL_SRGB8_ALPHA8;
        case Format::R16:
            return GL_R16;
        case Format::RGBA16:
            return GL_RGBA16;
        case Format::RG16Snorm:
            return GL_RG16_SNORM;
        case Format::RG16UI:
            return GL_RG16UI;
        case Format::R16F:
            return GL_R16F;
        case Format::RG16F:
            return GL_RG16F;
        case Format::RGBA16F:
            return GL_RGBA16F;
        case Format::R32F:
            return GL_R32F;
        case Format::RG32F:
            return GL_RG32F;
        case Format::RGBA32F:
            return GL_RGBA32F;
        case Format::R32UI:
            return GL_R32UI;
        case Format::RGBA32UI:
            return GL_RGBA32UI;
        case Format::Depth32F:
            return GL_DEPTH_COMPONENT32F;
        case Format::Stencil8:
            return GL_STENCIL_INDEX8;
    }
    return GL_NONE;
}

/// Which channels the host hands over or gets.
GLenum channels(Format format) {
    if (format == Format::Depth32F) return GL_DEPTH_COMPONENT;
    if (format == Format::Stencil8) return GL_STENCIL_INDEX;
    const bool whole = layout_of(format).kind == ChannelKind::Whole;
    switch (layout_of(format).channels) {
        case 1:
            return whole ? GL_RED_INTEGER : GL_RED;
        case 2:
            return whole ? GL_RG_INTEGER : GL_RG;
        default:
            return whole ? GL_RGBA_INTEGER : GL_RGBA;
    }
}

/// And each of them as what.
GLenum number_type(Format format) {
    const PixelLayout& layout = layout_of(format);
    if (layout.kind == ChannelKind::Float)
        return layout.channel_bytes == 2 ? GL_HALF_FLOAT : GL_FLOAT;
    if (layout.kind == ChannelKind::Snorm) return layout.channel_bytes == 1 ? GL_BYTE : GL_SHORT;
    return layout.channel_bytes == 1   ? GL_UNSIGNED_BYTE
           : layout.channel_bytes == 2 ? GL_UNSIGNED_SHORT
                                       : GL_UNSIGNED_INT;
}

GLenum target(TextureKind kind) {
    switch (kind) {
        case TextureKind::D2:
            return GL_TEXTURE_2D;
        case TextureKind::D2Array:
            return GL_TEXTURE_2D_ARRAY;
        case TextureKind::D3:
            return GL_TEXTURE_3D;
    }
    return GL_TEXTURE_2D;
}

std::string size_text(Extent extent) {
    return fmt::format("{} x {} x {} texels", extent.width, extent.height, extent.depth);
}

int limit(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

/// The largest texture that the device takes, for messages.
std::string largest(TextureKind kind) {
    if (kind == TextureKind::D3) {
        const int side = limit(GL_MAX_3D_TEXTURE_SIZE);
        return fmt::format("{0} x {0} x {0} texels", side);
    }
    const int side = limit(GL_MAX_TEXTURE_SIZE);
    return kind == TextureKind::D2 ? fmt::format("{0} x {0} texels", side)
                                   : fmt::format("{0} x {0} texels in {1} layers", side,
                                                 limit(GL_MAX_ARRAY_TEXTURE_LAYERS));
}

/// Whether the device could never hold so much. NVIDIA's driver reserves the memory of a texture
/// when it is first used, which is too late to refuse it.
bool exceeds_memory(double mib) {
    constexpr double kNeverTooMuch_mib = 256;
    if (mib < kNeverTooMuch_mib || !epoxy_has_gl_extension("GL_NVX_gpu_memory_info")) return false;
    return mib > limit(GL_GPU_MEMORY_INFO_TOTAL_AVAILABLE_MEMORY_NVX) / 1024.0;  // of KiB
}

/// GL refuses storage in silence, and the first to notice would be a framebuffer, or nobody.
void check_storage(TextureKind kind, Format format, Extent extent, int levels,
                   std::string_view label) {
    const GLenum error = glGetError();
    const double mib = double{1.0 / (1 << 20)} * layout_of(format).bytes() * extent.width *
                       extent.height * extent.depth;
    if (error == GL_NO_ERROR && !exceeds_memory(mib)) return;
    if (error != GL_NO_ERROR && error != GL_OUT_OF_MEMORY)
        failed(
            fmt::format("texture: {}: expected a texture of up to {} and a whole chain of "
                        "levels but got {} in {} levels ({})",
                        label, largest(kind), size_text(extent), levels, error_name(error)));
    failed(
        fmt::format("texture: {}: the device has no {:.0f} MiB for {}; "
                    "take a smaller picture or a device with more",
                    label, mib, size_text(extent)));
}

unsigned create(TextureKind kind, std::string_view label) {
    GLuint name = 0;
    glCreateTextures(target(kind), 1, &name);
    set_label(GL_TEXTURE, name, label);
    return name;
}

int full_chain(TextureKind kind, Extent extent) {
    int longest = std::max(extent.width, extent.height);
    if (kind == TextureKind::D3) longest = std::max(longest, extent.depth);
    return std::bit_width(static_cast<unsigned>(longest));
}

}  // namespace

void Texture::destroy(unsigned name) {
    glDeleteTextures(1, &name);
}

Texture::Texture(TextureKind kind, Format format, Extent extent, int levels, std::string_view label)
    : handle_(create(kind, label)),
      kind_(kind),
      format_(format),
      extent_(extent),
      levels_(levels > 0 ? levels : full_chain(kind, extent)) {
    // GL would leave a texture without storage, and say so only to a debug context.
    if (levels_ > full_chain(kind, extent))
        failed(fmt::format(
            "texture: {}: expected at most {} levels of {} x {} x {} texels but "
            "got {}",
            label, full_chain(kind, extent), extent.width, extent.height, extent.depth, levels_));
    expect_no_error(label);
    if (kind == TextureKind::D2Array || kind == TextureKind::D3)
        glTextureStorage3D(name(), levels_, storage(format), extent.width, extent.height,
                           extent.depth);
    else
        glTextureStorage2D(name(), levels_, storage(format), extent.width, extent.height);
    check_storage(kind, format, extent, levels_, label);
}

void Texture::set_label(std::string_view label) {
    gl::set_label(GL_TEXTURE, name(), label);
}

void Texture::write(int level, Extent offset, Extent extent, std::span<const std::byte> texels) {
    assert(texels.size() == static_cast<std::size_t>(layout_of(format_).bytes()) *
                                static_cast<std::size_t>(extent.width) *
                                static_cast<std::size_t>(extent.height) *
                                static_cast<std::size_t>(extent.depth));
    if (kind_ == TextureKind::D2)
        glTextureSubImage2D(name(), level, offset.width, offset.height, extent.width, extent.height,
                            channels(format_), number_type(format_), texels.data());
    else
        glTextureSubImage3D(name(), level, offset.width, offset.height, offset.depth, extent.width,
                            extent.height, extent.depth, channels(format_), number_type(format_),
                            texels.data());
}

std::vector<TexelBand> bands_of(Extent extent, std::size_t row_bytes, std::size_t most_bytes) {
    const std::size_t rows =
        std::max<std::size_t>(1, most_bytes / std::max<std::size_t>(1, row_bytes));
    const int rows_a_band = static_cast<int>(std::min<std::size_t>(rows, 1 << 30));
    std::vector<TexelBand> bands;
    for (int layer = 0; layer < extent.depth; ++layer)
        for (int row = 0; row < extent.height; row += rows_a_band)
            bands.push_back({layer, row, std::min(rows_a_band, extent.height - row)});
    return bands;
}

Extent Texture::level_extent(int level) const {
    const auto half = [&](int size) { return std::max(1, size >> level); };
    return {half(extent_.width), half(extent_.height),
            kind_ == TextureKind::D3 ? half(extent_.depth) : extent_.depth};
}

void Texture::read_as(int level, unsigned format, unsigned type, std::size_t bytes_a_texel,
                      std::span<std::byte> texels) const {
    const Extent extent = level_extent(level);
    const std::size_t row_bytes = bytes_a_texel * static_cast<std::size_t>(extent.width);
    std::byte* to = texels.data();
    assert(texels.size() >= row_bytes * static_cast<std::size_t>(extent.height) *
                                static_cast<std::size_t>(extent.depth));
    for (const TexelBand& band : bands_of(extent, row_bytes, kMaxReadBytes)) {
        const std::size_t bytes = row_bytes * static_cast<std::size_t>(band.rows);
        glGetTextureSubImage(name(), level, 0, band.row, band.layer, extent.width, band.rows, 1,
                             format, type, static_cast<GLsizei>(bytes), to);
        to += bytes;
    }
}

void Texture::read(int level, std::span<std::byte> texels) const {
    read_as(level, channels(format_), number_type(format_),
            static_cast<std::size_t>(layout_of(format_).bytes()), texels);
}

void Texture::read_floats(std::span<float> texels) const {
    read_as(0, GL_RGBA, GL_FLOAT, 4 * sizeof(float), std::as_writable_bytes(texels));
}

void Texture::set_sampling(Filter filter, Wrap wrap, double anisotropy) {
    const GLint mode = wrap == Wrap::Repeat ? GL_REPEAT : GL_CLAMP_TO_EDGE;
    glTextureParameteri(name(), GL_TEXTURE_WRAP_S, mode);
    glTextureParameteri(name(), GL_TEXTURE_WRAP_T, mode);
    glTextureParameteri(name(), GL_TEXTURE_WRAP_R, mode);
    glTextureParameteri(name(), GL_TEXTURE_MAG_FILTER,
                        filter == Filter::Nearest ? GL_NEAREST : GL_LINEAR);
    glTextureParameteri(name(), GL_TEXTURE_MIN_FILTER,
                        filter == Filter::Nearest  ? GL_NEAREST
                        : filter == Filter::Linear ? GL_LINEAR
                                                   : GL_LINEAR_MIPMAP_LINEAR);
    if (anisotropy > 1)
        glTextureParameterf(name(), GL_TEXTURE_MAX_ANISOTROPY, static_cast<GLfloat>(anisotropy));
}

void Texture::copy_from(const Texture& other) {
    assert(other.format_ == format_ && other.extent_.width == extent_.width);
    glCopyImageSubData(other.name(), target(other.kind_), 0, 0, 0, 0, name(), target(kind_), 0, 0,
                       0, 0, extent_.width, extent_.height, extent_.depth);
}

void Texture::make_mipmaps() {
    glGenerateTextureMipmap(name());
}

void Texture::fill(std::byte value) {
    const std::vector<std::byte> texel(static_cast<std::size_t>(layout_of(format_).bytes()), value);
    glClearTexImage(name(), 0, channels(format_), number_type(format_), texel.data());
}

void Texture::bind(unsigned unit) const {
    glBindTextureUnit(unit, name());
}

void Texture::bind_image(unsigned unit, int level, Format as) const {
    const GLboolean all_layers = kind_ == TextureKind::D2 ? GL_FALSE : GL_TRUE;
    glBindImageTexture(unit, name(), level, all_layers, 0, GL_READ_WRITE, storage(as));
}

}  // namespace relevo::gl
