#include "session/panorama_maker.h"

#include <algorithm>
#include <cmath>

#include <glm/matrix.hpp>

#include "base/error.h"
#include "session/panorama_image.h"
#include "session/picture_maker.h"
#include "session/sample_sum.h"
#include "session/stamps.h"

// The panorama of a session's scene.

namespace relevo::session {
namespace {

/// Enough for interpolation and the smoothing of silhouettes, without effects that read further.
constexpr int kLeastMargin_px = 16;

/// Restores a camera at its end.
class CameraKept {
  public:
    explicit CameraKept(scene::Camera& camera) : camera_(camera), kept_(camera) {}
    ~CameraKept() { camera_ = kept_; }
    CameraKept(const CameraKept&) = delete;
    CameraKept& operator=(const CameraKept&) = delete;

  private:
    scene::Camera& camera_;
    scene::Camera kept_;
};

}  // namespace

glm::dmat3 eye_axes(const geo::LocalFrame& frame, const scene::Camera& camera) {
    const geo::Geodetic eye = frame.to_geodetic(camera.eye_m);
    const geo::Axes axes = frame.axes(eye.lat_rad, eye.lon_rad);
    return {axes.east, axes.north, axes.up};
}

scene::PanoramaMap panorama_map(const scene::Scene& scene, const geo::LocalFrame& frame,
                                const scene::Camera& camera) {
    const glm::dmat3 to_eye = transpose(eye_axes(frame, camera));
    const glm::dvec3 ahead = to_eye * camera.forward;
    // Of a camera that looks straight up or down, the top of its picture is ahead.
    const bool is_steep = std::hypot(ahead.x, ahead.y) < 1e-9;
    const glm::dvec3 level = is_steep ? to_eye * camera.up : ahead;
    return {scene.view,
            {scene.width_px, scene.height_px},
            std::atan2(level.x, level.y),
            std::asin(std::clamp(ahead.z, -1.0, 1.0))};
}

void Session::Impl::check_panorama() const {
    scene::check_panorama(state.scene);
    if (!options.format->layers.empty()) bad_input("--panorama: has no layers, remove --layers");
    if (drawn->without()) bad_input("--panorama: cannot be compared, remove --ab");
    if (options.audited) bad_input("--panorama: cannot be audited, remove --audit");
    if (needs_bands(state.scene, *options.format, options.radiance))
        bad_input("--panorama: takes more than 1 GiB; use a smaller --size");
    refuse_whole_frame_effects(*drawn, "a picture without --panorama");
    if (drawn->renderer().shows_block() &&
        render::is_outside(state.ground(), state.inputs.camera.eye_m, state.scene.exaggeration))
        bad_input(
            "--panorama: the eye is outside of the DEM or far above it, from where the DEM is "
            "drawn as a block; choose another --eye");
}

image::Picture Session::Impl::make_panorama(const Session& session, render::PassTimes* times) {
    check_panorama();
    const scene::Camera camera = state.inputs.camera;
    const glm::dmat3 axes = eye_axes(state.ground().frame, camera);
    const scene::PanoramaMap map = panorama_map(state.scene, state.ground().frame, camera);
    const bool reads_around = !drawn->effects().loaded.selection.passes().empty();
    const bool annotated = is_annotated(session);
    PanoramaImage panorama(map);
    PictureMaker maker(*this);
    maker.time_first_frame(times);
    if (annotated) maker.keep_depths();
    {
        const CameraKept kept(state.inputs.camera);
        for (const PanoramaPart& shown :
             parts_of(map, reads_around ? kMargin_px : kLeastMargin_px, kTileFrame_px,
                      context->info().max_picture_size)) {
            const glm::dmat3 turned = axes * shown.axes;
            panorama.add(shown, maker.panorama_frame(
                                    shown, {camera.eye_m, turned[2], turned[1], shown.fov_y_rad}));
            if (annotated) panorama.add_depths(shown, maker.depths_m());
        }
    }
    picture_shows_ground = maker.shows_ground();
    image::Picture picture = panorama.take();
    const auto* const deep = std::get_if<image::Image16>(&picture.pixels);
    if (deep && options.format->bits == 8) picture.pixels = dithered(*deep, 0, 0);
    stamp_notes.clear();
    if (annotated)
        annotate(picture, [&](image::Image8& on) {
            std::vector<chart::Rect> taken;
            stamp_notes = add_stamps(session, session.legends(), on, taken);
        });
    return picture;
}

}  // namespace relevo::session
