#include "film/film.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numeric>
#include <utility>

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/paths.h"
#include "base/text.h"
#include "film/encoder.h"

namespace relevo::film {
namespace {

struct Format {
    const char* ending;
    const char* muxer;
    std::vector<std::string> encoders;  ///< the best first
    const char* name;                   ///< of the codec
    bool even_sizes;                    ///< colours are stored for squares of 2 x 2 pixels
    bool loops;                         ///< the file says whether it repeats
    bool has_quality;
    int largest_px;  ///< side
    double max_fps;
};

const std::array<Format, 4>& formats() {
    static const std::array<Format, 4> all{
        Format{
            ".mp4", "mp4", {"libx264", "libopenh264"}, "H.264", true, false, true, 8192, kMaxFps},
        Format{".webm",
               "webm",
               {"libvpx-vp9", "libsvtav1", "libaom-av1"},
               "VP9",
               false,
               false,
               true,
               16384,
               kMaxFps},
        Format{".webp", "webp", {"libwebp_anim"}, "WebP", false, true, true, 16383, kMaxFps},
        // Browsers slow down what has less than 2/100 s a frame.
        Format{".gif", "gif", {"gif"}, "GIF", false, true, false, 16384, 50}};
    return all;
}

const Format* format_of(const std::filesystem::path& path) {
    const std::string ending = lower(path.extension().string());
    const auto* const found =
        std::ranges::find_if(formats(), [&](const Format& f) { return ending == f.ending; });
    return found == formats().end() ? nullptr : found;
}

/// The module, or null with the reason for there being none.
const EncoderModule* load_module(std::string& reason) {
    static const EncoderModule* module = nullptr;
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    if (module) return module;
    const std::filesystem::path path = module_dir() / "film_encoder.so";
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    using Entry = const EncoderModule* (*)();
    const auto entry =
        library ? reinterpret_cast<Entry>(dlsym(library, "relevo_film_encoder")) : nullptr;
    if (!entry) {
        const char* error = dlerror();
        reason = error ? error : path.string();
        return nullptr;
    }
    module = entry();
    return module;
}

const EncoderModule& encoder_module(const std::string& subject) {
    std::string reason;
    if (const EncoderModule* const module = load_module(reason)) return *module;
    failed(fmt::format(
        "film: {}: the module for films cannot be loaded, {}; install FFmpeg's "
        "libraries (libavformat59, libswscale6), or make pictures, as frames/{{n:04}}.png",
        subject, reason));
}

/// "1280x720": the next size with even sides.
std::string even_size(int width_px, int height_px) {
    return fmt::format("{}x{}", width_px + width_px % 2, height_px + height_px % 2);
}

}  // namespace

bool is_film_name(const std::filesystem::path& path) {
    const Format* const format = format_of(path);
    return format && std::string_view(format->muxer) != "webp";
}

void check(const std::filesystem::path& path, int width_px, int height_px,
           const Settings& settings) {
    const Format* const format = format_of(path);
    const std::string name = "film: " + printable(path.string());
    if (!format)
        bad_input(name + ": unknown film format; use mp4 (H.264), webm (VP9), webp or gif");
    if (format->even_sizes && (width_px % 2 != 0 || height_px % 2 != 0))
        bad_input(
            fmt::format("{}: {} needs an even width and height but the size is {}x{}; use "
                        "--size {}, or a webm",
                        name, format->name, width_px, height_px, even_size(width_px, height_px)));
    if (std::max(width_px, height_px) > format->largest_px)
        bad_input(fmt::format("{}: {} has at most {} pixels a side but the size is {}x{}", name,
                              format->name, format->largest_px, width_px, height_px));
    if (settings.fps > format->max_fps)
        bad_input(fmt::format("{}: {} has at most {} frames a second but fps is {}", name,
                              format->name, format->max_fps, settings.fps));
    if (settings.loop && !format->loops)
        bad_input(fmt::format(
            "{}: {} says nothing of loops, the player decides; remove loop, or use webp or gif",
            name, format->name));
    if (settings.quality && !format->has_quality)
        bad_input(fmt::format("{}: {} has no quality; remove it", name, format->name));
}

Rate rate_of(double fps) {
    for (const int whole : {24, 30, 60, 120})
        if (std::abs(fps - whole * 1000.0 / 1001.0) < 0.005) return {whole * 1000, 1001};
    const int thousandths = static_cast<int>(std::lround(fps * 1000));
    const int common = std::gcd(thousandths, 1000);
    return {thousandths / common, 1000 / common};
}

Film::Film(OutputFile file, int width_px, int height_px, const Settings& settings,
           const std::string& comment)
    : file_(std::move(file)), width_px_(width_px), height_px_(height_px) {
    check(file_.path(), width_px, height_px, settings);
    const Format& format = *format_of(file_.path());
    const EncoderModule& module = encoder_module(printable(file_.path().string()));
    if (std::ranges::none_of(format.encoders, module.has_encoder))
        fail(
            fmt::format("this FFmpeg ({}) has none of the encoders {}; use another ending: mp4, "
                        "webm, webp or gif",
                        module.version(), fmt::join(format.encoders, ", ")));
    std::string reason;
    encoder_.reset(module.open({.descriptor = file_.descriptor(),
                                .muxer = format.muxer,
                                .encoders = format.encoders,
                                .width_px = width_px,
                                .height_px = height_px,
                                .rate = rate_of(settings.fps),
                                .quality = settings.quality.value_or(kDefaultQuality),
                                .loop = settings.loop.value_or(true),
                                .comment = comment},
                               reason));
    if (!encoder_) fail(reason);
}

Film::~Film() = default;

void Film::fail(const std::string& reason) const {
    failed(fmt::format("film: {}: {}", printable(file_.path().string()), reason));
}

void Film::add(const image::Image8& frame) {
    if (frame.width != width_px_ || frame.height != height_px_)
        fail(fmt::format("expected frames of {}x{} but got {}x{}", width_px_, height_px_,
                         frame.width, frame.height));
    if (const std::string reason = encoder_->add(frame); !reason.empty())
        fail(fmt::format("frame {}: {}", frames_ + 1, reason));
    ++frames_;
}

void Film::finish() {
    if (frames_ == 0) fail("a film needs a frame");
    if (const std::string reason = encoder_->finish(); !reason.empty()) fail(reason);
    encoder_.reset();
    file_.finish();
}

std::string installed_text() {
    std::string reason;
    const EncoderModule* const module = load_module(reason);
    if (!module) return "none, " + reason;
    std::string text = module->version();
    for (const Format& format : formats()) {
        const auto used = std::ranges::find_if(format.encoders, module->has_encoder);
        text += fmt::format(", {} {}", format.ending + 1,
                            used == format.encoders.end() ? "no encoder" : *used);
    }
    return text;
}

}  // namespace relevo::film
