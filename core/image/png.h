#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "image/image.h"

namespace relevo::image {

/// libpng does not read a longer text back [bytes]: PNG_USER_CHUNK_MALLOC_MAX is 8,000,000.
inline constexpr std::size_t kLongestTextOfPng = 7'900'000;

/// Writes a PNG with the sRGB chunk and `metadata` as iTXt, all of it but finish().
/// @param dpi  as Picture::dpi
/// @throws Error (Failed)
void write_png(OutputFile& file, const Image8& image, const Metadata& metadata, double dpi = 0);
void write_png(OutputFile& file, const Image16& image, const Metadata& metadata, double dpi = 0);

/// Writes a PNG band by band.
class PngBands {
  public:
    /// @param bits  of a channel, 8 or 16
    PngBands(OutputFile& file, int width_px, int height_px, int channels, int bits,
             const Metadata& metadata);
    ~PngBands();
    void write(const Image8& band);
    void write(const Image16& band);
    /// After the last band: all but the file's finish().
    void end();

    template <typename T>
    static void write_whole(OutputFile& file, const Pixels<T>& image, const Metadata& metadata,
                            double dpi);

  private:
    class Writer;
    std::unique_ptr<Writer> writer_;
};

/// Reads any PNG as 8-bit values, palettes and low bit depths expanded. @throws Error (BadInput)
Image8 read_png(const std::filesystem::path& path, Metadata* metadata = nullptr);

}  // namespace relevo::image
