#include "render/air_textures.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>

#include "base/units.h"
#include "sky/shipped.h"
#include "sun/daylight.h"

namespace relevo::render {
namespace {

using sky::EyeLayout;

// A layer more for the moon: as the second one, for the light of the moon.
constexpr gl::Extent kSky{EyeLayout::kAzimuths, EyeLayout::kAbove + EyeLayout::kBelow,
                          EyeLayout::kLayers + 1};
constexpr gl::Extent kBetween{EyeLayout::kBetweenAzimuths, EyeLayout::kBetweenElevations,
                              EyeLayout::kDistances* sky::EyeTables::kOrders};

constexpr const char* kAerosol = "air.aerosol";
constexpr const char* kOzone = "air.ozone";
constexpr const char* kAlbedo = "air.albedo";
constexpr const char* kGround = "air.ground";

shader::Param number(const char* address, double initial, shader::ParamRange range) {
    shader::Param param;
    param.address = address;
    param.name = address;
    std::ranges::replace(param.name, '.', '_');
    param.initial[0] = initial;
    param.range = range;
    return param;
}

/// Adds the mean over all azimuths of one table to another: without the aerosol's phase function,
/// scattered moonlight depends little on the azimuth.
/// @param azimuths  texels from one elevation to the next
void add_mean(std::span<const glm::vec4> from, int azimuths, const glm::vec3& factor,
              std::span<glm::vec4> to) {
    const auto width = static_cast<std::size_t>(azimuths);
    std::vector<float> weights(width);
    const auto azimuth = [&](double i) {
        const double u = std::clamp(i / (azimuths - 1), 0.0, 1.0);
        return std::acos(EyeLayout::azimuth_cos(u)) / kPi;
    };
    for (int i = 0; i < azimuths; ++i)
        weights[static_cast<std::size_t>(i)] =
            static_cast<float>(azimuth(i + 0.5) - azimuth(i - 0.5));
    for (std::size_t row = 0; row < from.size(); row += width) {
        glm::vec3 mean(0);
        for (std::size_t i = 0; i < width; ++i)
            mean += weights[i] * glm::vec3(from[row + i]);
        for (std::size_t i = 0; i < width; ++i)
            to[row + i] += glm::vec4(factor * mean, 0);
    }
}

sky::EyeTables tables_of(const sky::Air& air, const AirView& view) {
    const auto atmosphere = sky::atmosphere_of(air);
    const AirLight& light = view.light;
    const auto lit_by = [&](double sine) {
        return eye_tables(*atmosphere, view.height_m, sine, view.parts);
    };
    sky::EyeTables tables = lit_by(light.sun_sine);
    const std::size_t layer = tables.sky.size() / EyeLayout::kLayers;
    tables.sky.resize((EyeLayout::kLayers + 1) * layer);
    const auto share = static_cast<float>(light.sun_share);
    if (share < 1)
        for (std::vector<glm::vec4>* const table : {&tables.sky, &tables.between})
            for (glm::vec4& texel : *table)
                texel = glm::vec4(share * glm::vec3(texel), texel.a);
    if (light.moon == glm::vec3(0)) return tables;
    const sky::EyeTables moonlit = lit_by(light.moon_sine);
    const auto add_layer = [&](std::size_t from, std::size_t to) {
        add_mean(std::span(moonlit.sky).subspan(from * layer, layer), EyeLayout::kAzimuths,
                 light.moon, std::span(tables.sky).subspan(to * layer, layer));
    };
    add_layer(0, 0);
    add_layer(1, EyeLayout::kLayers);
    add_layer(2, 2);
    add_mean(moonlit.between, EyeLayout::kBetweenAzimuths, light.moon, tables.between);
    return tables;
}

}  // namespace

std::vector<shader::Param> air_params() {
    const sky::Air average;
    shader::Param aerosol = number(kAerosol, average.angstrom_beta, {0, 0.5});
    aerosol.label = "Aerosol";
    aerosol.description =
        "Optical depth of the aerosol at a wavelength of 1 um: 0.04 in clean air, 0.08 on an "
        "average "
        "clear day, 0.2 in turbid air";
    shader::Param ozone = number(kOzone, average.ozone_du, {0, 600});
    ozone.unit = "DU";
    ozone.label = "Ozone";
    ozone.description = "Column of ozone, which makes the dusk blue";
    shader::Param albedo = number(kAlbedo, average.ground_albedo, {0, 1});
    albedo.label = "Albedo below the air";
    albedo.description =
        "Albedo of the Earth's ground, whose light the air scatters: 0.8 over snow";
    shader::Param ground = number(kGround, 1, {});
    ground.type = shader::ParamType::Bool;
    ground.range.reset();
    ground.label = "Light of the ground";
    ground.description =
        "On: sun and sky light the ground through this air, by its height. Off: by formulas for "
        "clean air at one height, as in the paper";
    return {aerosol, ozone, albedo, ground};
}

sky::Air air_of(const shader::ParamStore& values) {
    sky::Air air;
    const auto read = [&](const char* address, double& to) {
        if (values.find(address)) to = values.value(address)[0];
    };
    read(kAerosol, air.angstrom_beta);
    read(kOzone, air.ozone_du);
    read(kAlbedo, air.ground_albedo);
    return air;
}

std::shared_ptr<const sky::Atmosphere> ground_air_of(const shader::ParamStore& values) {
    if (!values.find(kGround) || values.value(kGround)[0] == 0) return nullptr;
    return sky::atmosphere_of(air_of(values));
}

AirLight air_light(const FrameInputs& inputs, const glm::dvec3& eye_up) {
    AirLight light{.sun_sine = dot(inputs.sun.direction, eye_up),
                   .sun_share = sun::eclipsed_sky(inputs.sun_visible)};
    if (inputs.moonlight) {
        light.moon_sine = dot(inputs.moonlight->direction, eye_up);
        light.moon = glm::vec3(inputs.moonlight->strength);
    }
    return light;
}

void AirTextures::update(const sky::Air& air, const AirView& view, SkyBlock& block) {
    const double eye_height_m = std::max(view.height_m, 0.0);
    Of wanted{air, view};
    wanted.view.height_m = sky::nearest_eye_height_m(eye_height_m);
    wanted.view.light.sun_sine = sky::nearest_sun_sine(view.light.sun_sine);
    wanted.view.light.moon_sine = sky::nearest_sun_sine(view.light.moon_sine);
    if (of_ != wanted) {
        const sky::EyeTables tables = tables_of(air, wanted.view);
        if (!of_) {
            sky_ =
                gl::Texture(gl::TextureKind::D2Array, gl::Format::RGBA32F, kSky, 1, kAirSkyTexture);
            between_ = gl::Texture(gl::TextureKind::D3, gl::Format::RGBA32F, kBetween, 1,
                                   kAirBetweenTexture);
            for (gl::Texture* const texture : {&sky_, &between_})
                texture->set_sampling(gl::Filter::Linear, gl::Wrap::Clamp);
        }
        if (view.parts.sky) sky_.write(0, {0, 0, 0}, kSky, std::as_bytes(std::span(tables.sky)));
        if (view.parts.between)
            between_.write(0, {0, 0, 0}, kBetween, std::as_bytes(std::span(tables.between)));
        const EyeLayout& layout = tables.layout;
        mapping_ = glm::vec4(layout.above_band, layout.below_band, layout.farthest_m,
                             sky::white_extinction(air));
        colour_ = tables.colour;
        of_ = wanted;
    }
    constexpr double kTop = sky::kTopOfAir_m;
    const double from_top = (eye_height_m - kTop) * (2 * sky::kEarthRadius_m + eye_height_m + kTop);
    block.air_mapping = mapping_;
    block.air_colour = glm::vec4(colour_, from_top);
}

const gl::Texture* AirTextures::texture(std::string_view name) const {
    if (!of_) return nullptr;
    if (name == kAirSkyTexture) return &sky_;
    if (name == kAirBetweenTexture) return &between_;
    return nullptr;
}

}  // namespace relevo::render
