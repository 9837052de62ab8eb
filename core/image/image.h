#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
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
/// The same, 0..65535.
using Image16 = Pixels<std::uint16_t>;
/// Linear light, as EXR keeps it; alpha premultiplied.
using ImageF = Pixels<float>;

/// A channel of an EXR beside its colour, such as `depth.Z`: a value a pixel, rows from the top.
struct Channel {
    std::string name;
    bool is_whole = false;  ///< whole numbers from 0, stored as such; else 32-bit floats
    std::vector<float> values;
};

/// What a picture file holds.
struct Picture {
    std::variant<Image8, Image16, ImageF> pixels;
    std::vector<Channel> layers{};  ///< of an ImageF
    double dpi = 0;                 ///< pixels per inch on paper, which files say; 0: none
};

/// What a picture file is, as far as its name does not say it.
struct Encoding {
    std::string format{};          ///< "png", "jpg" ... of a file without a name; empty: its ending
    int bits = 8;                  ///< of a channel, 8 or 16; not of EXR, whose colour is in halves
    std::optional<int> quality{};  ///< 1 to 100, of JPEG, WebP and AVIF; none: kQuality
};
inline constexpr int kQuality = 95;

/// A picture of a device, RGBA with rows from below, without its alpha.
Image8 from_device(int width_px, int height_px, const std::vector<std::uint8_t>& rgba);

/// Text that travels inside a picture, by keyword.
using Metadata = std::map<std::string, std::string>;

/// Formats by the ending of the file's name: png, jpg, jpeg, webp, avif, tif, tiff hold an Image8,
/// png, tif and tiff also an Image16, exr an ImageF. A pdf (chart/drawing.h) holds the JPEG that
/// encoded() makes for its name.
bool is_picture_name(const std::filesystem::path& path);
bool holds_linear_light(const std::filesystem::path& path);

/// What a picture needs of its format.
struct Needs {
    int width_px = 1, height_px = 1;
    bool alpha = false;   ///< transparent pixels
    bool layers = false;  ///< Picture::layers
};

/// Says before any work is done whether the format has what is asked for: size, bits, quality,
/// alpha, layers.
/// @throws Error (BadInput) naming the formats that have it
void check_encoding(const std::filesystem::path& path, const Encoding& encoding,
                    const Needs& needs);

/// Says before any work is done whether a picture of that size has a format.
/// @throws Error (BadInput) if the ending of `path` is no picture's, or the format has no room for
///     the size
void check_format(const std::filesystem::path& path, int width_px, int height_px);

/// Whether the format has room for these texts and `rest` more bytes: a JPEG has 64 KiB.
bool metadata_fits(const std::filesystem::path& path, const Metadata& metadata, std::size_t rest);

/// Loads what writes the format, 0.3 s for all but PNG; write() does it where it has not been done.
/// @throws Error (Failed) if it is not installed
void load_format(const std::filesystem::path& path);

/// Writes a picture to `file`, all of it but finish(). An ImageF goes to EXR, whole numbers to the
/// other formats. Alpha is stored as each format wants it: straight, in EXR premultiplied.
/// @throws Error as check_encoding and load_format, and (Failed) where memory, the disk or the
/// format
///     refuses
void write(OutputFile& file, const Picture& picture, const Metadata& metadata = {},
           const Encoding& encoding = {});
void write(OutputFile& file, Image8 image, const Metadata& metadata = {});

/// The bytes that write() would write, of a format other than PNG.
/// @param path  of the file, for messages, and for the format unless `encoding` names it
std::vector<std::byte> encoded(const std::filesystem::path& path, const Picture& picture,
                               const Metadata& metadata, const Encoding& encoding);

/// The same for a path. The file appears under its name only when it is whole; an existing one is
/// replaced only with `overwrite`.
/// @throws Error as OutputFile and write
void write(const std::filesystem::path& path, const Image8& image, const Metadata& metadata = {},
           bool overwrite = false);
void write(const std::filesystem::path& path, const ImageF& image, const Metadata& metadata = {},
           bool overwrite = false);

/// Says before any work is done whether pictures that are too large for memory, in bands of rows,
/// can have a format.
/// @throws Error (BadInput) naming those that can
void check_bands(const std::filesystem::path& path);

/// Writes a picture to a file band by band, from the top.
class BandWriter {
  public:
    /// @param needs  of the whole picture
    /// @throws Error as check_encoding and check_bands
    BandWriter(OutputFile& file, const Needs& needs, const Metadata& metadata,
               const Encoding& encoding);
    ~BandWriter();
    BandWriter(const BandWriter&) = delete;
    BandWriter& operator=(const BandWriter&) = delete;

    /// Adds rows. @throws Error (Failed) where the disk refuses
    void write(const Picture& band);
    /// All but the file's finish(), after the last band.
    void end();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Reads a picture of any of those formats as 8-bit sRGB values.
/// @throws Error (BadInput) if it is missing, broken or no regular file, or too large to be read
Image8 read(const std::filesystem::path& path);

/// Reads a picture as the values in the file, those of 8 and 16 bits scaled to 0..1. Of an EXR with
/// layers its colour.
ImageF read_float(const std::filesystem::path& path);

/// The channels of an EXR beside its colour. @throws Error (BadInput) as read()
std::vector<Channel> read_layers(const std::filesystem::path& path);

/// The texts inside a picture: all of a PNG and of an EXR, of the others those that write() puts
/// into XMP, whose keywords begin with `relevo:`.
/// @throws Error (BadInput) as read()
Metadata read_metadata(const std::filesystem::path& path);

/// Formats of pictures that this installation has, for people.
std::string installed_text();

/// How far two pictures are apart.
struct Difference {
    double worst = 0;         ///< largest difference of a value [1/255]
    double share_over_1 = 0;  ///< share of values that differ by more than 1/255
    double psnr_db = 0;       ///< peak signal to noise ratio; infinite where they are equal
};

/// @throws Error (BadInput) if sizes or channels differ
Difference compare(const Image8& a, const Image8& b);

}  // namespace relevo::image
