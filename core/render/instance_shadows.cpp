#include "render/instance_shadows.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <epoxy/gl.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/units.h"

// A texel holds the first crown on a ray from the sun. A ray through two crowns is thus darkened
// once, as in the model of gaps (shaders/lib/crown.glsl). The stored depth is that of the middle
// of the ray's path through the crown: a crown then does not shade its own sunny side, and the
// ground needs no depth bias. One texture has 16 bits of depth and 8 of transmittance.
//
// The ground is not drawn into these maps, and the shadows of the ground do not depend on
// instances. Audits exclude pixels that show instances or their shadows.
namespace relevo::render {
namespace {

constexpr double kFiner = 4;  // sides of neighbouring maps
/// Highest points that devices draw are 255 px; the highest crown may have fewer texels.
constexpr double kMostTexels = 200;
/// A map is drawn again where the eye has moved by more than this share of half its side.
/// With kInstanceMapEdge of shaders/lib/instances.glsl less than 1.
constexpr double kSlack = 0.05;
/// Lowest sun that casts shadows of instances: sine of its elevation.
constexpr double kLowestSine = 0.01;
/// The sun has not moved: its refraction depends a little on the place of the eye [rad].
constexpr double kSameSun = 2e-4;

}  // namespace

InstanceShadows::InstanceShadows(const std::vector<shader::InstanceSet>& sets)
    : sets_([&] {
          std::vector<shader::InstanceSet> casting;
          std::ranges::copy_if(sets, std::back_inserter(casting),
                               &shader::InstanceSet::casts_shadow);
          return casting;
      }()) {}

bool InstanceShadows::is_any_due() const {
    return std::ranges::any_of(due_, [](bool due) { return due; });
}

void InstanceShadows::prepare(const Terrain& terrain, const FrameInputs& inputs,
                              const glm::dvec3& ground_m, double pixel_rad,
                              const shader::ParamStore& values, FrameBlock& block) {
    due_.fill(false);
    const glm::dvec3 sun = glm::dvec3(block.eye_sun), up = glm::dvec3(block.eye_up);
    if (sets_.empty() || dot(sun, up) < kLowestSine) return;
    if (inputs.freeze_native && key_) return write(inputs.camera.eye_m, block);

    Key key{.ground = terrain.serial(),
            .is_complete = terrain.is_complete(),
            .towards_sun = sun,
            .up = inputs.deterministic ? up : glm::dvec3(0),
            .exaggeration = inputs.exaggeration,
            .day = std::floor(inputs.unix_s / kDay_s)};
    double highest_m = 0;
    for (const shader::InstanceSet& set : sets_) {
        key.range_m = std::max(key.range_m, instance_range_m(set, pixel_rad));
        highest_m = std::max(highest_m, set.height_m);
    }
    for (const shader::Param* param : values.params())
        for (const shader::InstanceSet& set : sets_)
            if (param->address.starts_with(set.resource.substr(0, set.resource.find('.') + 1)))
                key.values.push_back(values.value(param->address));
    const double same_sun = inputs.deterministic ? 0 : kSameSun;
    if (key_ && length(key_->towards_sun - sun) <= same_sun) key.towards_sun = key_->towards_sun;
    const bool all = !key_ || *key_ != key;
    if (all) {
        range_m_ = key.range_m;
        axes_[2] = normalize(sun);
        axes_[0] = dot(sun, up) > 0.9999 ? glm::dvec3(1, 0, 0) : cross(up, axes_[2]);
        axes_[0] = normalize(axes_[0] - dot(axes_[0], axes_[2]) * axes_[2]);
        axes_[1] = cross(axes_[2], axes_[0]);
    }
    key_ = key;
    for (int map = 0; map < kMaps; ++map) {
        Map& of = maps_[static_cast<std::size_t>(map)];
        of.half_side_m = std::max(range_m_ * std::pow(kFiner, map - kMaps + 1),
                                  highest_m * kSide_px / (2 * kMostTexels));
        const glm::dvec2 middle_m = across(ground_m);
        const glm::dvec2 off = abs(middle_m - of.centre_m);
        const double moved_m = std::max({off.x, off.y, length(inputs.camera.eye_m - of.eye_m)});
        const bool far = moved_m > kSlack * of.half_side_m;
        if (!all && !far && !(inputs.deterministic && moved_m > 0)) continue;
        const double texel_m = 2 * of.half_side_m / kSide_px;
        of.centre_m = texel_m * round(middle_m / texel_m);
        of.eye_m = inputs.camera.eye_m;
        due_[static_cast<std::size_t>(map)] = true;
    }
    write(inputs.camera.eye_m, block);
}

void InstanceShadows::write(const glm::dvec3& eye_m, SunBlock& block) const {
    block.instance_shadow_px = kSide_px;
    block.instance_shadow_weight = 1;
    for (std::size_t i = 0; i < 3; ++i)
        block.instance_shadow_axes[i] = glm::vec4(axes_[i], 0);
    for (std::size_t i = 0; i < kMaps; ++i) {
        const Map& map = maps_[i];
        block.instance_shadow_maps[i] = glm::vec4(
            across(eye_m) - map.centre_m, dot(axes_[2], eye_m - map.eye_m), 1 / map.half_side_m);
    }
    block.instance_shadow_eye = glm::vec4(maps_.back().eye_m - eye_m, 0);
}

void InstanceShadows::clear_due() const {
    constexpr float kFar = 0;
    // Leaves the scissor as it was.
    const bool was_on = glIsEnabled(GL_SCISSOR_TEST);
    std::array<GLint, 4> before{};
    glGetIntegerv(GL_SCISSOR_BOX, before.data());
    glEnable(GL_SCISSOR_TEST);
    for (int map = 0; map < kMaps; ++map) {
        if (!is_due(map)) continue;
        glScissor(0, map * kSide_px, kSide_px, kSide_px);
        glClearBufferfv(GL_DEPTH, 0, &kFar);
    }
    glScissor(before[0], before[1], before[2], before[3]);
    if (!was_on) glDisable(GL_SCISSOR_TEST);
}

bool InstanceShadows::meets(int map, const Box& box) const {
    const Map& of = maps_[static_cast<std::size_t>(map)];
    const glm::dvec3 middle = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
    const glm::dvec2 off = abs(across(middle) - of.centre_m);
    return off.x <= of.half_side_m + dot(half, abs(axes_[0])) &&
           off.y <= of.half_side_m + dot(half, abs(axes_[1]));
}

}  // namespace relevo::render
