#include "image/image.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <mutex>

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/log.h"
#include "base/output_file.h"
#include "base/paths.h"
#include "base/text.h"
#include "image/formats.h"
#include "image/png.h"
#include "image/xmp.h"

namespace relevo::image {
namespace {

struct Format {
    const char* ending;
    const char* name;  ///< as OpenImageIO calls it; "avif" is libheif's
    bool linear;
    int largest_px;    ///< side
    bool deep, alpha;  ///< channels of 16 bits; transparent pixels
    bool quality;      ///< loses something, as much as asked for
};

constexpr int kAnySize = std::numeric_limits<int>::max();
constexpr std::array kFormats{Format{".png", "png", false, kAnySize, true, true, false},
                              Format{".jpg", "jpeg", false, 65500, false, false, true},
                              Format{".jpeg", "jpeg", false, 65500, false, false, true},
                              Format{".webp", "webp", false, 16383, false, true, true},
                              Format{".avif", "avif", false, 16384, false, true, true},
                              Format{".tif", "tiff", false, kAnySize, true, true, false},
                              Format{".tiff", "tiff", false, kAnySize, true, true, false},
                              Format{".exr", "openexr", true, kAnySize, false, true, false},
                              Format{".pdf", "jpeg", false, 65500, false, false, true}};

const Format* format_of(const std::filesystem::path& path) {
    const std::string ending = lower(path.extension().string());
    const auto* const found =
        std::ranges::find_if(kFormats, [&](const Format& f) { return ending == f.ending; });
    return found == kFormats.end() ? nullptr : found;
}

std::filesystem::path module_path() {
    return module_dir() / "image_formats.so";
}

/// The module, or null with the reason for there being none.
const FormatsModule* load_module(std::string& reason) {
    static const FormatsModule* module = nullptr;
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    if (module) return module;
    void* library = dlopen(module_path().c_str(), RTLD_NOW | RTLD_LOCAL);
    using Entry = const FormatsModule* (*)();
    const auto entry =
        library ? reinterpret_cast<Entry>(dlsym(library, "relevo_image_formats")) : nullptr;
    if (!entry) {
        const char* error = dlerror();
        reason = error ? error : module_path().string();
        return nullptr;
    }
    module = entry();
    return module;
}

const FormatsModule& formats_module(const std::filesystem::path& subject) {
    std::string reason;
    if (const FormatsModule* const module = load_module(reason)) return *module;
    std::error_code ignored;
    const bool is_there = std::filesystem::exists(module_path(), ignored);
    failed(fmt::format(
        "image: {}: the module for pictures other than PNG cannot be loaded, {}; {}name a .png",
        printable(subject.string()), reason,
        is_there ? "install OpenImageIO (libopenimageio2.4), or " : "this package has none: "));
}

bool is_png(const Format& format) {
    return std::string_view(format.name) == "png";
}

/// A name with the format's ending.
std::filesystem::path named(const std::filesystem::path& path, const Encoding& encoding) {
    return encoding.format.empty() ? path : std::filesystem::path("picture." + encoding.format);
}

const Format& known_format(const std::filesystem::path& path, const Encoding& encoding = {}) {
    const Format* const format = format_of(named(path, encoding));
    if (format) return *format;
    bad_input(fmt::format("image: {}: unknown picture format; use png, jpg, webp, avif, tif or exr",
                          printable(encoding.format.empty() ? path.string() : encoding.format)));
}

/// @param has  true for a format that has `what`
/// @throws Error (BadInput) if `format` has not, naming the formats that have
void check_has(const std::filesystem::path& path, const Format& format, const std::string& what,
               const std::function<bool(const Format&)>& has) {
    if (has(format)) return;
    std::vector<std::string> others;
    for (const Format& other : kFormats)
        if (has(other) && std::string_view(other.ending) != ".pdf")
            others.emplace_back(other.ending + 1);
    bad_input(fmt::format("image: {}: {} has no {}; use {}", printable(path.string()), format.name,
                          what, fmt::join(others, ", ")));
}

/// libjpeg ends the process where it finds no memory. What ends it while an encoder works is that.
class EncoderAtWork {
  public:
    explicit EncoderAtWork(const std::filesystem::path& path) : subject_(printable(path.string())) {
        static std::once_flag once;
        std::call_once(once, [] {
            log::level();  // so that the log outlives what is registered here
            std::atexit(end_of_process);
        });
        at_work = &subject_;
    }
    ~EncoderAtWork() { at_work = nullptr; }
    EncoderAtWork(const EncoderAtWork&) = delete;
    EncoderAtWork& operator=(const EncoderAtWork&) = delete;

  private:
    static void end_of_process() {
        const std::string* subject = at_work;
        if (!subject) return;
        log::error(
            fmt::format("image: {}: the encoder gave up, most likely for want of memory; "
                        "use a smaller --size, or name a .png",
                        *subject));
        remove_partial_files();
        _exit(static_cast<int>(ErrorCode::Failed));
    }

