#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "base/output_file.h"

namespace relevo::image {

/// Rows from the top, pixels from the left, channels interleaved: grey, grey and alpha, RGB or
/// RGBA.
template <typename T>
struct Pixels {
    int width = 0;     ///< [px]
    int height = 0;    ///< [px]
    int channels = 0;  ///< 1 to 4
    std::vector<T> values;

    Pixels() = default;
    Pixels(int w, int h, int c)
        : width(w),
          height(h),
          channels(c),
          values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) *
                 static_cast<std::size_t>(c)) {}

    T* row(int y) { return values.data() + offset(y); }
    const T* row(int y) const { return values.data() + offset(y); }
    const T& at(int x, int y, int c) const {
        return row(y)[static_cast<std::size_t>(x * channels + c)];
    }

  private:
    std::size_t offset(int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) *
               static_cast<std::size_t>(channels);
    }
};

/// sRGB-encoded, 0..255, alpha not premultiplied.
using Image8 = Pixels<std::uint8_t>;
/// Linear light, as EXR keeps it.
using ImageF = Pixels<float>;

/// A picture of a device, RGBA with rows from below, without its alpha.
Image8 from_device(int width_px, int height_px, const std::vector<std::uint8_t>& rgba);

/// Text that travels inside a picture, by keyword.
using Metadata = std::map<std::string, std::string>;

/// Formats by the ending of the file's name: png, jpg, jpeg, webp, tif, tiff hold an Image8, exr an
/// ImageF.
bool is_picture_name(const std::filesystem::path& path);
bool holds_linear_light(const std::filesystem::path& path);

/// Says before any work is done whether a picture of that size has a format.
/// @throws Error (BadInput) if the ending of `path` is no picture's, or the format has no room for
///     the size
void check_format(const std::filesystem::path& path, int width_px, int height_px);

/// Whether the format has room for these texts and `rest` more bytes: a JPEG has 64 KiB.
bool metadata_fits(const std::filesystem::path& path, const Metadata& metadata, std::size_t rest);

/// Loads what writes the format, 0.3 s for all but PNG; write() does it where it has not been done.
/// @throws Error (Failed) if it is not installed
void load_format(const std::filesystem::path& path);

/// Writes a picture to `file`, all of it but finish(). An ImageF goes to EXR, an Image8 to the
/// other formats.
/// @throws Error as check_format and load_format, and (Failed) where memory, the disk or the format
///     refuses
void write(OutputFile& file, const Image8& image, const Metadata& metadata = {});
void write(OutputFile& file, const ImageF& image, const Metadata& metadata = {});

/// The same for a path. The file appears under its name only when it is whole; an existing one is
/// replaced only with `overwrite`.
/// @throws Error as OutputFile and write
void write(const std::filesystem::path& path, const Image8& image, const Metadata& metadata = {},
           bool overwrite = false);
void write(const std::filesystem::path& path, const ImageF& image, const Metadata& metadata = {},
           bool overwrite = false);

/// Reads a picture of any of those formats as 8-bit sRGB values.
/// @throws Error (BadInput) if it is missing, broken or no regular file, or too large to be read
Image8 read(const std::filesystem::path& path);

/// Reads a picture as the values in the file, an 8-bit one scaled to 0..1.
ImageF read_float(const std::filesystem::path& path);

/// The texts inside a picture: all of a PNG and of an EXR, of the others those that write() puts
/// into XMP, whose keywords begin with `relevo:`.
/// @throws Error (BadInput) as read()
Metadata read_metadata(const std::filesystem::path& path);

/// How far two pictures are apart.
struct Difference {
    double worst = 0;         ///< largest difference of a value [1/255]
    double share_over_1 = 0;  ///< share of values that differ by more than 1/255
    double psnr_db = 0;       ///< peak signal to noise ratio; infinite where they are equal
};

/// @throws Error (BadInput) if sizes or channels differ
Difference compare(const Image8& a, const Image8& b);

}  // namespace relevo::image
