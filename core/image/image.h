#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

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

/// Text that travels inside a picture, by keyword.
using Metadata = std::map<std::string, std::string>;

/// Formats by the ending of the file's name: png, jpg, jpeg, webp, tif, tiff hold an Image8, exr an
/// ImageF.
bool is_picture_name(const std::filesystem::path& path);
bool holds_linear_light(const std::filesystem::path& path);

/// Says before any work is done whether `path` can be written.
/// @throws Error (BadInput) if its ending is no picture's, its folder does not exist or cannot be
///         written to, or it exists and `overwrite` is false
void check_output(const std::filesystem::path& path, bool overwrite);

/// Writes a picture. The file appears under its name only when it is whole; an existing one is
/// replaced only with `overwrite`. An ImageF goes to EXR, an Image8 to the other formats.
/// @throws Error as check_output, and (Failed) where the disk or the format refuses
void write(const std::filesystem::path& path, const Image8& image, const Metadata& metadata = {},
           bool overwrite = false);
void write(const std::filesystem::path& path, const ImageF& image, const Metadata& metadata = {},
           bool overwrite = false);

/// Reads a picture of any of those formats as 8-bit sRGB values.
/// @throws Error (BadInput) if it is missing, broken or no regular file, or too large to be read
Image8 read(const std::filesystem::path& path);

/// Reads a picture as the values in the file, an 8-bit one scaled to 0..1.
ImageF read_float(const std::filesystem::path& path);

/// The text inside a PNG.
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