    // An encoder that gives up ends the process on its own thread.
    static thread_local const std::string* at_work;
    std::string subject_;
};

thread_local const std::string* EncoderAtWork::at_work = nullptr;

template <typename T>
void check_holds(const std::filesystem::path& path, const Format& format, const Pixels<T>& image) {
    if (format.linear != std::is_same_v<T, float>)
        failed(fmt::format("image: {}: {} holds {}", printable(path.string()), format.name,
                           format.linear ? "linear light" : "8-bit sRGB"));
    Encoding encoding{.format = format.ending + 1};
    if constexpr (!std::is_same_v<T, float>) encoding.bits = 8 * sizeof(T);
    check_encoding(path, encoding,
                   {image.width, image.height, image.channels == 2 || image.channels == 4, false});
}

/// A file's bytes, as many of them as a picture may have.
std::string bytes_of(const std::filesystem::path& path) {
    const InputFile file(AllowedName(path.string()), "image");
    std::string bytes;
    std::array<char, 1 << 16> buffer{};
    while (bytes.size() <= kMaxPictureBytes) {
        const ssize_t got = ::read(file.descriptor(), buffer.data(), buffer.size());
        if (got < 0 && errno == EINTR) continue;
        if (got < 0)
            bad_input(fmt::format("image: {}: cannot be read, {}", printable(path.string()),
                                  std::strerror(errno)));
        if (got == 0) break;
        bytes.append(buffer.data(), static_cast<std::size_t>(got));
    }
    return bytes;
}

}  // namespace

std::string installed_text() {
    std::string reason;
    return load_module(reason) ? "png, jpg, webp, avif, tif, exr" : "png alone, " + reason;
}

bool is_picture_name(const std::filesystem::path& path) {
    return format_of(path) != nullptr;
}

bool holds_linear_light(const std::filesystem::path& path) {
    const Format* format = format_of(path);
    return format && format->linear;
}

void check_format(const std::filesystem::path& path, int width_px, int height_px) {
    check_encoding(path, {}, {width_px, height_px, false, false});
}

void check_encoding(const std::filesystem::path& path, const Encoding& encoding,
                    const Needs& needs) {
    const Format& format = known_format(path, encoding);
    if (std::max(needs.width_px, needs.height_px) > format.largest_px)
        bad_input(
            fmt::format("image: {}: {} has sides of at most {} px, but this picture is {}x{}; "
                        "name another format",
                        printable(path.string()), format.name, format.largest_px, needs.width_px,
                        needs.height_px));
    if (encoding.bits > 8)
        check_has(path, format, "16-bit channels", [](const Format& f) { return f.deep; });
    if (encoding.quality)
        check_has(path, format, "quality to choose", [](const Format& f) { return f.quality; });
    if (needs.alpha)
        check_has(path, format, "transparent pixels", [](const Format& f) { return f.alpha; });
    if (needs.layers)
        check_has(path, format, "layers of data", [](const Format& f) { return f.linear; });
}

bool metadata_fits(const std::filesystem::path& path, const Metadata& metadata, std::size_t rest) {
    const Format& format = known_format(path);
    std::size_t bytes = rest;
    for (const auto& [keyword, text] : metadata)
        bytes += keyword.size() + text.size();
    if (std::string_view(format.name) == "jpeg")
        return xmp_packet(metadata).size() + rest <= kLongestXmpOfJpeg;
    return bytes <= (is_png(format) ? kLongestTextOfPng : kMaxPictureBytes / 2);
}

void load_format(const std::filesystem::path& path) {
    const Format& format = known_format(path);
    if (is_png(format)) return;
    const std::string reason = formats_module(path).missing(format.name);
    if (!reason.empty())
        failed(
            fmt::format("image: {}: {}, or name another format", printable(path.string()), reason));
}

std::vector<std::byte> encoded(const std::filesystem::path& path, const Picture& picture,
                               const Metadata& metadata, const Encoding& encoding) {
    const Format& format = known_format(path, encoding);
    assert(!is_png(format));
    std::visit([&](const auto& image) { check_holds(path, format, image); }, picture.pixels);
    const FormatsModule& module = formats_module(path);
    std::vector<std::byte> bytes;
    std::string reason;
    {
        const EncoderAtWork at_work(path);
        reason = module.encode(bytes, format.name, picture, metadata,
                               encoding.quality.value_or(kQuality));
    }
    if (!reason.empty()) failed(fmt::format("image: {}: {}", printable(path.string()), reason));
    return bytes;
}

void write(OutputFile& file, const Picture& picture, const Metadata& metadata,
           const Encoding& encoding) {
    const Format& format = known_format(file.path(), encoding);
    if (!is_png(format)) return file.write(encoded(file.path(), picture, metadata, encoding));
    std::visit([&](const auto& image) { check_holds(file.path(), format, image); }, picture.pixels);
    const auto* const deep = std::get_if<Image16>(&picture.pixels);
    if (deep)
        write_png(file, *deep, metadata, picture.dpi);
    else
        write_png(file, std::get<Image8>(picture.pixels), metadata, picture.dpi);
}

void write(OutputFile& file, Image8 image, const Metadata& metadata) {
    write(file, Picture{std::move(image)}, metadata);
}

void write(const std::filesystem::path& path, const Image8& image, const Metadata& metadata,
           bool overwrite) {
    known_format(path);
    OutputFile file(path, overwrite, "image");
    write(file, Picture{image}, metadata);
    file.finish();
}

void write(const std::filesystem::path& path, const ImageF& image, const Metadata& metadata,
           bool overwrite) {
    known_format(path);
    OutputFile file(path, overwrite, "image");
    write(file, Picture{image}, metadata);
    file.finish();
}

void check_bands(const std::filesystem::path& path) {
    const Format& format = known_format(path);
    if (!is_png(format))
        bad_input(
            fmt::format("image: {}: {} cannot be written in bands, as pictures of more than 1 GiB "
                        "are; use png, or a smaller --size",
                        printable(path.string()), format.name));
}

struct BandWriter::Impl {
    PngBands png;
};

BandWriter::BandWriter(OutputFile& file, const Needs& needs, const Metadata& metadata,
                       const Encoding& encoding) {
    check_encoding(file.path(), encoding, needs);
    check_bands(named(file.path(), encoding));
    impl_.reset(new Impl{PngBands(file, needs.width_px, needs.height_px, needs.alpha ? 4 : 3,
                                  encoding.bits, metadata)});
}

BandWriter::~BandWriter() = default;

void BandWriter::write(const Picture& band) {
    if (const auto* const deep = std::get_if<Image16>(&band.pixels))
        impl_->png.write(*deep);
    else
        impl_->png.write(std::get<Image8>(band.pixels));
}

void BandWriter::end() {
    impl_->png.end();
}

Image8 read(const std::filesystem::path& path) {
    const Format* format = format_of(path);
    if (format && is_png(*format)) return read_png(path);
    const InputFile only_regular(AllowedName(path.string()), "image");
    Image8 image;
    const std::string reason = formats_module(path).read8(AllowedName(path.string()), image);
    if (!reason.empty()) bad_input(fmt::format("image: {}: {}", printable(path.string()), reason));
    return image;
}

ImageF read_float(const std::filesystem::path& path) {
    const InputFile only_regular(AllowedName(path.string()), "image");
    ImageF image;
    const std::string reason = formats_module(path).read_float(AllowedName(path.string()), image);
    if (!reason.empty()) bad_input(fmt::format("image: {}: {}", printable(path.string()), reason));
    return image;
}

std::vector<Channel> read_layers(const std::filesystem::path& path) {
    const InputFile only_regular(AllowedName(path.string()), "image");
    std::vector<Channel> layers;
    const std::string reason = formats_module(path).read_layers(AllowedName(path.string()), layers);
    if (!reason.empty()) bad_input(fmt::format("image: {}: {}", printable(path.string()), reason));
    return layers;
}

Metadata read_metadata(const std::filesystem::path& path) {
    Metadata metadata;
    const Format* const format = format_of(path);
    if (!format || is_png(*format)) {
        read_png(path, &metadata);
    } else if (format->linear) {
        const InputFile only_regular(AllowedName(path.string()), "image");
        const std::string reason =
            formats_module(path).read_exr_texts(AllowedName(path.string()), metadata);
        if (!reason.empty())
            bad_input(fmt::format("image: {}: {}", printable(path.string()), reason));
    } else {
        metadata = texts_in_xmp(bytes_of(path));
    }
    return metadata;
}

Image8 from_device(int width_px, int height_px, const std::vector<std::uint8_t>& rgba) {
    assert(rgba.size() >= std::size_t{4} * static_cast<std::size_t>(width_px) *
                              static_cast<std::size_t>(height_px));
    Image8 picture(width_px, height_px, 3);
    for (int y = 0; y < height_px; ++y) {
        const std::uint8_t* from = rgba.data() + std::size_t{4} *
                                                     static_cast<std::size_t>(width_px) *
                                                     static_cast<std::size_t>(height_px - 1 - y);
        std::uint8_t* to = picture.row(y);
        for (int x = 0; x < width_px; ++x, from += 4, to += 3)
            std::copy_n(from, 3, to);
    }
    return picture;
}

Difference compare(const Image8& a, const Image8& b) {
    if (a.width != b.width || a.height != b.height || a.channels != b.channels)
        bad_input(fmt::format("image: sizes differ, {}x{} with {} channels and {}x{} with {}",
                              a.width, a.height, a.channels, b.width, b.height, b.channels));
    Difference result;
    double squares = 0;
    std::size_t over_1 = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const double d = std::abs(static_cast<double>(a.values[i]) - b.values[i]);
        result.worst = std::max(result.worst, d);
        squares += d * d;
        over_1 += d > 1;
    }
    const auto count = static_cast<double>(std::max<std::size_t>(1, a.values.size()));
    result.share_over_1 = static_cast<double>(over_1) / count;
    result.psnr_db = squares > 0 ? 10 * std::log10(255.0 * 255.0 * count / squares)
                                 : std::numeric_limits<double>::infinity();
    return result;
}

}  // namespace relevo::image
