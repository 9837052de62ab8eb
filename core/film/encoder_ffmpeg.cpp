// The module `film_encoder`: FFmpeg 5.1 and later.
//
// 4:2:0 in BT.709, limited range, is decoded in hardware by every browser and player. 4:4:4 was
// rejected: Chromium does not play it on many devices. So H.264 needs even sides.

#include <cerrno>
#include <cstring>
#include <memory>
#include <string>

#include <unistd.h>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/imgutils.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include "film/encoder.h"
#include "film/palette.h"

namespace relevo::film {
namespace {

// The same for any machine, because encoders' bytes depend on it.
constexpr int kThreads = 4;

std::string text_of(int error) {
    char text[AV_ERROR_MAX_STRING_SIZE] = {};
    return av_make_error_string(text, sizeof text, error);
}

/// A failure of FFmpeg on its way to the module's edge.
struct Failure {
    std::string reason;
};

void check(int result, const char* what) {
    if (result < 0) throw Failure{std::string(what) + ", " + text_of(result)};
}

/// A file for FFmpeg, by a descriptor. Several may share it: each has its own position.
class FileAccess {
  public:
    explicit FileAccess(int descriptor, bool writes) : descriptor_(descriptor) {
        constexpr int kBuffer = 1 << 16;
        auto* const buffer = static_cast<unsigned char*>(av_malloc(kBuffer));
        context_ = avio_alloc_context(buffer, kBuffer, writes ? 1 : 0, this, read, write, seek);
        if (!context_) throw Failure{"out of memory"};
    }
    ~FileAccess() {
        av_freep(&context_->buffer);
        avio_context_free(&context_);
    }
    FileAccess(const FileAccess&) = delete;
    FileAccess& operator=(const FileAccess&) = delete;

    AVIOContext* context() { return context_; }

    /// @throws Failure if the disk has refused anything so far
    void check_disk() const {
        if (error_ != 0) throw Failure{std::string("cannot be written, ") + std::strerror(error_)};
    }

  private:
    static int read(void* self, unsigned char* buffer, int size) {
        auto& file = *static_cast<FileAccess*>(self);
        const ssize_t got =
            pread(file.descriptor_, buffer, static_cast<std::size_t>(size), file.at_);
        if (got < 0) return AVERROR(errno);
        if (got == 0) return AVERROR_EOF;
        file.at_ += got;
        return static_cast<int>(got);
    }

    static int write(void* self, unsigned char* buffer, int size) {
        auto& file = *static_cast<FileAccess*>(self);
        for (int done = 0; done < size;) {
            const ssize_t written = pwrite(file.descriptor_, buffer + done,
                                           static_cast<std::size_t>(size - done), file.at_);
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) {
                if (file.error_ == 0) file.error_ = errno;
                return AVERROR(errno);
            }
            done += static_cast<int>(written);
            file.at_ += written;
        }
        return size;
    }

    static std::int64_t seek(void* self, std::int64_t offset, int whence) {
        auto& file = *static_cast<FileAccess*>(self);
        whence &= ~AVSEEK_FORCE;
        const off_t end = lseek(file.descriptor_, 0, SEEK_END);
        if (end < 0) return AVERROR(errno);
        if (whence & AVSEEK_SIZE) return end;
        const std::int64_t from = whence == SEEK_CUR ? file.at_ : whence == SEEK_END ? end : 0;
        return file.at_ = from + offset;
    }

    int descriptor_;
    std::int64_t at_ = 0;
    int error_ = 0;  ///< the first errno of a write
    AVIOContext* context_ = nullptr;
};

template <auto free_it>
struct Freed {
    template <typename T>
    void operator()(T* thing) const {
        free_it(&thing);
    }
};
using CodecContext = std::unique_ptr<AVCodecContext, Freed<avcodec_free_context>>;
using Frame = std::unique_ptr<AVFrame, Freed<av_frame_free>>;
using Packet = std::unique_ptr<AVPacket, Freed<av_packet_free>>;
struct FreedFormat {
    void operator()(AVFormatContext* format) const { avformat_free_context(format); }
};
struct FreedScaler {
    void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

class Options {
  public:
    Options() = default;
    ~Options() { av_dict_free(&values_); }
    Options(const Options&) = delete;
    Options& operator=(const Options&) = delete;

