#include "image/png.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include <fmt/format.h>
#include <libdeflate.h>
#include <png.h>
#include <unistd.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/text.h"
#include "image/formats.h"

namespace relevo::image {
namespace {

// libpng is C: its error handler may not return, and an exception may cross its frames because
// Debian builds it with unwind tables as everything else.
[[noreturn]] void on_error(png_structp png, png_const_charp message) {
    const auto& subject = *static_cast<const std::string*>(png_get_error_ptr(png));
    failed(fmt::format("image: {}: {}", printable(subject), message));
}

void on_warning(png_structp, png_const_charp) {}

/// Bytes that libpng may still allocate for a picture that is read, pixels not among them. Of 8 kB
/// a file may have 8 MB of text, a thousand times, or claim 2 GiB.
struct Allowance {
    std::size_t left = std::size_t{256} << 20;
};

png_voidp allocate(png_structp png, png_alloc_size_t bytes) {
    std::size_t& left = static_cast<Allowance*>(png_get_mem_ptr(png))->left;
    if (bytes > left) on_error(png, "needs more than 256 MiB in addition to its pixels");
    left -= bytes;
    return std::malloc(bytes);
}

void release(png_structp, png_voidp memory) {
    std::free(memory);
}

/// Gathers the small pieces in which libpng writes.
struct Sink {
    static constexpr std::size_t kSize = 1 << 16;

    OutputFile& file;
    std::vector<std::byte> bytes;

    void flush() {
        file.write(bytes);
        bytes.clear();
    }
};

void write_bytes(png_structp png, png_bytep from, std::size_t count) {
    Sink& sink = *static_cast<Sink*>(png_get_io_ptr(png));
    const auto* const first = reinterpret_cast<const std::byte*>(from);
    sink.bytes.insert(sink.bytes.end(), first, first + count);
    if (sink.bytes.size() >= Sink::kSize) sink.flush();
}

void flush_bytes(png_structp) {}

/// Larger pictures are deflated row by row, so that they take no memory beside their own.
constexpr std::size_t kMostAtOnce = std::size_t{1} << 26;  // [bytes]

/// A row as PNG has it: samples of 16 bits with their high byte first.
std::vector<std::uint8_t> bytes_of_row(const Image8& image, int y) {
    const auto count = static_cast<std::size_t>(image.width * image.channels);
    return {image.row(y), image.row(y) + count};
}
std::vector<std::uint8_t> bytes_of_row(const Image16& image, int y) {
    const auto count = static_cast<std::size_t>(image.width * image.channels);
    std::vector<std::uint8_t> bytes(2 * count);
    for (std::size_t i = 0; i < count; ++i) {
        bytes[2 * i] = static_cast<std::uint8_t>(image.row(y)[i] >> 8);
        bytes[2 * i + 1] = static_cast<std::uint8_t>(image.row(y)[i]);
    }
    return bytes;
}

/// The rows as PNG's filter "sub" leaves them: each byte less that of the pixel before it.
/// source: Portable Network Graphics (PNG) Specification, 2nd edition, ISO/IEC 15948:2003, 9.2
template <typename T>
std::vector<std::uint8_t> filtered(const Pixels<T>& image) {
    const std::size_t step = sizeof(T) * static_cast<std::size_t>(image.channels);
    const std::size_t width = step * static_cast<std::size_t>(image.width);
    std::vector<std::uint8_t> rows((width + 1) * static_cast<std::size_t>(image.height));
    std::uint8_t* to = rows.data();
    for (int y = 0; y < image.height; ++y) {
        const std::vector<std::uint8_t> from = bytes_of_row(image, y);
        *to++ = PNG_FILTER_VALUE_SUB;
        std::copy_n(from.begin(), std::min(step, width), to);
        for (std::size_t x = step; x < width; ++x)
            to[x] = static_cast<std::uint8_t>(from[x] - from[x - step]);
        to += width;
    }
    return rows;
}

/// The pixels and the end of a file in two chunks. libdeflate takes 30 ms of processor for a
/// picture of 1280 x 1024 where zlib takes 52, in 3 % fewer bytes; it takes all at once.
template <typename T>
void write_at_once(png_structp png, const Pixels<T>& image) {
    const std::vector<std::uint8_t> rows = filtered(image);
    const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
        libdeflate_alloc_compressor(4), libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    std::vector<std::uint8_t> deflated(
        libdeflate_zlib_compress_bound(compressor.get(), rows.size()));
    const std::size_t size = libdeflate_zlib_compress(compressor.get(), rows.data(), rows.size(),
                                                      deflated.data(), deflated.size());
    constexpr png_byte kPixels[] = "IDAT", kEnd[] = "IEND";
    png_write_chunk(png, kPixels, deflated.data(), size);
    png_write_chunk(png, kEnd, nullptr, 0);
}

int colour_type(int channels) {
    switch (channels) {
        case 1:
            return PNG_COLOR_TYPE_GRAY;
        case 2:
            return PNG_COLOR_TYPE_GRAY_ALPHA;
        case 3:
            return PNG_COLOR_TYPE_RGB;
        default:
            return PNG_COLOR_TYPE_RGB_ALPHA;
    }
}

void read_bytes(png_structp png, png_bytep to, std::size_t count) {
    const int descriptor = *static_cast<const int*>(png_get_io_ptr(png));
    while (count > 0) {
        const ssize_t got = ::read(descriptor, to, count);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) png_error(png, std::strerror(errno));
        if (got == 0) png_error(png, "the file ends too early");
        to += got;
        count -= static_cast<std::size_t>(got);
    }
}

/// Says so where a file is too short for the pixels that it claims, before there is memory for
/// them: deflate makes at most 1032 bytes of one (zlib's Technical Details).
void check_whole(const std::string& subject, png_structp png, png_infop info,
                 std::uint64_t file_bytes) {
    constexpr std::uint64_t kMaxInflated = 1032;
    const png_uint_32 width = png_get_image_width(png, info);
    const png_uint_32 height = png_get_image_height(png, info);
    const std::uint64_t bytes = std::uint64_t{png_get_rowbytes(png, info)} * height;
    if (bytes > kMaxInflated * file_bytes)
        failed(
            fmt::format("image: {}: a file of {} bytes cannot hold {} x {} pixels; it is "
                        "damaged",
                        subject, file_bytes, width, height));
}

}  // namespace

