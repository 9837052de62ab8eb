#include "render/air_textures.h"

#include <algorithm>
#include <span>

#include <glm/geometric.hpp>

#include "sky/eye_tables.h"
#include "sky/shipped.h"
#include "sun/daylight.h"

namespace relevo::render {
namespace {

using sky::EyeLayout;

constexpr gl::Extent kSky{EyeLayout::kAzimuths, EyeLayout::kAbove + EyeLayout::kBelow,
                          EyeLayout::kLayers};
constexpr gl::Extent kBetween{EyeLayout::kBetweenAzimuths, EyeLayout::kBetweenElevations,
                              EyeLayout::kDistances};

constexpr const char* kAerosol = "air.aerosol";
constexpr const char* kOzone = "air.ozone";
constexpr const char* kAlbedo = "air.albedo";

shader::Param number(const char* address, double initial, shader::ParamRange range) {
    shader::Param param;
    param.address = address;
    param.name = address;
    std::ranges::replace(param.name, '.', '_');
    param.initial[0] = initial;
    param.range = range;
    return param;
}

/// Adds the mean over all azimuths of one table to another: moonlight scattered by the air differs
/// little with the azimuth, but for the aureole, which sky.glsl draws.
/// @param azimuths  texels from one elevation to the next  @param count  texels
void add_mean(std::span<const glm::vec4> from, int azimuths, std::size_t count,
              const glm::vec3& factor, std::span<glm::vec4> to) {
    const auto width = static_cast<std::size_t>(azimuths);
    for (std::size_t row = 0; row < count; row += width) {
        glm::vec3 sum(0);
        for (std::size_t i = 0; i < width; ++i)
            sum += glm::vec3(from[row + i]);
        for (std::size_t i = 0; i < width; ++i)
            to[row + i] += glm::vec4(factor * sum / static_cast<float>(width), 0);
    }
}

sky::EyeTables tables_of(const sky::Air& air, double height_m, const AirLight& light) {
    const auto atmosphere = sky::atmosphere_of(air);
    sky::EyeTables tables = eye_tables(*atmosphere, height_m, light.sun_sine);
    const auto share = static_cast<float>(light.sun_share);
    if (share < 1)
        for (std::vector<glm::vec4>* const table : {&tables.sky, &tables.between})
            for (glm::vec4& texel : *table)
                texel = glm::vec4(share * glm::vec3(texel), texel.a);
    if (light.moon == glm::vec3(0)) return tables;
    const sky::EyeTables moonlit = eye_tables(*atmosphere, height_m, light.moon_sine);
    const auto layer = static_cast<std::size_t>(EyeLayout::kAzimuths) *
                       static_cast<std::size_t>(EyeLayout::kAbove + EyeLayout::kBelow);
    const std::span<const glm::vec4> from(moonlit.sky);
    const std::span<glm::vec4> to(tables.sky);
    for (const std::size_t first : {std::size_t{0}, 2 * layer})  // air and ground
        add_mean(from.subspan(first, layer), EyeLayout::kAzimuths, layer, light.moon,
                 to.subspan(first, layer));
    add_mean(moonlit.between, EyeLayout::kBetweenAzimuths, moonlit.between.size(), light.moon,
             tables.between);
    return tables;
}

}  // namespace

std::vector<shader::Param> air_params() {
    const sky::Air clean;
    shader::Param aerosol = number(kAerosol, clean.angstrom_beta, {0, 0.5});
    aerosol.label = "Aerosol";
    aerosol.description =
        "Optical depth of the aerosol at a wavelength of 1 um: 0.04 in clean air, 0.2 in turbid";
    shader::Param ozone = number(kOzone, clean.ozone_du, {0, 600});
    ozone.unit = "DU";
    ozone.label = "Ozone";
    ozone.description = "Column of ozone, which makes the dusk blue";
    shader::Param albedo = number(kAlbedo, clean.ground_albedo, {0, 1});
    albedo.label = "Albedo below the air";
    albedo.description =
        "Albedo of the Earth's ground, whose light the air scatters: 0.8 over snow";
    return {aerosol, ozone, albedo};
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

AirLight air_light(const FrameInputs& inputs, const glm::dvec3& eye_up) {
    AirLight light{.sun_sine = dot(inputs.sun.direction, eye_up),
                   .sun_share = sun::eclipsed_sky(inputs.sun_visible)};
    if (inputs.moonlight) {
        light.moon_sine = dot(inputs.moonlight->direction, eye_up);
        light.moon = glm::vec3(inputs.moonlight->strength);
    }
    return light;
}

void AirTextures::update(const sky::Air& air, const AirLight& light, FrameBlock& block) {
    const Of wanted{air, std::max(block.eye_m.w, 0.0f), light};
    if (of_ != wanted) {
        const sky::EyeTables tables = tables_of(air, wanted.height_m, light);
        if (!of_) {
            sky_ =
                gl::Texture(gl::TextureKind::D2Array, gl::Format::RGBA32F, kSky, 1, kAirSkyTexture);
            between_ = gl::Texture(gl::TextureKind::D3, gl::Format::RGBA32F, kBetween, 1,
                                   kAirBetweenTexture);
            for (gl::Texture* const texture : {&sky_, &between_})
                texture->set_sampling(gl::Filter::Linear, gl::Wrap::Clamp);
        }
        sky_.write(0, {0, 0, 0}, kSky, std::as_bytes(std::span(tables.sky)));
        between_.write(0, {0, 0, 0}, kBetween, std::as_bytes(std::span(tables.between)));
        const EyeLayout& layout = tables.layout;
        const double h = layout.height_m, top = sky::kTopOfAir_m;
        mapping_ = glm::vec4(layout.above_band, layout.below_band, layout.farthest_m,
                             sky::white_extinction(air));
        colour_ = glm::vec4(tables.colour, (h - top) * (2 * sky::kEarthRadius_m + h + top));
        of_ = wanted;
    }
    block.air_mapping = mapping_;
    block.air_colour = colour_;
}

const gl::Texture* AirTextures::texture(std::string_view name) const {
    if (!of_) return nullptr;
    if (name == kAirSkyTexture) return &sky_;
    if (name == kAirBetweenTexture) return &between_;
    return nullptr;
}

}  // namespace relevo::render