    void set(const char* key, const std::string& value) {
        av_dict_set(&values_, key, value.c_str(), 0);
    }
    AVDictionary** get() { return &values_; }

  private:
    AVDictionary* values_ = nullptr;
};

Frame frame_of(AVPixelFormat format, int width, int height) {
    Frame frame(av_frame_alloc());
    if (!frame) throw Failure{"out of memory"};
    frame->format = format;
    frame->width = width;
    frame->height = height;
    check(av_frame_get_buffer(frame.get(), 0), "no memory for a frame");
    return frame;
}

/// The pixels that an encoder takes.
AVPixelFormat pixels_of(const std::string& encoder) {
    if (encoder == "gif") return AV_PIX_FMT_PAL8;
    if (encoder == "libwebp_anim") return AV_PIX_FMT_BGRA;
    return AV_PIX_FMT_YUV420P;
}

/// Sets quality and speed. The constant rate factors look about alike at the same quality. Speeds
/// are such that encoding takes less than a fifth of what drawing takes on a processor
/// (tests/bench/bench_film.cpp).
void set_effort(const std::string& encoder, int quality, AVCodecContext& codec, Options& options) {
    if (encoder == "libx264") {
        options.set("crf", std::to_string(38 - quality / 4.0));
        options.set("preset", "faster");
        // x264 164's vectorised mbtree reads behind rows of other numbers of macroblocks: the film
        // would be right, but its bytes differ from run to run.
        if ((codec.width + 15) / 16 % 8 != 0) options.set("mbtree", "0");
    } else if (encoder == "libopenh264") {  // has no constant quality
        const double pixels_s = codec.width * codec.height * av_q2d(codec.framerate);
        codec.bit_rate = static_cast<std::int64_t>(pixels_s * (0.02 + 0.003 * quality));
    } else if (encoder == "libwebp_anim") {
        options.set("quality", std::to_string(quality));
    } else if (encoder != "gif") {  // VP9 and AV1
        options.set("crf", std::to_string(44 - quality * 3 / 10));
        options.set("b", "0");
    }
    if (encoder == "libvpx-vp9") options.set("deadline", "realtime");
    if (encoder == "libvpx-vp9" || encoder == "libaom-av1") {
        options.set("cpu-used", "6");
        options.set("row-mt", "1");
    }
    if (encoder == "libsvtav1") options.set("preset", "8");
}

class FfmpegEncoder final : public Encoder {
  public:
    FfmpegEncoder(const Request& request, const AVCodec& codec)
        : request_(request), file_(request.descriptor, true) {
        open_format();
        open_codec(codec);
        write_header();
        packet_.reset(av_packet_alloc());
        if (!packet_) throw Failure{"out of memory"};
    }
    ~FfmpegEncoder() override = default;

    std::string add(const image::Image8& frame) override {
        try {
            const Frame made = frame_to_encode(frame);
            made->pts = next_++;
            send(made.get());
            return {};
        } catch (const Failure& failure) {
            return failure.reason;
        }
    }

    std::string finish() override {
        try {
            send(nullptr);
            check(av_write_trailer(format_.get()), "the end of the film cannot be written");
            avio_flush(file_.context());
            file_.check_disk();
            return {};
        } catch (const Failure& failure) {
            return failure.reason;
        }
    }

