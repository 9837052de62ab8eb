#include "render/light_by_height.h"

#include <span>
#include <utility>

#include "base/parallel_for.h"
#include "render/height_light.h"

namespace relevo::render {

/// What the texture was computed of.
struct LightByHeight::Of {
    std::shared_ptr<const sky::Atmosphere> atmosphere;
    glm::vec2 heights, domain;
    double height_m, visible;
    glm::dvec2 refraction_rad;
    glm::dvec3 sun, strength, moon, moon_strength;
    bool operator==(const Of&) const = default;

    static Of of(const FrameInputs& inputs, const FrameBlock& block) {
        const SunLight& sun = inputs.sun;
        Of of{.atmosphere = inputs.atmosphere,
              .heights = block.height_range,
              .domain = block.sun_light_domain,
              .height_m = sun.ground_height_m,
              .visible = inputs.sun_visible,
              .refraction_rad = glm::dvec2(0),
              .sun = sun.direction,
              .strength = sun.strength,
              .moon = glm::dvec3(0),
              .moon_strength = glm::dvec3(0)};
        if (sun.refraction_rad)
            of.refraction_rad = {sun.refraction_rad(0), sun.refraction_rad(0.1)};
        if (inputs.moonlight) {
            of.moon = inputs.moonlight->direction;
            of.moon_strength = inputs.moonlight->strength;
        }
        return of;
    }
};

std::vector<glm::vec4> LightByHeight::texels(const FrameInputs& inputs, const FrameBlock& block) {
    const SunLight& light = inputs.direct_light();
    const double lowest_m = block.height_range.x, rise_m = 1 / block.height_range.y;
    constexpr std::size_t kLayer = std::size_t{kSines} * kHeights;
    std::vector<glm::vec4> texels(kLayers * kLayer);
    parallel_for(0, 2 * kHeights, 2, [&](int first, int last) {
        for (int i = first; i < last; ++i) {
            const bool aloft = i >= kHeights;
            const int row = i % kHeights;
            const double share = row / (kHeights - 1.0),
                         height_m = aloft ? share * kAloft_m : lowest_m + share * rise_m;
            const HeightLight here(inputs, inputs.atmosphere ? height_m : light.ground_height_m);
            for (int column = 0; column < kSines; ++column) {
                const double entry = (SunLightTable::kEntries - 1.0) * column / (kSines - 1.0);
                const double sine =
                    sun_light_sine(block.sun_light_domain.x + entry / block.sun_light_domain.y);
                const auto at =
                    (aloft ? 2 * kLayer : 0) + static_cast<std::size_t>(row * kSines + column);
                texels[at] = glm::vec4(here.direct(light, sine), 0);
                if (!aloft) texels[kLayer + at] = glm::vec4(here.sky(sine), 0);
            }
        }
    });
    return texels;
}

void LightByHeight::update(const FrameInputs& inputs, FrameBlock& block) {
    block.light_heights = {block.height_range.x, block.height_range.y, 0, 0};
    auto wanted = std::make_shared<const Of>(Of::of(inputs, block));
    if (of_ && *of_ == *wanted) return;
    constexpr gl::Extent kSize{kSines, kHeights, kLayers};
    if (!of_) {
        texture_ = gl::Texture(gl::TextureKind::D2Array, gl::Format::RGBA32F, kSize, 1,
                               kLightByHeightTexture);
        texture_.set_sampling(gl::Filter::Linear, gl::Wrap::Clamp);
    }
    const std::vector<glm::vec4> light = texels(inputs, block);
    texture_.write(0, {0, 0, 0}, kSize, std::as_bytes(std::span(light)));
    of_ = std::move(wanted);
}

const gl::Texture* LightByHeight::texture(std::string_view name) const {
    return of_ && name == kLightByHeightTexture ? &texture_ : nullptr;
}

}  // namespace relevo::render