/// A PNG on its way into a file: all but its pixels and its end.
class PngBands::Writer {
  public:
    /// @param bits  of a channel
    Writer(OutputFile& file, int width_px, int height_px, int channels, int bits,
           const Metadata& metadata, double dpi = 0)
        : subject_(file.path().string()), sink_{file, {}} {
        png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &subject_, on_error, on_warning);
        info = png_create_info_struct(png);
        png_set_write_fn(png, &sink_, write_bytes, flush_bytes);
        // Of a picture that is written row by row: level 3 with one filter writes a 1280x1024
        // picture in a third of the time of libpng's own choice (level 6, the best of five filters
        // for each row) for 4 % more bytes (bench_image).
        png_set_compression_level(png, 3);
        png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
        // Our own sizes are checked before, and longer than libpng's 1,000,000 a side.
        png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
        png_set_IHDR(png, info, static_cast<png_uint_32>(width_px),
                     static_cast<png_uint_32>(height_px), bits, colour_type(channels),
                     PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
        png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
        const auto per_m = static_cast<png_uint_32>(std::lround(dpi / 0.0254));
        if (per_m > 0) png_set_pHYs(png, info, per_m, per_m, PNG_RESOLUTION_METER);
        set_texts(metadata);
        png_write_info(png, info);
    }
    ~Writer() { png_destroy_write_struct(&png, &info); }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    void flush() { sink_.flush(); }