  private:
    void open_format() {
        AVFormatContext* format = nullptr;
        check(avformat_alloc_output_context2(&format, nullptr, request_.muxer.c_str(), nullptr),
              "this FFmpeg has no such format");
        format_.reset(format);
        format->pb = file_.context();
        format->flags |= AVFMT_FLAG_CUSTOM_IO | AVFMT_FLAG_BITEXACT;
        // Faststart reads what was written, to move it behind the index.
        format->opaque = this;
        format->io_open = [](AVFormatContext* of, AVIOContext** context, const char*, int flags,
                             AVDictionary**) -> int {
            auto& self = *static_cast<FfmpegEncoder*>(of->opaque);
            if (flags & AVIO_FLAG_WRITE) return AVERROR(EPERM);
            self.reader_ = std::make_unique<FileAccess>(self.request_.descriptor, false);
            *context = self.reader_->context();
            return 0;
        };
        format->io_close2 = [](AVFormatContext* of, AVIOContext*) -> int {
            static_cast<FfmpegEncoder*>(of->opaque)->reader_.reset();
            return 0;
        };
    }

    void open_codec(const AVCodec& codec) {
        codec_.reset(avcodec_alloc_context3(&codec));
        if (!codec_) throw Failure{"out of memory"};
        name_ = codec.name;
        codec_->width = request_.width_px;
        codec_->height = request_.height_px;
        codec_->pix_fmt = pixels_of(name_);
        codec_->time_base = {request_.rate.seconds, request_.rate.frames};
        codec_->framerate = {request_.rate.frames, request_.rate.seconds};
        codec_->gop_size = std::max(1, 4 * request_.rate.frames / request_.rate.seconds);
        codec_->thread_count = kThreads;
        codec_->flags |= AV_CODEC_FLAG_BITEXACT;
        if (format_->oformat->flags & AVFMT_GLOBALHEADER)
            codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
        if (codec_->pix_fmt == AV_PIX_FMT_YUV420P) {
            codec_->color_range = AVCOL_RANGE_MPEG;
            codec_->colorspace = AVCOL_SPC_BT709;
            codec_->color_primaries = AVCOL_PRI_BT709;
            codec_->color_trc = AVCOL_TRC_BT709;
            codec_->chroma_sample_location = AVCHROMA_LOC_LEFT;
        }
        Options options;
        set_effort(name_, request_.quality, *codec_, options);
        check(avcodec_open2(codec_.get(), &codec, options.get()), "the encoder cannot be opened");
    }

    void write_header() {
        stream_ = avformat_new_stream(format_.get(), nullptr);
        if (!stream_) throw Failure{"out of memory"};
        check(avcodec_parameters_from_context(stream_->codecpar, codec_.get()), "no memory");
        stream_->time_base = codec_->time_base;
        stream_->avg_frame_rate = codec_->framerate;
        if (!request_.comment.empty())
            av_dict_set(&format_->metadata, "comment", request_.comment.c_str(), 0);
        Options options;
        if (request_.muxer == "mp4") options.set("movflags", "+faststart");
        // 0 is for ever. Without repeats, WebP counts plays and GIF has -1.
        if (request_.muxer == "webp") options.set("loop", request_.loop ? "0" : "1");
        if (request_.muxer == "gif") options.set("loop", request_.loop ? "0" : "-1");
        check(avformat_write_header(format_.get(), options.get()), "the film cannot be begun");
        file_.check_disk();
    }

    Frame frame_to_encode(const image::Image8& image) {
        if (codec_->pix_fmt == AV_PIX_FMT_PAL8) return paletted(image);
        const AVPixelFormat given = image.channels == 4 ? AV_PIX_FMT_RGB0 : AV_PIX_FMT_RGB24;
        // Copied, because the scaler reads some bytes behind the last row.
        const Frame rgb = frame_of(given, image.width, image.height);
        for (int y = 0; y < image.height; ++y)
            std::memcpy(rgb->data[0] + static_cast<std::ptrdiff_t>(y) * rgb->linesize[0],
                        image.row(y), static_cast<std::size_t>(image.width * image.channels));
        Frame made = frame_of(codec_->pix_fmt, image.width, image.height);
        made->color_range = codec_->color_range;
        made->colorspace = codec_->colorspace;
        made->color_primaries = codec_->color_primaries;
        made->color_trc = codec_->color_trc;
        made->chroma_location = codec_->chroma_sample_location;
        sws_scale(scaler(given), rgb->data, rgb->linesize, 0, image.height, made->data,
                  made->linesize);
        return made;
    }

