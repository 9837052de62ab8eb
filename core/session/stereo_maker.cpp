#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/stereo.h"
#include "session/picture_maker.h"
#include "session/sample_sum.h"
#include "session/stamps.h"
#include "session/stereo_image.h"

// The stereo pair of a session's scene.

namespace relevo::session {
namespace {

/// Eyes whose frames are moved apart by more than their width have nothing in common.
void check_shift(double shift_px, int width_px) {
    if (shift_px <= width_px) return;
    bad_input(
        fmt::format("--eye-distance: moves the frames by {:.6g} px, more than their width of {} "
                    "px; use a smaller one",
                    shift_px, width_px));
}

}  // namespace

void Session::Impl::check_stereo() const {
    scene::check_stereo(state.scene);
    refuse_with_several_cameras("--stereo");
    const glm::ivec2 size = scene::view_px(state.scene);
    const int max_side_px = context->info().max_picture_size;
    if (std::max(size.x, size.y) > max_side_px || double{1} * size.x * size.y > render::kFrame_px)
        bad_input(
            fmt::format("--stereo: {} x {} px for each eye need more than one frame; use a "
                        "smaller --size",
                        size.x, size.y));
    if (state.scene.transparent && state.scene.view.stereo == scene::Stereo::Anaglyph)
        bad_input("--stereo anaglyph: has no transparency, remove --transparent");
}

image::Picture Session::Impl::make_stereo(const Session& session, render::PassTimes* times) {
    check_stereo();
    const bool annotated = is_annotated(session);
    const scene::View& view = state.scene.view;
    const glm::ivec2 size = scene::view_px(state.scene);
    PictureMaker maker(*this);
    maker.time_first_frame(times);
    maker.keep_depths();
    maker.expect(3);
    image::Picture left, right;
    {
        const CameraKept kept(state.inputs.camera);
        const scene::Camera middle = state.inputs.camera;
        maker.draw({.camera = middle, .picture_px = size, .rect = {{0, 0}, size}});
        const scene::StereoPair pair = scene::stereo_pair(view.eye_distance_m, maker.depths_m());
        const double focal_px = 0.5 * size.y / std::tan(middle.fov_y_rad / 2);
        const double shift_px = pair.shift_px(focal_px);
        check_shift(shift_px, size.x);
        // The picture that levels of detail are for is wide enough for a frame that is moved.
        const int aside_px = static_cast<int>(std::ceil(shift_px));
        const auto draw_eye = [&](double side) {
            scene::Camera camera = middle;
            camera.eye_m += 0.5 * side * pair.eye_distance_m * cross(middle.forward, middle.up);
            return maker.draw({.camera = camera,
                               .picture_px = size + glm::ivec2(2 * aside_px, 0),
                               .rect = {{aside_px, 0}, size},
                               .moved_px = {-side * shift_px, 0}});
        };
        left = draw_eye(-1);
        right = draw_eye(1);
    }
    picture_shows_ground = maker.shows_ground();
    stamp_notes.clear();
    const auto finish = [&](image::Picture& picture) {
        const auto* const deep = std::get_if<image::Image16>(&picture.pixels);
        if (deep && options.format->bits == 8) picture.pixels = dithered(*deep, 0, 0);
        if (!annotated) return;
        annotate(picture, [&](image::Image8& on) {
            std::vector<chart::Rect> taken;
            stamp_notes = add_stamps(session, session.legends(), on, taken);
            if (has_marks()) stamp_notes.emplace_back("names are not drawn on stereo pairs");
        });
    };
    if (view.stereo == scene::Stereo::Anaglyph) {
        image::Picture both = anaglyph(left, right);
        finish(both);
        return both;
    }
    finish(left);
    finish(right);
    return view.stereo == scene::Stereo::Parallel ? side_by_side(left, right)
                                                  : side_by_side(right, left);
}

}  // namespace relevo::session
