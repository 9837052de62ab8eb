#include "session/panorama_maker.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
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

void Session::Impl::refuse_with_several_cameras(const std::string& what) const {
    if (!options.format->layers.empty()) bad_input(what + ": has no layers, remove --layers");
    if (drawn->without()) bad_input(what + ": cannot be compared, remove --ab");
    if (options.audited) bad_input(what + ": cannot be audited, remove --audit");
    if (needs_bands(state.scene, *options.format, options.radiance))
        bad_input(what + ": takes more than 1 GiB; use a smaller --size");
}

void Session::Impl::check_panorama() const {
    scene::check_panorama(state.scene);
    refuse_with_several_cameras("--panorama");
    refuse_whole_frame_effects(*drawn, "a picture without --panorama");
    if (drawn->renderer().shows_block() && render::is_outside(state.ground(), state.inputs))
        bad_input(
            "--panorama: the eye is outside of the DEM or far above it, from where the DEM is "
            "drawn as a block; choose another --eye");
}

void Session::Impl::draw_marks_around(image::Image8& picture, std::span<const chart::Rect> taken,
                                      const MarkView::Around& around,
                                      const std::vector<float>& distances_m) {
    std::vector<LoadedMarks> of_files;
    for (const LoadedMarks& list : drawn->marks()) {
        if (list.places)
            of_files.push_back(list);
        else if (list.spec->from.empty())  // a module places them for one frame
            stamp_notes.push_back(
                fmt::format("{}: its {} are not drawn on panoramas", list.plugin, list.spec->name));
    }
    chart::Drawing drawing(picture.width, picture.height);
    draw_marks(marks(of_files, drawn->effects(), drawn->renderer()),
               view_of(state.inputs.camera, around, distances_m),
               {0, 0, drawing.width(), drawing.height()}, taken, drawing);
    chart::paint(drawing, 0, 0, 1, picture);
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
        const std::vector<PanoramaPart> parts =
            parts_of(map, reads_around ? kMargin_px : kLeastMargin_px, kTileFrame_px,
                     context->info().max_picture_size);
        maker.expect(parts.size());
        for (const PanoramaPart& shown : parts) {
            const glm::dmat3 turned = axes * shown.axes;
            const scene::Camera turned_camera{camera.eye_m, turned[2], turned[1], shown.fov_y_rad};
            panorama.add(shown, maker.draw({.camera = turned_camera,
                                            .picture_px = shown.picture_px,
                                            .rect = shown.frame,
                                            .of_panorama = true}));
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
            draw_marks_around(on, taken, {map, axes}, panorama.distances_m());
        });
    return picture;
}

}  // namespace relevo::session
