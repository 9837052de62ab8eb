#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/pixel_format.h"

/// Textures with their mip chains in KTX 2 files, the container that the ground materials come in.
///
/// Chosen because a level is used as it lies in the file: nothing is decoded, the file is mapped,
/// and the bytes go from the page cache to the driver. Source: Khronos, KTX File Format
/// Specification 2.0, https://registry.khronos.org/KTX/specs/2.0/ktxspec.v2.html
namespace relevo::image {

/// Levels of a full mip chain down to 1 x 1 x 1: floor(log2(greatest side)) + 1.
int full_chain_levels(int width, int height, int depth = 1);

/// A texture in memory, or mapped from a file: levels of rows of texels, tightly packed.
///
/// Level l is max(1, side >> l) on each side and holds, from slowest to fastest: layer, slice, row,
/// texel. The first row is t = 0 and the first texel s = 0, as OpenGL and Vulkan read them.
class TextureData {
  public:
    TextureData() = default;
    /// A zeroed texture that can be written to.
    /// @param depth   slices of a volume; 1 is a flat texture
    /// @param layers  elements of a texture array; 1 is no array
    /// @param levels  1 to full_chain_levels()
    TextureData(PixelFormat format, int width, int height, int depth, int layers, int levels);

    PixelFormat format() const { return format_; }
    int width() const { return width_; }    ///< texels of level 0
    int height() const { return height_; }  ///< rows of level 0
    int depth() const { return depth_; }    ///< slices of level 0
    int layers() const { return layers_; }
    int levels() const { return levels_; }

    int level_width(int level) const;
    int level_height(int level) const;
    int level_depth(int level) const;

    /// The bytes of one level, all layers.
    std::span<const std::byte> level(int level) const;
    /// The same, to write to; only of a texture that was not read from a file.
    std::span<std::byte> writable_level(int level);

    /// Key/value pairs of the file, values as text without their closing NUL.
    /// `KTXorientation` "ru" says that s goes right and t up (the first row is the bottom one).
    std::map<std::string, std::string> metadata;

  private:
    friend TextureData read_ktx(const std::filesystem::path& path);

    struct Unmap {
        std::size_t size;
        void operator()(const std::byte* bytes) const;
    };

    PixelFormat format_ = PixelFormat::R8;
    int width_ = 0;
    int height_ = 0;
    int depth_ = 0;
    int layers_ = 0;
    int levels_ = 0;
    std::vector<std::size_t> offsets_;  ///< of each level in owned_ or mapped_
    std::vector<std::byte> owned_;
    std::unique_ptr<const std::byte, Unmap> mapped_;
};

/// Maps a KTX 2 file: no supercompression, one face, one of its formats (R8, RG8, RGBA8,
/// Srgb8A8, R16, RGBA16F), 1 to 32768 texels a side, 1
/// to 2048 layers, every level stored. Everything that is used later is checked here, and nothing
/// of the texels is touched, so the time does not depend on the size (tests/image/test_ktx.cpp).
///
/// The texture is the file: it must not be shortened while it is in use. write_ktx() never does
/// that, it replaces the file as a whole.
/// @throws Error (BadInput) `texture: path: what; remedy` for a file that is not so
TextureData read_ktx(const std::filesystem::path& path);

/// Writes a KTX 2 file that appears under its name only when whole.
/// Key/value pairs are stored as given; `KTXwriter` is added where it is absent.
/// @throws Error `texture: path: what` as OutputFile
void write_ktx(const std::filesystem::path& path, const TextureData& texture);

}  // namespace relevo::image
