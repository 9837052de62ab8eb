#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <tiffio.h>
#include <unistd.h>

#include "image/formats.h"
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
OIIO::ImageSpec spec_of(const Pixels<T>& image, const std::string& format, const Metadata& metadata,
                        OIIO::TypeDesc stored) {
    OIIO::ImageSpec spec(image.width, image.height, image.channels, stored);
    spec.attribute("oiio:ColorSpace", sizeof(T) == 1 ? "sRGB" : "Linear");
    if (format == "jpeg" || format == "webp") spec.attribute("CompressionQuality", 95);
    if (format == "tiff") spec.attribute("compression", "zip");
    // Of itself the library writes when it wrote, by which equal pictures would differ.
    spec.attribute("DateTime", "");
    for (const auto& [keyword, text] : metadata)
        if (format == "openexr" || !is_xmp_keyword(keyword))
            spec.attribute(keyword == "Description" ? "ImageDescription" : keyword, text);
    return spec;
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
    if (!input || !input->open(name, found) || found.width != image.width ||
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
std::string encode(std::vector<std::byte>& bytes, const std::string& format, const Pixels<T>& image,
                   const Metadata& metadata, OIIO::TypeDesc stored) {
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) return OIIO::geterror();
    const OIIO::ImageSpec spec = spec_of(image, format, metadata, stored);
    const std::string xmp = xmp_packet(metadata);
    if (format == "tiff") return encode_tiff(bytes, *output, spec, image, xmp);
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

std::string read_exr_texts(const std::filesystem::path& path, Metadata& metadata) {
    const auto input = OIIO::ImageInput::open(path.string());
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
        [](std::vector<std::byte>& bytes, const std::string& format, const Image8& image,
           const Metadata& metadata) {
            return encode(bytes, format, image, metadata, OIIO::TypeDesc::UINT8);
        },
        [](std::vector<std::byte>& bytes, const std::string& format, const ImageF& image,
           const Metadata& metadata) {
            return encode(bytes, format, image, metadata, OIIO::TypeDesc::HALF);
        },
        [](const std::filesystem::path& path, Image8& image) { return read(path, image); },
        [](const std::filesystem::path& path, ImageF& image) { return read(path, image); },
        read_exr_texts};
    return &module;
}

}  // namespace relevo::image
