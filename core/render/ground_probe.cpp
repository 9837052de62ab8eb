#include "render/ground_probe.h"

#include <cmath>
#include <span>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "render/draw_scope.h"

// Rejected: heights of the posts, because triangles between posts are not bilinear; and the vertex
// program repeated on the processor, which cannot run a plugin's `displace`.
namespace relevo::render {
namespace {

/// Half of the pixel's width [m]. Rasterisers round vertices to 1/256 pixel.
constexpr double kHalfPixel_m = 0.5;
/// Margin of the height range against rounding [m].
constexpr double kMargin_m = 1;

}  // namespace

scene::Camera GroundProbe::camera_below(const scene::Camera& camera, const geo::LocalFrame& frame,
                                        double tolerance, double pixel_error) {
    const geo::Geodetic eye = frame.to_geodetic(camera.eye_m);
    const geo::Axes axes = frame.axes(eye.lat_rad, eye.lon_rad);
    constexpr double kNarrow_rad = 1e-3;
    const double fov_y_rad =
        pixel_error > 0 ? 2 * std::atan(tolerance / (2 * pixel_error)) : kNarrow_rad;
    return {camera.eye_m, -axes.up, axes.north, fov_y_rad};
}

void GroundProbe::aim(const FrameInputs& inputs, const Ground& ground, EyeBlock& block) {
    const geo::Geodetic eye = ground.frame.to_geodetic(inputs.camera.eye_m);
    const geo::Axes axes = ground.frame.axes(eye.lat_rad, eye.lon_rad);
    const auto [lowest_m, highest_m] =
        inputs.displacement.range_m(ground.lowest_m, ground.highest_m);
    lowest_m_ = lowest_m * inputs.exaggeration - kMargin_m;
    range_m_ = highest_m * inputs.exaggeration + kMargin_m - lowest_m_;
    glm::dmat4 view(0.0);
    for (int i = 0; i < 3; ++i) {
        view[i][0] = axes.east[i] / kHalfPixel_m;
        view[i][1] = axes.north[i] / kHalfPixel_m;
        view[i][2] = axes.up[i] / range_m_;
    }
    view[3][2] = (eye.height_m - lowest_m_) / range_m_;
    view[3][3] = 1;
    block.view_projection = glm::mat4(view);
}

std::optional<double> GroundProbe::height_m(bool has_voids, const std::function<void()>& draw) {
    if (depth_.name() == 0) {
        depth_ = gl::Texture(gl::TextureKind::D2, gl::Format::Depth32F, {1, 1, 1}, 1, "probe");
        target_ = gl::Framebuffer({}, &depth_, "probe");
    }
    {
        const DrawScope scope(
            target_, {.depth = Depth{"depth", DepthTest::Nearer, /*writes=*/true, /*clear=*/0.0F},
                      .clips_voids = has_voids});
        draw();
    }
    float depth = 0;
    depth_.read(0, std::as_writable_bytes(std::span(&depth, 1)));
    if (depth <= 0) return std::nullopt;
    return lowest_m_ + double{depth} * range_m_;
}

}  // namespace relevo::render
