#include "image/image.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include <dlfcn.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/output_file.h"
#include "base/paths.h"
#include "image/formats.h"
#include "image/png.h"

namespace relevo::image {
namespace {

struct Format {
    const char* ending;
    const char* name;  ///< as OpenImageIO calls it
    bool linear;
};

constexpr std::array kFormats{Format{".png", "png", false},   Format{".jpg", "jpeg", false},
                              Format{".jpeg", "jpeg", false}, Format{".webp", "webp", false},
                              Format{".tif", "tiff", false},  Format{".tiff", "tiff", false},
                              Format{".exr", "openexr", true}};

const Format* format_of(const std::filesystem::path& path) {
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto* const found = std::find_if(kFormats.begin(), kFormats.end(),
                                           [&](const Format& f) { return ending == f.ending; });
    return found == kFormats.end() ? nullptr : found;
}

const FormatsModule& formats_module() {
    static const FormatsModule* const module = [] {
        const std::filesystem::path path = module_dir() / "image_formats.so";
        void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (!library) failed(fmt::format("image: {}", dlerror()));
        using Entry = const FormatsModule* (*)();
        const auto entry = reinterpret_cast<Entry>(dlsym(library, "relevo_image_formats"));
        if (!entry) failed(fmt::format("image: {}", dlerror()));
        return entry();
    }();
    return *module;
}

template <typename T, typename WriteOther>
void write_whole(const std::filesystem::path& path, const Pixels<T>& image,
                 const Metadata& metadata, bool overwrite, WriteOther write_other) {
    check_output(path, overwrite);
    const Format& format = *format_of(path);
    if (format.linear != std::is_same_v<T, float>)
        failed(fmt::format("image: {}: {} holds {}", path.string(), format.name,
                           format.linear ? "linear light" : "8-bit sRGB"));
    const PartialFile part(path);
    write_other(part.path(), format, image, metadata);
    part.become(path, overwrite, "image");
}

}  // namespace

bool is_picture_name(const std::filesystem::path& path) {
    return format_of(path) != nullptr;
}

bool holds_linear_light(const std::filesystem::path& path) {
    const Format* format = format_of(path);
    return format && format->linear;
}

void check_output(const std::filesystem::path& path, bool overwrite) {
    if (!is_picture_name(path))
        bad_input(
            fmt::format("image: {}: not the name of a picture, expected an ending of png, jpg, "
                        "webp, tif or exr",
                        path.string()));
    check_output_file(path, overwrite, "image");
}

void write(const std::filesystem::path& path, const Image8& image, const Metadata& metadata,
           bool overwrite) {
    write_whole(path, image, metadata, overwrite,
                [&](const std::filesystem::path& part, const Format& format, const Image8& pixels,
                    const Metadata& texts) {
                    if (std::string_view(format.name) == "png") {
                        write_png(part, pixels, texts);
                        return;
                    }
                    const std::string reason =
                        formats_module().write8(part, format.name, pixels, texts);
                    if (!reason.empty())
                        failed(fmt::format("image: {}: {}", path.string(), reason));
                });
}

void write(const std::filesystem::path& path, const ImageF& image, const Metadata& metadata,
           bool overwrite) {
    write_whole(path, image, metadata, overwrite,
                [&](const std::filesystem::path& part, const Format& format, const ImageF& pixels,
                    const Metadata& texts) {
                    const std::string reason =
                        formats_module().write_float(part, format.name, pixels, texts);
                    if (!reason.empty())
                        failed(fmt::format("image: {}: {}", path.string(), reason));
                });
}

Image8 read(const std::filesystem::path& path) {
    const Format* format = format_of(path);
    if (format && std::string_view(format->name) == "png") return read_png(path);
    const InputFile only_regular(path, "image");
    Image8 image;
    const std::string reason = formats_module().read8(path, image);
    if (!reason.empty()) bad_input(fmt::format("image: {}: {}", path.string(), reason));
    return image;
}

ImageF read_float(const std::filesystem::path& path) {
    const InputFile only_regular(path, "image");
    ImageF image;
    const std::string reason = formats_module().read_float(path, image);
    if (!reason.empty()) bad_input(fmt::format("image: {}: {}", path.string(), reason));
    return image;
}

Metadata read_metadata(const std::filesystem::path& path) {
    Metadata metadata;
    read_png(path, &metadata);
    return metadata;
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