    template <typename T>
    void write_rows(const Pixels<T>& image) {
        for (int y = 0; y < image.height; ++y)
            png_write_row(png, bytes_of_row(image, y).data());
    }
    void end() {
        png_write_end(png, info);
        flush();
    }

    png_structp png = nullptr;
    png_infop info = nullptr;

  private:
    void set_texts(const Metadata& metadata) {
        std::vector<png_text> texts;
        for (const auto& [keyword, text] : metadata) {
            png_text entry{};
            entry.compression = PNG_ITXT_COMPRESSION_NONE;
            entry.key = const_cast<char*>(keyword.c_str());
            entry.text = const_cast<char*>(text.c_str());
            entry.itxt_length = text.size();
            texts.push_back(entry);
        }
        if (!texts.empty()) png_set_text(png, info, texts.data(), static_cast<int>(texts.size()));
    }

    std::string subject_;
    Sink sink_;
};

PngBands::PngBands(OutputFile& file, int width_px, int height_px, int channels, int bits,
                   const Metadata& metadata)
    : writer_(std::make_unique<Writer>(file, width_px, height_px, channels, bits, metadata)) {}

PngBands::~PngBands() = default;

void PngBands::write(const Image8& band) {
    writer_->write_rows(band);
}

void PngBands::write(const Image16& band) {
    writer_->write_rows(band);
}

void PngBands::end() {
    writer_->end();
}

template <typename T>
void PngBands::write_whole(OutputFile& file, const Pixels<T>& image, const Metadata& metadata,
                           double dpi) {
    Writer writer(file, image.width, image.height, image.channels, 8 * sizeof(T), metadata, dpi);
    if (sizeof(T) * image.values.size() > kMostAtOnce) {
        writer.write_rows(image);
        return writer.end();
    }
    write_at_once(writer.png, image);
    writer.flush();
}

void write_png(OutputFile& file, const Image8& image, const Metadata& metadata, double dpi) {
    PngBands::write_whole(file, image, metadata, dpi);
}

void write_png(OutputFile& file, const Image16& image, const Metadata& metadata, double dpi) {
    PngBands::write_whole(file, image, metadata, dpi);
}

Image8 read_png(const std::filesystem::path& path, Metadata* metadata) {
    std::string subject = path.string();
    const InputFile input(AllowedName(path.string()), "image");
    struct Reader {
        png_structp png = nullptr;
        png_infop info = nullptr;
        ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
    } reader;
    Allowance allowance;
    reader.png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &subject, on_error, on_warning,
                                          &allowance, allocate, release);
    reader.info = png_create_info_struct(reader.png);
    int descriptor = input.descriptor();
    png_set_read_fn(reader.png, &descriptor, read_bytes);
    try {
        png_read_info(reader.png, reader.info);
        check_whole(subject, reader.png, reader.info, input.size());
        png_set_expand(reader.png);
        png_set_scale_16(reader.png);
        png_set_interlace_handling(reader.png);
        png_read_update_info(reader.png, reader.info);
        const std::uint64_t width = png_get_image_width(reader.png, reader.info);
        const std::uint64_t height = png_get_image_height(reader.png, reader.info);
        const int channels = png_get_channels(reader.png, reader.info);
        if (const std::string reason = size_fault(width, height, channels); !reason.empty())
            failed(fmt::format("image: {}: {}", subject, reason));
        Image8 image(static_cast<int>(width), static_cast<int>(height), channels);
        std::vector<png_bytep> rows;
        for (int y = 0; y < image.height; ++y)
            rows.push_back(image.row(y));
        png_read_image(reader.png, rows.data());
        png_read_end(reader.png, reader.info);
        if (metadata) {
            png_textp texts = nullptr;
            int count = 0;
            png_get_text(reader.png, reader.info, &texts, &count);
            for (int i = 0; i < count; ++i)
                (*metadata)[texts[i].key] = texts[i].text;
        }
        return image;
    } catch (const Error& error) {
        bad_input(error.what());
    }
}

}  // namespace relevo::image
