#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>

#include <Imath/half.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <tiffio.h>
#include <unistd.h>

#include "image/avif.h"
#include "image/formats.h"
#include "image/webp.h"
#include "image/xmp.h"

namespace relevo::image {
namespace {

/// A file in memory, as encoders write it. One that does not fit goes on as if it did, as some of
/// them do not take a refusal well.
class MemoryFile : public OIIO::Filesystem::IOProxy {
  public:
    explicit MemoryFile(std::vector<std::byte>& bytes)
        : IOProxy("memory", Mode::Write), bytes_(bytes) {}

    const char* proxytype() const override { return "memory"; }
    size_t size() const override { return bytes_.size(); }
    bool out_of_memory() const { return out_of_memory_; }

    size_t write(const void* from, size_t count) override {
        const size_t written = pwrite(from, count, m_pos);
        m_pos += static_cast<int64_t>(written);
        return written;
    }
    size_t pwrite(const void* from, size_t count, int64_t offset) override {
        const auto first = static_cast<size_t>(offset);
        try {
            if (first + count > bytes_.size()) bytes_.resize(first + count);
        } catch (const std::bad_alloc&) {
            out_of_memory_ = true;
        }
        if (!out_of_memory_ && count > 0) std::memcpy(bytes_.data() + first, from, count);
        return count;
    }
    size_t read(void* to, size_t count) override {
        const size_t got = pread(to, count, m_pos);
        m_pos += static_cast<int64_t>(got);
        return got;
    }
    size_t pread(void* to, size_t count, int64_t offset) override {
        const auto first = std::min(static_cast<size_t>(offset), bytes_.size());
        count = std::min(count, bytes_.size() - first);
        if (count > 0) std::memcpy(to, bytes_.data() + first, count);
        return count;
    }

