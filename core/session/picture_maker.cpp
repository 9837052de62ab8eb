#include "session/picture_maker.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/error.h"
#include "session/annotations.h"
#include "session/image_parts.h"
#include "session/sample_sum.h"
#include "session/stamps.h"

namespace relevo::session {
namespace {

/// Fewest samples of transparent pictures, whose edges have as many steps of alpha.
constexpr int kTransparentSamples = 8;
/// With this many samples frames need no smoothing of their own.
constexpr int kEnoughSamples = 4;

/// Cuts an image of a tile's frame to the tile.
template <typename Pixels>
Pixels cropped(const Pixels& frame, const PictureTile& tile) {
    if (tile.rect == tile.frame) return frame;
    const glm::ivec2 from = tile.rect.corner - tile.frame.corner;
    return cut_out(frame, {from.x, tile.frame.size.y - from.y - tile.rect.size.y}, tile.rect.size);
}

/// Puts a picture of the same kind into a larger one, which is made at the first call.
void put(const image::Picture& part, const glm::ivec2& size, int x, int y, image::Picture& whole) {
    std::visit(
        [&](const auto& pixels) {
            using Pixels = std::decay_t<decltype(pixels)>;
            const auto* const there = std::get_if<Pixels>(&whole.pixels);
            if (!there || there->values.empty())
                whole.pixels = Pixels(size.x, size.y, pixels.channels);
            session::put(pixels, glm::ivec2(x, y), std::get<Pixels>(whole.pixels));
        },
        part.pixels);
}

/// Side of tiles for frames of so many pixels.
int side_of(double pixels, int max_side_px) {
    const int most = std::min(static_cast<int>(std::sqrt(pixels)), max_side_px) - 2 * kMargin_px;
    return std::max(most / kTileStep_px, 1) * kTileStep_px;
}

/// Pixels of the largest picture that is drawn as one frame.
double largest_frame_px(const scene::Scene& scene, const PictureFormat& format) {
    return scene.ortho ? std::min(format.frame_px, kMapFrame_px) : format.frame_px;
}

bool fits(const scene::Scene& scene, const PictureFormat& format, int max_side_px) {
    return std::max(scene.width_px, scene.height_px) <= max_side_px &&
           double{1} * scene.width_px * scene.height_px <= largest_frame_px(scene, format);
}

[[noreturn]] void refuse_in_bands(const scene::Scene& scene, const std::string& what) {
    bad_input(
        fmt::format("capture: a picture of {} x {} px is written in bands, without {}; use a "
                    "smaller --size",
                    scene.width_px, scene.height_px, what));
}

}  // namespace

RendererNeeds needs_of(const scene::Scene& scene, const PictureFormat& format) {
    const int samples = samples_of(scene);
    const bool mixed = scene.view.panorama != scene::Panorama::None ||
                       scene.view.stereo == scene::Stereo::Anaglyph;
    return {.deep = samples > 1 || format.bits > 8 || mixed,
            .antialias = samples < kEnoughSamples,
            .data = !format.layers.empty(),
            .albedo = contains(format.layers, DataLayer::Albedo),
            .orthographic = scene.ortho};
}

int samples_of(const scene::Scene& scene) {
    return scene.transparent ? std::max(scene.samples, kTransparentSamples) : scene.samples;
}

glm::ivec2 frame_px(const scene::Scene& scene, const PictureFormat& format, int max_side_px) {
    const glm::ivec2 picture(scene.width_px, scene.height_px);
    if (fits(scene, format, max_side_px)) return picture;
    return glm::min(picture,
                    glm::ivec2(side_of(std::min(format.frame_px, kTileFrame_px), max_side_px) +
                               2 * kMargin_px));
}

bool needs_bands(const scene::Scene& scene, const PictureFormat& format, bool linear) {
    const double bytes = linear ? 4 : format.bits / 8;
    const int channels = scene.transparent ? 4 : 3;
    return bytes * channels * scene.width_px * scene.height_px > kMaxPictureBytes;
}

void check_in_bands(const scene::Scene& scene, bool linear) {
    const auto refuse_view = [](const char* option) {
        bad_input(fmt::format("{}: takes more than 1 GiB; use a smaller --size", option));
    };
    if (scene.view.panorama != scene::Panorama::None) refuse_view("--panorama");
    if (scene.view.stereo != scene::Stereo::None) refuse_view("--stereo");
    if (linear) refuse_in_bands(scene, "linear light");
    scene::Stamps stamps = scene.stamps;
    stamps.legend = false;
    if (stamps != scene::Stamps{.legend = false}) refuse_in_bands(scene, "stamps");
}

PictureMaker::PictureMaker(Session::Impl& impl)
    : impl_(impl),
      scene_(impl.state.scene),
      format_(*impl.options.format),
      linear_(impl.options.radiance),
      picture_px_(scene_.width_px, scene_.height_px) {
    if (scene_.ortho && std::ranges::find(format_.layers, DataLayer::Depth) != format_.layers.end())
        bad_input("--layers: depth: a map of --ortho has no eye to measure from; name the others");
    const int max_side_px = impl.context->info().max_picture_size;
    const bool other =
        scene_.view.panorama != scene::Panorama::None || scene_.view.stereo != scene::Stereo::None;
    if (other || fits(scene_, format_, max_side_px)) {
        const PictureRect all{{0, 0}, picture_px_};
        tiles_ = {{all, all}};
        return;
    }
    const int side_px = side_of(std::min(format_.frame_px, kTileFrame_px), max_side_px);
    tiles_ = tiles_of(picture_px_, side_px, kMargin_px);
    expected_ = tiles_.size();
    refuse_in_tiles();
}

void PictureMaker::draw_frame(const PictureTile& tile, const glm::dvec2& offset_px) {
    const double all = static_cast<double>(expected_) * samples_of(scene_);
    if (impl_.options.on_frame)
        impl_.options.on_frame(std::min(1.0, static_cast<double>(drawn_++) / all));
    impl_.drawn->resize(tile.frame.size.x, tile.frame.size.y);
    impl_.part.reset();
    if (frame_)
        impl_.part = render::PicturePart{
            frame_->picture_px, glm::dvec2(tile.frame.corner) + frame_->moved_px + offset_px,
            frame_->of_panorama};
    else if (is_tiled() || offset_px != glm::dvec2(0))
        impl_.part = render::PicturePart{picture_px_, glm::dvec2(tile.frame.corner) + offset_px};
    impl_.draw(render::Loading::Wait, std::exchange(times_, nullptr));
}

std::vector<float> PictureMaker::depths_of(const PictureTile& tile) const {
    std::vector<float> bottom_up;
    impl_.drawn->renderer().read_depths(bottom_up);
    image::ImageF frame(tile.frame.size.x, tile.frame.size.y, 1);
    for (int y = 0; y < frame.height; ++y)
        std::copy_n(bottom_up.data() + std::ptrdiff_t{frame.height - 1 - y} * frame.width,
                    frame.width, frame.row(y));
    return cropped(frame, tile).values;
}

void PictureMaker::take_depths(const PictureTile& tile, const std::vector<float>& depths_m) {
    shows_ground_ = shows_ground_ || std::ranges::any_of(depths_m, [](float depth_m) {
                        return std::isfinite(depth_m);
                    });
    if (!keeps_depths_) return;
    if (frame_) {
        depths_m_ = depths_m;
        return;
    }
    depths_m_.resize(static_cast<std::size_t>(picture_px_.x) *
                     static_cast<std::size_t>(picture_px_.y));
    const PictureRect& rect = tile.rect;
    for (int y = 0; y < rect.size.y; ++y)
        std::copy_n(
            depths_m.data() + std::ptrdiff_t{rect.size.y - 1 - y} * rect.size.x, rect.size.x,
            depths_m_.data() + std::ptrdiff_t{rect.corner.y + y} * picture_px_.x + rect.corner.x);
}

void PictureMaker::add_layers(const PictureTile& tile, image::Picture& picture) {
    if (format_.layers.empty()) return;
    assert(!is_tiled());
    const render::PixelData data = impl_.drawn->renderer().read_data();
    const LayerView view{impl_.state.inputs.camera, picture_px_, tile.rect.corner, tile.rect.size};
    picture.layers =
        channels_of(format_.layers, data, view, *impl_.state.dem(), impl_.state.ground().frame);
}

image::ImageF PictureMaker::radiance(const PictureTile& tile) {
    const auto read = [](const render::Renderer& r, int* count) { return r.read_radiance(count); };
    return cropped(impl_.read(read, 0.0F), tile);
}

image::Image16 PictureMaker::colours16(const PictureTile& tile) {
    const auto read = [](const render::Renderer& r, int* count) { return r.read_output16(count); };
    return cropped(impl_.read(read, std::uint16_t{65535}), tile);
}

image::Image8 PictureMaker::colours8(const PictureTile& tile) {
    const auto read = [](const render::Renderer& r, int* count) { return r.read_output(count); };
    return cropped(impl_.read(read, std::uint8_t{255}), tile);
}

image::Picture PictureMaker::draw_once(const PictureTile& tile) {
    draw_frame(tile, glm::dvec2(0));
    image::Picture picture;
    if (linear_)
        picture.pixels = radiance(tile);
    else if (needs_of(scene_, format_).deep)
        picture.pixels = colours16(tile);
    else
        picture.pixels = colours8(tile);
    take_depths(tile, depths_of(tile));
    add_layers(tile, picture);
    return picture;
}

image::Picture PictureMaker::draw_samples(const PictureTile& tile) {
    SampleSum sum(tile.rect.size.x, tile.rect.size.y, scene_.transparent);
    for (const glm::dvec2& offset : sample_offsets(samples_of(scene_))) {
        draw_frame(tile, offset);
        const std::vector<float> depths_m = depths_of(tile);
        if (linear_)
            sum.add(radiance(tile), depths_m);
        else
            sum.add(colours16(tile), depths_m);
        take_depths(tile, depths_m);
    }
    image::Picture picture;
    if (linear_)
        picture.pixels = sum.radiance();
    else
        picture.pixels = sum.colours();
    // Layers are of the middle of pixels.
    if (!format_.layers.empty()) draw_frame(tile, glm::dvec2(0));
    add_layers(tile, picture);
    return picture;
}

image::Picture PictureMaker::draw(const PictureTile& tile) {
    image::Picture picture = samples_of(scene_) == 1 ? draw_once(tile) : draw_samples(tile);
    const auto* const deep = std::get_if<image::Image16>(&picture.pixels);
    if (deep && format_.bits == 8)
        picture.pixels = dithered(*deep, tile.rect.corner.x, tile.rect.corner.y);
    return picture;
}

image::Picture PictureMaker::draw(const Frame& frame) {
    frame_ = frame;
    impl_.state.inputs.camera = frame.camera;
    const PictureTile tile{frame.rect, frame.rect};
    return samples_of(scene_) == 1 ? draw_once(tile) : draw_samples(tile);
}

image::Picture PictureMaker::whole(render::PassTimes* times) {
    times_ = times;
    if (!is_tiled()) return draw(tiles_.front());
    image::Picture picture;
    for (const PictureTile& tile : tiles_)
        put(draw(tile), picture_px_, tile.rect.corner.x,
            picture_px_.y - tile.rect.corner.y - tile.rect.size.y, picture);
    return picture;
}

void PictureMaker::refuse_in_tiles() const {
    const auto refuse = [&](const std::string& what) {
        bad_input(fmt::format("{}: expected a picture of at most {:.0f} pixels but got {} x {}",
                              what, largest_frame_px(scene_, format_), picture_px_.x,
                              picture_px_.y));
    };
    if (!format_.layers.empty()) refuse("--layers");
    if (impl_.drawn->without()) refuse("--ab");
    if (impl_.options.audited) refuse("--audit");
    refuse_whole_frame_effects(
        *impl_.drawn, fmt::format("a picture of at most {:.0f} pixels but got {} x {}",
                                  largest_frame_px(scene_, format_), picture_px_.x, picture_px_.y));
}

void refuse_whole_frame_effects(const DrawnEffects& drawn, const std::string& expected) {
    // What such passes measure is of one frame, and would differ from frame to frame.
    for (const shader::PluginPass& pass : drawn.effects().loaded.selection.passes())
        if (pass.kind == shader::PluginPass::Kind::Compute)
            bad_input(fmt::format("{}, which computes from the whole frame: expected {}",
                                  pass.resource.substr(0, pass.resource.find('.')), expected));
}

void PictureMaker::bands(const std::function<void(const image::Picture&)>& take) {
    check_in_bands(scene_, linear_);
    if (impl_.has_marks()) refuse_in_bands(scene_, "the names of effects");
    image::Picture band;
    for (const PictureTile& tile : tiles_) {
        put(draw(tile), {picture_px_.x, tile.rect.size.y}, tile.rect.corner.x, 0, band);
        if (tile.rect.corner.x + tile.rect.size.x < picture_px_.x) continue;
        take(band);
        band = {};
    }
}

bool Session::Impl::is_annotated(const Session& session) const {
    const bool annotated =
        !options.radiance && (has_marks() || state.scene.stamps != scene::Stamps() ||
                              (state.scene.stamps.legend && !session.legends().empty()));
    constexpr int kMostAnnotated_px = 32767;  // of Cairo
    if (annotated && std::max(state.scene.width_px, state.scene.height_px) > kMostAnnotated_px)
        bad_input(
            fmt::format("stamps, legends and names need sides of at most {} px; add "
                        "--no-legend, or use a smaller --size",
                        kMostAnnotated_px));
    return annotated;
}

void Session::Impl::annotate(image::Picture& picture,
                             const std::function<void(image::Image8&)>& draw) const {
    auto* const plain = std::get_if<image::Image8>(&picture.pixels);
    if (plain && plain->channels == 3) return draw(*plain);
    const auto size = std::visit(
        [](const auto& pixels) { return glm::ivec2(pixels.width, pixels.height); }, picture.pixels);
    const image::Image8 over = drawn_alone(size.x, size.y, draw);
    if (plain)
        lay_over(over, *plain);
    else
        lay_over(over, std::get<image::Image16>(picture.pixels));
}

image::Picture Session::Impl::make_picture(const Session& session, render::PassTimes* times) {
    stamp_notes.clear();
    map_corner_px = {0, 0};
    paper_sheet.reset();
    if (state.scene.view.panorama != scene::Panorama::None) return make_panorama(session, times);
    if (state.scene.view.stereo != scene::Stereo::None) return make_stereo(session, times);
    const bool annotated = is_annotated(session);
    if (state.scene.sheet.is_on() && state.is_map()) return make_sheet(session, times);
    if (annotated && state.scene.stamps.margin) return make_with_margin(session, times);
    PictureMaker maker(*this);
    if (maker.is_tiled() && annotated) maker.keep_depths();
    image::Picture picture = maker.whole(times);
    picture_shows_ground = maker.shows_ground();
    if (!annotated) return picture;
    const std::vector<float>* const depths_m = maker.is_tiled() ? &maker.depths_m() : nullptr;
    annotate(picture, [&](image::Image8& on) {
        std::vector<chart::Rect> taken;
        stamp_notes = add_stamps(session, session.legends(), on, taken, depths_m);
        draw_marks_on(on, taken, depths_m);
    });
    return picture;
}

void Session::Impl::make_bands(const std::function<void(const image::Picture&)>& take,
                               bool has_legends) {
    PictureMaker maker(*this);
    maker.bands(take);
    stamp_notes.clear();
    if (has_legends) stamp_notes.emplace_back("stamp: legend: not drawn on a picture in bands");
    picture_shows_ground = maker.shows_ground();
}

}  // namespace relevo::session
