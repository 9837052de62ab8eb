#include "film/decoded_film.h"

#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace relevo::test {
namespace {

void check(int result, const char* what) {
    if (result < 0) throw std::runtime_error(what);
}

/// By the matrix and the range that the frame says it has.
image::Image8 rgb_of(const AVFrame& frame) {
    SwsContext* const scaler = sws_getContext(
        frame.width, frame.height, static_cast<AVPixelFormat>(frame.format), frame.width,
        frame.height, AV_PIX_FMT_RGB24, SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT,
        nullptr, nullptr, nullptr);
    const bool bt709 = frame.colorspace == AVCOL_SPC_BT709;
    const int* const matrix = sws_getCoefficients(bt709 ? SWS_CS_ITU709 : SWS_CS_ITU601);
    sws_setColorspaceDetails(scaler, matrix, frame.color_range == AVCOL_RANGE_JPEG, matrix, 1, 0,
                             1 << 16, 1 << 16);
    const int stride = (frame.width * 3 + 63) / 64 * 64 + 64;
    std::vector<std::uint8_t> padded(static_cast<std::size_t>(stride * (frame.height + 1)));
    std::uint8_t* const rows[4] = {padded.data()};
    const int strides[4] = {stride};
    sws_scale(scaler, frame.data, frame.linesize, 0, frame.height, rows, strides);
    sws_freeContext(scaler);
    image::Image8 image(frame.width, frame.height, 3);
    for (int y = 0; y < frame.height; ++y)
        std::memcpy(image.row(y), padded.data() + static_cast<std::ptrdiff_t>(y) * stride,
                    static_cast<std::size_t>(frame.width * 3));
    return image;
}

std::string text(const char* words) {
    return words ? words : "";
}

bool index_is_first(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    return bytes.find("moov") < bytes.find("mdat");
}

}  // namespace

DecodedFilm decode_film(const std::filesystem::path& path,
                        const std::function<bool(std::size_t)>& keep) {
    AVFormatContext* format = nullptr;
    check(avformat_open_input(&format, path.c_str(), nullptr, nullptr), "no film");
    check(avformat_find_stream_info(format, nullptr), "no stream");
    const int index = av_find_best_stream(format, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
    check(index, "no video");
    const AVStream& stream = *format->streams[index];
    const AVCodec* const codec = avcodec_find_decoder(stream.codecpar->codec_id);
    AVCodecContext* decoder = avcodec_alloc_context3(codec);
    check(avcodec_parameters_to_context(decoder, stream.codecpar), "no parameters");
    check(avcodec_open2(decoder, codec, nullptr), "no decoder");
    DecodedFilm film;
    film.codec = avcodec_get_name(stream.codecpar->codec_id);
    film.width_px = decoder->width;
    film.height_px = decoder->height;
    film.index_first = index_is_first(path);
    if (const AVDictionaryEntry* const entry =
            av_dict_get(format->metadata, "comment", nullptr, AV_DICT_MATCH_CASE))
        film.comment = entry->value;
    else if (const AVDictionaryEntry* const upper =
                 av_dict_get(format->metadata, "COMMENT", nullptr, 0))
        film.comment = upper->value;
    AVPacket* packet = av_packet_alloc();
    AVFrame* frame = av_frame_alloc();
    const auto take = [&] {
        while (avcodec_receive_frame(decoder, frame) >= 0) {
            film.pixels = text(av_get_pix_fmt_name(static_cast<AVPixelFormat>(frame->format)));
            film.matrix = text(av_color_space_name(frame->colorspace));
            film.range = text(av_color_range_name(frame->color_range));
            film.times_s.push_back(static_cast<double>(frame->best_effort_timestamp) *
                                   av_q2d(stream.time_base));
            film.duration_s = film.times_s.back() +
                              static_cast<double>(frame->pkt_duration) * av_q2d(stream.time_base);
            if (keep(film.times_s.size() - 1)) film.frames.push_back(rgb_of(*frame));
        }
    };
    while (av_read_frame(format, packet) >= 0) {
        if (packet->stream_index == index) {
            check(avcodec_send_packet(decoder, packet), "a packet that cannot be decoded");
            take();
        }
        av_packet_unref(packet);
    }
    avcodec_send_packet(decoder, nullptr);
    take();
    av_frame_free(&frame);
    av_packet_free(&packet);
    avcodec_free_context(&decoder);
    avformat_close_input(&format);
    return film;
}

}  // namespace relevo::test