  private:
    std::vector<std::byte>& bytes_;
    bool out_of_memory_ = false;
};

template <typename T>
OIIO::TypeDesc stored_as() {
    return std::is_same_v<T, float> ? OIIO::TypeDesc::HALF : OIIO::BaseTypeFromC<T>::value;
}

template <typename T>
OIIO::ImageSpec spec_of(const Pixels<T>& image, const std::string& format, const Metadata& metadata,
                        int quality, double dpi = 0) {
    OIIO::ImageSpec spec(image.width, image.height, image.channels, stored_as<T>());
    spec.attribute("oiio:ColorSpace", std::is_same_v<T, float> ? "Linear" : "sRGB");
    // Alpha of whole numbers is straight, also where the library would multiply the colours.
    if (!std::is_same_v<T, float> && image.channels == 4)
        spec.attribute("oiio:UnassociatedAlpha", 1);
    if (format == "jpeg" || format == "webp") spec.attribute("CompressionQuality", quality);
    if (format == "tiff" || format == "openexr") spec.attribute("compression", "zip");
    if (dpi > 0) {
        spec.attribute("XResolution", static_cast<float>(dpi));
        spec.attribute("YResolution", static_cast<float>(dpi));
        spec.attribute("ResolutionUnit", "in");
    }
    // Of itself the library writes when it wrote, by which equal pictures would differ.
    spec.attribute("DateTime", "");
    for (const auto& [keyword, text] : metadata)
        if (format == "openexr" || !is_xmp_keyword(keyword))
            spec.attribute(keyword == "Description" ? "ImageDescription" : keyword, text);
    return spec;
}

/// How to read alpha: as files have it. The library would multiply colours by it.
OIIO::ImageSpec straight_alpha() {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    return config;
}

/// Writes all of a picture. @returns the reason for failing, or nothing
template <typename T>
std::string put(OIIO::ImageOutput& output, const std::string& name, const OIIO::ImageSpec& spec,
                const Pixels<T>& image) {
    if (output.open(name, spec) &&
        output.write_image(OIIO::BaseTypeFromC<T>::value, image.values.data()) && output.close())
        return {};
    const std::string reason = output.geterror();
    return reason.empty() ? "the encoder failed without a reason" : reason;
}

/// Takes the time of writing out of a TIFF, and puts XMP in.
std::string finish_tiff(const std::string& name, const std::string& xmp) {
    TIFFSetErrorHandler(nullptr);
    TIFFSetWarningHandler(nullptr);
    TIFF* const file = TIFFOpen(name.c_str(), "r+");
    if (!file) return "what was written cannot be opened again";
    bool done = TIFFUnsetField(file, TIFFTAG_DATETIME) == 1;
    if (done && !xmp.empty())
        done = TIFFSetField(file, TIFFTAG_XMLPACKET, static_cast<std::uint32_t>(xmp.size()),
                            xmp.data()) == 1;
    done = done && TIFFRewriteDirectory(file) == 1;
    TIFFClose(file);
    return done ? "" : "the metadata cannot be written, most likely for want of memory";
}

/// As TIFF, by way of a file that exists in memory only: OpenImageIO 2.4 cannot read back what it
/// wrote to an IOProxy, which the directory of Exif data asks for. It says nothing where a write
/// fails, so that what is there is read again.
template <typename T>
std::string encode_tiff(std::vector<std::byte>& bytes, OIIO::ImageOutput& output,
                        const OIIO::ImageSpec& spec, const Pixels<T>& image,
                        const std::string& xmp) {
    struct File {
        int descriptor = memfd_create("picture.tif", MFD_CLOEXEC);
        ~File() { close(descriptor); }
    } const file;
    if (file.descriptor < 0) return std::strerror(errno);
    const std::string name = "/proc/self/fd/" + std::to_string(file.descriptor);
    std::string reason = put(output, name, spec, image);
    if (reason.empty()) reason = finish_tiff(name, xmp);
    struct stat status {};
    rlimit limit{};
    if (fstat(file.descriptor, &status) != 0) return std::strerror(errno);
    if (getrlimit(RLIMIT_FSIZE, &limit) == 0 &&
        static_cast<rlim_t>(status.st_size) >= limit.rlim_cur)
        return std::string("cannot be written, ") + std::strerror(EFBIG);
    if (!reason.empty()) return reason;
    Pixels<T> again(image.width, image.height, image.channels);
    const auto input = OIIO::ImageInput::create("tiff");
    OIIO::ImageSpec found;
    if (!input || !input->open(name, found, straight_alpha()) || found.width != image.width ||
        found.height != image.height || found.nchannels != image.channels ||
        !input->read_image(0, 0, 0, image.channels, OIIO::BaseTypeFromC<T>::value,
                           again.values.data()) ||
        again.values != image.values)
        return "the encoder left it damaged, most likely for want of memory";
    bytes.resize(static_cast<std::size_t>(status.st_size));
    for (std::size_t at = 0; at < bytes.size();) {
        const ssize_t got =
            pread(file.descriptor, bytes.data() + at, bytes.size() - at, static_cast<off_t>(at));
        if (got <= 0) return std::strerror(got < 0 ? errno : EIO);
        at += static_cast<std::size_t>(got);
    }
    return {};
}

template <typename T>
std::string encode_pixels(std::vector<std::byte>& bytes, const std::string& format,
                          const Pixels<T>& image, const Metadata& metadata, int quality,
                          double dpi) {
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) return OIIO::geterror();
    const OIIO::ImageSpec spec = spec_of(image, format, metadata, quality, dpi);
    const std::string xmp = xmp_packet(metadata);
    if (format == "tiff") return encode_tiff(bytes, *output, spec, image, xmp);
    if constexpr (std::is_same_v<T, std::uint8_t>)
        if (format == "webp" && image.channels == 4) {
            const std::string reason = encode_webp(bytes, image, quality);
            return !reason.empty() || xmp.empty()
                       ? reason
                       : add_xmp_to_webp(bytes, xmp, image.width, image.height);
        }
    MemoryFile file(bytes);
    if (!output->supports("ioproxy") || !output->set_ioproxy(&file))
        return "this build of OpenImageIO cannot write the format to memory";
    const std::string reason = put(*output, "picture." + format, spec, image);
    if (file.out_of_memory()) return "not enough memory for the encoded picture";
    if (!reason.empty() || xmp.empty()) return reason;
    if (format == "jpeg") return add_xmp_to_jpeg(bytes, xmp);
    if (format == "webp") return add_xmp_to_webp(bytes, xmp, image.width, image.height);
    return {};
}

/// The colour of an EXR, and its layers as further channels of the same part. Programs tell layers
/// by the part of a channel's name before its dot.
std::string encode_layers(std::vector<std::byte>& bytes, const ImageF& colour,
                          const std::vector<Channel>& layers, const Metadata& metadata) {
    const auto output = OIIO::ImageOutput::create("openexr");
    if (!output) return OIIO::geterror();
    OIIO::ImageSpec spec = spec_of(colour, "openexr", metadata, 0);
    spec.channelformats.assign(static_cast<std::size_t>(colour.channels), OIIO::TypeDesc::HALF);
    for (const Channel& layer : layers) {
        spec.channelnames.push_back(layer.name);
        spec.channelformats.push_back(layer.is_whole ? OIIO::TypeDesc::UINT32
                                                     : OIIO::TypeDesc::FLOAT);
    }
    spec.nchannels = static_cast<int>(spec.channelnames.size());
    MemoryFile file(bytes);
    if (!output->set_ioproxy(&file) || !output->open("picture.exr", spec))
        return output->geterror();
    // Each pixel as the file has it: halves, then four bytes a layer.
    std::vector<std::byte> row(spec.scanline_bytes(true));
    for (int y = 0; y < colour.height; ++y) {
        std::byte* to = row.data();
        const auto add = [&](auto value) {
            std::memcpy(to, &value, sizeof value);
            to += sizeof value;
        };
        for (int x = 0; x < colour.width; ++x) {
            for (int c = 0; c < colour.channels; ++c)
                add(half(colour.at(x, y, c)));
            for (const Channel& layer : layers) {
                const float value = layer.values[static_cast<std::size_t>(y) *
                                                     static_cast<std::size_t>(colour.width) +
                                                 static_cast<std::size_t>(x)];
                if (layer.is_whole)
                    add(static_cast<std::uint32_t>(value));
                else
                    add(value);
            }
        }
        if (!output->write_scanline(y, 0, OIIO::TypeDesc::UNKNOWN, row.data()))
            return output->geterror();
    }
    if (!output->close()) return output->geterror();
    return file.out_of_memory() ? "not enough memory for the encoded picture" : "";
}

std::string encode(std::vector<std::byte>& bytes, const std::string& format, const Picture& picture,
                   const Metadata& metadata, int quality) {
    if (format == "avif")
        return encode_avif(bytes, std::get<Image8>(picture.pixels), xmp_packet(metadata), quality);
    if (!picture.layers.empty())
        return encode_layers(bytes, std::get<ImageF>(picture.pixels), picture.layers, metadata);
    return std::visit(
        [&](const auto& image) {
            return encode_pixels(bytes, format, image, metadata, quality, picture.dpi);
        },
        picture.pixels);
}

/// Channels of an image that are its colour: all of them, or those of an EXR before its layers.
int colour_channels(const OIIO::ImageSpec& spec) {
    int count = 0;
    while (count < spec.nchannels &&
           spec.channelnames[static_cast<std::size_t>(count)].find('.') == std::string::npos)
        ++count;
    return count > 0 ? count : spec.nchannels;
}

/// By WebP's own library: OpenImageIO multiplies the colours by alpha.
std::string read_webp(const AllowedName& name, Image8& image) {
    std::string bytes;
    OIIO::Filesystem::read_text_file(name.text(), bytes);
    return decode_webp(bytes, image);
}

template <typename T>
std::string read(const AllowedName& name, Pixels<T>& image) {
    const OIIO::ImageSpec straight = straight_alpha();
    const auto input = OIIO::ImageInput::open(name.text(), &straight);
    if (!input) return OIIO::geterror();
    const OIIO::ImageSpec& spec = input->spec();
    const int channels = colour_channels(spec);
    if (channels < 1 || channels > 4) return "expected one to four channels";
    if (const std::string reason = size_fault(static_cast<std::uint64_t>(std::max(spec.width, 0)),
                                              static_cast<std::uint64_t>(std::max(spec.height, 0)),
                                              static_cast<std::uint64_t>(channels) * sizeof(T));
        !reason.empty())
        return reason;
    image = Pixels<T>(spec.width, spec.height, channels);
    if constexpr (std::is_same_v<T, std::uint8_t>)
        if (channels == 4 && std::string_view(input->format_name()) == "webp")
            return read_webp(name, image);
    if (!input->read_image(0, 0, 0, channels, OIIO::BaseTypeFromC<T>::value, image.values.data()))
        return input->geterror();
    return {};
}

std::string read_layers(const AllowedName& name, std::vector<Channel>& layers) {
    const auto input = OIIO::ImageInput::open(name.text());
    if (!input) return OIIO::geterror();
    const OIIO::ImageSpec& spec = input->spec();
    if (const std::string reason =
            size_fault(static_cast<std::uint64_t>(std::max(spec.width, 0)),
                       static_cast<std::uint64_t>(std::max(spec.height, 0)),
                       static_cast<std::uint64_t>(spec.nchannels) * sizeof(float));
        !reason.empty())
        return reason;
    for (int c = colour_channels(spec); c < spec.nchannels; ++c) {
        Channel layer{.name = spec.channelnames[static_cast<std::size_t>(c)],
                      .is_whole = spec.channelformat(c) == OIIO::TypeDesc::UINT32};
        layer.values.resize(static_cast<std::size_t>(spec.width) *
                            static_cast<std::size_t>(spec.height));
        // Whole numbers are not scaled to 0..1.
        std::vector<std::uint32_t> whole(layer.is_whole ? layer.values.size() : 0);
        const bool done =
            layer.is_whole
                ? input->read_image(0, 0, c, c + 1, OIIO::TypeDesc::UINT32, whole.data())
                : input->read_image(0, 0, c, c + 1, OIIO::TypeDesc::FLOAT, layer.values.data());
        if (!done) return input->geterror();
        std::ranges::copy(whole, layer.values.begin());
        layers.push_back(std::move(layer));
    }
    return {};
}

std::string read_exr_texts(const AllowedName& name, Metadata& metadata) {
    const auto input = OIIO::ImageInput::open(name.text());
    if (!input) return OIIO::geterror();
    for (const OIIO::ParamValue& attribute : input->spec().extra_attribs)
        if (attribute.type() == OIIO::TypeDesc::STRING)
            metadata[attribute.name() == "ImageDescription" ? "Description"
                                                            : attribute.name().string()] =
                attribute.get_string();
    return {};
}

}  // namespace

extern "C" const FormatsModule* relevo_image_formats() {
    static const FormatsModule module{
        encode,
        [](const AllowedName& name, Image8& image) { return read(name, image); },
        [](const AllowedName& name, ImageF& image) { return read(name, image); },
        read_layers,
        read_exr_texts,
        [](const std::string& format) {
            return format == "avif" ? avif_missing() : std::string();
        }};
    return &module;
}

}  // namespace relevo::image
