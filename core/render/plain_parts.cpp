#include "render/plain_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "render/pass_context.h"

// A stencil was rejected: it would take a target of its own, and draws of the ground by kind.
namespace relevo::render {
namespace {

/// Of skirts, and of shores that blend over a pixel.
constexpr double kBeside_px = 4;

/// Posts from water to ground that may show some, for a post that a pixel is wide: lib/water.glsl
/// reads a level whose nodes are up to sqrt(2) pixels apart, between two of them, each a mean that
/// reaches to the next ones.
constexpr double kWaterReach = 3 * 1.42;

/// Marks what shows a box. @param to_clip  from the local frame
void mark(PictureParts& parts, const Box& box, const glm::dmat4& to_clip, const glm::dvec2& size) {
    constexpr double kLeastDepth_m = 0.1;  // nearer ground is not drawn
    std::array<glm::dvec4, 8> corners;
    for (unsigned i = 0; i < 8; ++i)
        corners[i] =
            to_clip * glm::dvec4((i & 1 ? box.high : box.low).x, (i & 2 ? box.high : box.low).y,
                                 (i & 4 ? box.high : box.low).z, 1);
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
    const auto add = [&](const glm::dvec4& clip) {
        const glm::dvec2 at = (0.5 * glm::dvec2(clip) / clip.w + 0.5) * size;
        low = glm::min(low, at);
        high = glm::max(high, at);
    };
    for (unsigned i = 0; i < 8; ++i) {
        const double here = corners[i].w - kLeastDepth_m;
        if (here >= 0) add(corners[i]);
        // Where edges of the box leave what is before the eye.
        for (const unsigned axis : {1U, 2U, 4U}) {
            const double there = corners[i ^ axis].w - kLeastDepth_m;
            if (here < 0 && there > 0)
                add(mix(corners[i], corners[i ^ axis], here / (here - there)));
        }
    }
    if (low.x <= high.x) parts.mark(low - kBeside_px, high + kBeside_px);
}

/// What a step to the next pixel is at a metre from the eye, at least and at most [m].
struct PixelStep {
    double least, most;
};

PixelStep pixel_step(const FrameBlock& block, const glm::dvec2& size) {
    const glm::dvec3 first(block.pixel_ray), x(block.pixel_ray_dx), y(block.pixel_ray_dy);
    double longest = 0;
    for (const glm::dvec3& ray :
         {first, first + size.x * x, first + size.y * y, first + size.x * x + size.y * y})
        longest = std::max(longest, length(ray));
    const auto [shorter, longer] = std::minmax({length(x), length(y)});
    return {shorter / longest, longer};
}

}  // namespace

PictureParts parts_of_ground(PassContext& frame) {
    PictureParts parts(frame.width_px, frame.height_px);
    const FrameInputs& inputs = frame.inputs;
    const bool floods =
        std::ranges::any_of(inputs.displacement.to_m, [](double level_m) { return level_m != 0; });
    if (inputs.camera.map || floods) {
        parts.mark_all();
        return parts;
    }
    const glm::dvec2 size(frame.width_px, frame.height_px);
    const PixelStep step = pixel_step(frame.block, size);
    const double spacing_m = frame.terrain.normal_spacing_m();
    const DetailedGround detailed{
        .eye_m = inputs.camera.eye_m,
        .exaggeration = inputs.exaggeration,
        // Of a pixel's two sides the one up a wall counts less where heights are exaggerated.
        .near_m = kNearPixel_m * std::sqrt(std::max(inputs.exaggeration, 1.0)) / step.least,
        .water_posts_per_m = kWaterReach * frame.block.footprint_limit * step.most / spacing_m};
    glm::dmat4 to_clip(frame.block.view_projection);
    to_clip[3] += to_clip * glm::dvec4(-inputs.camera.eye_m, 0);
    for (const Box& box : frame.terrain.boxes(frame.tiles, detailed))
        mark(parts, box, to_clip, size);
    return parts;
}

PictureParts parts_of_sky(PassContext& frame) {
    PictureParts parts(frame.width_px, frame.height_px);
    const FrameBlock& block = frame.block;
    if (block.corona.g > 0 || block.eye_moon_light.a > 0) parts.mark_all();
    const glm::dvec3 to_moon(block.eye_moon);
    const glm::dvec3 ahead = cross(glm::dvec3(block.pixel_ray_dy), glm::dvec3(block.pixel_ray_dx));
    const double solid = length(ahead), cosine = dot(ahead, to_moon) / solid;
    if (block.eye_moon.w == 0 || cosine <= 0) return parts;
    constexpr double kAside = 0.1;  // cosine of directions so far aside that a disc is drawn out
    if (cosine < kAside) {
        parts.mark_all();
        return parts;
    }
    const glm::dvec4 clip = glm::dmat4(block.view_projection) * glm::dvec4(to_moon, 0);
    const glm::dvec2 at =
        (0.5 * glm::dvec2(clip) / clip.w + 0.5) * glm::dvec2(frame.width_px, frame.height_px);
    const double radius_px = block.eye_moon.w / (std::sqrt(solid) * cosine * cosine) + kBeside_px;
    parts.mark(at - radius_px, at + radius_px);
    return parts;
}

}  // namespace relevo::render
