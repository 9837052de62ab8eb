#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "base/pixel_format.h"
#include "gl/handle.h"

namespace relevo::gl {

using Format = PixelFormat;

enum class TextureKind { D2, D2Array, D3 };
/// What GLSL calls samplers of such textures, without letters before or after: "sampler2DArray".
std::string_view sampler_name(TextureKind kind);
enum class Wrap { Clamp, Repeat };
enum class Filter { Nearest, Linear, Mipmap };

/// Width, height, and layers or depth [px].
struct Extent {
    int width = 1, height = 1, depth = 1;
    bool operator==(const Extent&) const = default;
};

/// Rows [row, row + rows) of one layer.
struct TexelBand {
    int layer = 0, row = 0, rows = 0;
};

/// A level cut into pieces of whole rows, layer after layer, of at most so many bytes or one row.
std::vector<TexelBand> bands_of(Extent extent, std::size_t row_bytes, std::size_t most_bytes);

/// An immutable-size texture.
class Texture {
  public:
    Texture() = default;
    /// @param levels  of the mip chain; 0 for the whole chain
    /// @throws Error (Failed) where the device has no memory for it, or takes none as large
    Texture(TextureKind kind, Format format, Extent extent, int levels, std::string_view label);

    /// Replaces a box of one level. Texels are tightly packed, rows in the order of t.
    void write(int level, Extent offset, Extent extent, std::span<const std::byte> texels);
    /// One whole level; waits for the device.
    void read(int level, std::span<std::byte> texels) const;
    /// Level 0 of a colour texture of floats or halves, as four floats a texel.
    void read_floats(std::span<float> texels) const;

    void set_sampling(Filter filter, Wrap wrap, double anisotropy = 1);
    /// Copies level 0 of a texture of the same format and size.
    void copy_from(const Texture& other);
    void make_mipmaps();
    /// Sets every byte of level 0. 0xff is NaN in formats of floats.
    void fill(std::byte value);
    void bind(unsigned unit) const;
    /// One level, with all its layers, for compute programs to read and write.
    /// @param as  a format of texels of the same size, by which the program has them
    void bind_image(unsigned unit, int level, Format as) const;
    /// Names it in debuggers and messages of the driver.
    void set_label(std::string_view label);

    TextureKind kind() const { return kind_; }
    Format format() const { return format_; }
    Extent extent() const { return extent_; }
    int levels() const { return levels_; }
    Extent level_extent(int level) const;
    unsigned name() const { return handle_.name(); }

  private:
    void read_as(int level, unsigned format, unsigned type, std::size_t bytes_a_texel,
                 std::span<std::byte> texels) const;

    static void destroy(unsigned name);
    Handle<&Texture::destroy> handle_;
    TextureKind kind_ = TextureKind::D2;
    Format format_ = Format::RGBA8;
    Extent extent_;
    int levels_ = 1;
};

}  // namespace relevo::gl
