#include "image/avif.h"

#include <algorithm>
#include <memory>
#include <new>

#include <libheif/heif.h>

namespace relevo::image {
namespace {

using Context = std::unique_ptr<heif_context, decltype(&heif_context_free)>;
using Encoder = std::unique_ptr<heif_encoder, decltype(&heif_encoder_release)>;
using Picture = std::unique_ptr<heif_image, decltype(&heif_image_release)>;
using Handle = std::unique_ptr<heif_image_handle, decltype(&heif_image_handle_release)>;
using Options = std::unique_ptr<heif_encoding_options, decltype(&heif_encoding_options_free)>;

/// What libheif says is wrong, thrown within this file.
struct Failure {
    std::string reason;
};

void check(const heif_error& error) {
    if (error.code != heif_error_Ok) throw Failure{error.message};
}

/// The image in libheif's memory.
Picture to_heif(const Image8& image) {
    heif_image* made = nullptr;
    const bool alpha = image.channels == 4;
    check(heif_image_create(image.width, image.height, heif_colorspace_RGB,
                            alpha ? heif_chroma_interleaved_RGBA : heif_chroma_interleaved_RGB,
                            &made));
    Picture picture(made, heif_image_release);
    check(heif_image_add_plane(made, heif_channel_interleaved, image.width, image.height, 8));
    int stride = 0;
    std::uint8_t* const to = heif_image_get_plane(made, heif_channel_interleaved, &stride);
    if (!to) throw std::bad_alloc();
    const auto bytes = static_cast<std::size_t>(image.width * image.channels);
    for (int y = 0; y < image.height; ++y)
        std::copy_n(image.row(y), bytes, to + std::ptrdiff_t{y} * stride);
    return picture;
}

heif_error append(heif_context*, const void* data, std::size_t size, void* to) {
    auto& bytes = *static_cast<std::vector<std::byte>*>(to);
    const auto* const from = static_cast<const std::byte*>(data);
    try {
        bytes.insert(bytes.end(), from, from + size);
    } catch (const std::bad_alloc&) {
        return {heif_error_Memory_allocation_error, heif_suberror_Unspecified, "out of memory"};
    }
    return {heif_error_Ok, heif_suberror_Unspecified, ""};
}

void encode(std::vector<std::byte>& bytes, const Image8& image, std::string_view xmp, int quality) {
    const Context context(heif_context_alloc(), heif_context_free);
    heif_encoder* found = nullptr;
    check(heif_context_get_encoder_for_format(context.get(), heif_compression_AV1, &found));
    const Encoder encoder(found, heif_encoder_release);
    check(heif_encoder_set_lossy_quality(encoder.get(), quality));
    check(heif_encoder_set_parameter_string(encoder.get(), "chroma", "444"));
    const Picture picture = to_heif(image);
    const Options options(heif_encoding_options_alloc(), heif_encoding_options_free);
    heif_image_handle* made = nullptr;
    check(heif_context_encode_image(context.get(), picture.get(), encoder.get(), options.get(),
                                    &made));
    const Handle handle(made, heif_image_handle_release);
    if (!xmp.empty())
        check(heif_context_add_XMP_metadata(context.get(), handle.get(), xmp.data(),
                                            static_cast<int>(xmp.size())));
    heif_writer writer{1, append};
    check(heif_context_write(context.get(), &writer, &bytes));
}

}  // namespace

std::string avif_missing() {
    return heif_have_encoder_for_format(heif_compression_AV1)
               ? ""
               : "libheif has no encoder for AV1 here; install libheif1 with libaom3";
}

std::string encode_avif(std::vector<std::byte>& bytes, const Image8& image, std::string_view xmp,
                        int quality) {
    if (image.channels < 3) return "expected red, green and blue";
    try {
        encode(bytes, image, xmp, quality);
        return {};
    } catch (const Failure& failure) {
        return failure.reason;
    } catch (const std::bad_alloc&) {
        return "not enough memory for the encoded picture";
    }
}

}  // namespace relevo::image