    /// From full-range RGB to the encoder's pixels, without a change of size.
    SwsContext* scaler(AVPixelFormat given) {
        if (scaler_) return scaler_.get();
        scaler_.reset(sws_getContext(request_.width_px, request_.height_px, given,
                                     request_.width_px, request_.height_px, codec_->pix_fmt,
                                     SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP, nullptr,
                                     nullptr, nullptr));
        if (!scaler_) throw Failure{"the colours cannot be converted"};
        const int* const matrix = sws_getCoefficients(SWS_CS_ITU709);
        constexpr int kOne = 1 << 16;
        sws_setColorspaceDetails(scaler_.get(), matrix, 1, matrix, 0, 0, kOne, kOne);
        return scaler_.get();
    }

    Frame paletted(const image::Image8& image) const {
        const Palette palette = median_cut(image);
        const std::vector<std::uint8_t> indices = dithered(image, palette);
        Frame made = frame_of(AV_PIX_FMT_PAL8, image.width, image.height);
        const auto width = static_cast<std::size_t>(image.width);
        for (int y = 0; y < image.height; ++y)
            std::memcpy(made->data[0] + static_cast<std::ptrdiff_t>(y) * made->linesize[0],
                        indices.data() + static_cast<std::size_t>(y) * width, width);
        for (std::size_t i = 0; i < palette.size(); ++i) {
            const std::uint32_t argb = 0xff000000U | palette[i];
            std::memcpy(made->data[1] + 4 * i, &argb, sizeof argb);
        }
        return made;
    }

    /// Encodes a frame, or with null what the encoder still holds, and writes what comes out.
    void send(const AVFrame* frame) {
        check(avcodec_send_frame(codec_.get(), frame), "the encoder refuses it");
        for (;;) {
            const int got = avcodec_receive_packet(codec_.get(), packet_.get());
            if (got == AVERROR(EAGAIN) || got == AVERROR_EOF) break;
            check(got, "it cannot be encoded");
            av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
            packet_->stream_index = stream_->index;
            const int written = av_interleaved_write_frame(format_.get(), packet_.get());
            file_.check_disk();
            check(written, "it cannot be written");
        }
    }

    Request request_;
    std::string name_;  ///< of the encoder
    FileAccess file_;
    std::unique_ptr<FileAccess> reader_;
    std::unique_ptr<AVFormatContext, FreedFormat> format_;
    CodecContext codec_;
    std::unique_ptr<SwsContext, FreedScaler> scaler_;
    Packet packet_;
    AVStream* stream_ = nullptr;
    std::int64_t next_ = 0;
};

bool has_encoder(const std::string& name) {
    return avcodec_find_encoder_by_name(name.c_str()) != nullptr;
}

Encoder* open(const Request& request, std::string& reason) {
    av_log_set_level(AV_LOG_QUIET);
    for (const std::string& name : request.encoders) {
        const AVCodec* const codec = avcodec_find_encoder_by_name(name.c_str());
        if (!codec) continue;
        try {
            return new FfmpegEncoder(request, *codec);
        } catch (const Failure& failure) {
            reason = name + ": " + failure.reason;
            return nullptr;
        }
    }
    reason = "no encoder";
    return nullptr;
}

std::string version() {
    const unsigned number = avcodec_version();
    return "libavcodec " + std::to_string(AV_VERSION_MAJOR(number)) + '.' +
           std::to_string(AV_VERSION_MINOR(number)) + '.' +
           std::to_string(AV_VERSION_MICRO(number));
}

}  // namespace

extern "C" const EncoderModule* relevo_film_encoder() {
    static const EncoderModule module{open, has_encoder, version};
    return &module;
}

}  // namespace relevo::film
