#include "material.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"

namespace relevo::ground {
namespace {

/// Flattened by a factor, so that what is dark stays as dark in proportion and nothing turns
/// negative.
void flatten_by_factor(Field& field) {
    Field flat = field;
    flatten(flat);
    const auto m = static_cast<float>(mean(field));
    for_each_texel(field.width(), [&](int c, int r) {
        const float low = field.at(c, r) - flat.at(c, r);
        field.at(c, r) *= m / std::max(m + low, 0.25f * m);
    });
}

/// Brought to a mean by a factor, with nothing over `limit`.
void scale_to_mean(Field& field, double target, float limit) {
    for (int i = 0; i < 8; ++i) {  // what is cut off at the limit is made up for by the rest
        const auto factor = static_cast<float>(target / mean(field));
        for (float& value : field)
            value = std::clamp(value * factor, 0.0f, limit);
    }
}

}  // namespace

std::vector<std::string> material_names() {
    return {"sand", "grass", "rock", "snow"};
}

Material make_material(const std::string& name, int n) {
    if (name == "sand") return make_sand(n);
    if (name == "grass") return make_grass(n);
    if (name == "rock") return make_rock(n);
    if (name == "snow") return make_snow(n);
    bad_usage(
        fmt::format("make_material: {}: no such ground, expected sand, grass, rock or snow", name));
}

void finish(Material& material) {
    const int n = material.height_m.width();
    flatten(material.height_m);
    const auto middle_m = static_cast<float>(mean(material.height_m));
    for (float& h : material.height_m)
        h -= middle_m;

    for (int channel = 0; channel < 3; ++channel) {
        Field plane(n, n);
        for_each_texel(n,
                       [&](int c, int r) { plane.at(c, r) = material.albedo.at(c, r)[channel]; });
        // Twice: the product of the factor and what it flattens has low waves of its own.
        flatten_by_factor(plane);
        flatten_by_factor(plane);
        constexpr float kWhitest = 0.985f;  // fresh snow in the green (docs/ground-materials.md)
        log::debug(fmt::format("{}: channel {} times {:.2f}", material.name, channel,
                               material.mean_albedo[channel] / mean(plane)));
        scale_to_mean(plane, material.mean_albedo[channel], kWhitest);
        for_each_texel(n,
                       [&](int c, int r) { material.albedo.at(c, r)[channel] = plane.at(c, r); });
    }
    flatten_by_factor(material.gloss);
    for (float& g : material.gloss)
        g = std::clamp(g, 0.0f, 1.0f);
}

float srgb_encoded(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

float srgb_decoded(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float luminance(const glm::vec3& linear) {
    return glm::dot(linear, glm::vec3(0.2126f, 0.7152f, 0.0722f));
}

float smoothstep(float from, float to, float x) {
    const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

}  // namespace relevo::ground
