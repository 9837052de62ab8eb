#include <algorithm>

#include <OpenImageIO/imageio.h>

#include "image/formats.h"

namespace relevo::image {
namespace {

template <typename T>
std::string write(const std::filesystem::path& path, const std::string& format,
                  const Pixels<T>& image, const Metadata& metadata, OIIO::TypeDesc stored) {
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) return OIIO::geterror();
    OIIO::ImageSpec spec(image.width, image.height, image.channels, stored);
    spec.attribute("oiio:ColorSpace", sizeof(T) == 1 ? "sRGB" : "Linear");
    if (format == "jpeg" || format == "webp") spec.attribute("CompressionQuality", 95);
    if (format == "tiff") spec.attribute("compression", "zip");
    for (const auto& [keyword, text] : metadata)
        spec.attribute(keyword == "Description" ? "ImageDescription" : keyword, text);
    if (!output->open(path.string(), spec)) return output->geterror();
    if (!output->write_image(OIIO::BaseTypeFromC<T>::value, image.values.data()))
        return output->geterror();
    return output->close() ? std::string() : output->geterror();
}

template <typename T>
std::string read(const std::filesystem::path& path, Pixels<T>& image) {
    const auto input = OIIO::ImageInput::open(path.string());
    if (!input) return OIIO::geterror();
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.nchannels < 1 || spec.nchannels > 4) return "expected one to four channels";
    if (const std::string reason =
            size_fault(static_cast<std::uint64_t>(std::max(spec.width, 0)),
                       static_cast<std::uint64_t>(std::max(spec.height, 0)),
                       static_cast<std::uint64_t>(spec.nchannels) * sizeof(T));
        !reason.empty())
        return reason;
    image = Pixels<T>(spec.width, spec.height, spec.nchannels);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::BaseTypeFromC<T>::value,
                           image.values.data()))
        return input->geterror();
    return {};
}

}  // namespace

extern "C" const FormatsModule* relevo_image_formats() {
    static const FormatsModule module{
        [](const std::filesystem::path& path, const std::string& format, const Image8& image,
           const Metadata& metadata) {
            return write(path, format, image, metadata, OIIO::TypeDesc::UINT8);
        },
        [](const std::filesystem::path& path, const std::string& format, const ImageF& image,
           const Metadata& metadata) {
            return write(path, format, image, metadata, OIIO::TypeDesc::HALF);
        },
        [](const std::filesystem::path& path, Image8& image) { return read(path, image); },
        [](const std::filesystem::path& path, ImageF& image) { return read(path, image); }};
    return &module;
}

}  // namespace relevo::image
