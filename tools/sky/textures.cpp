#include "textures.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <glm/common.hpp>
#include <glm/gtc/packing.hpp>

#include "base/parallel_for.h"
#include "base/units.h"
#include "sky/night.h"

namespace relevo::skymaker {
namespace {

/// The aureole: the part of the aerosol's forward scattering that the paper's glow stands for.
/// @returns phase function [1/sr]
double aureole_phase(double cosine) {
    constexpr double kWidth_rad = radians(45.0);
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    return std::exp(-std::pow(angle / kWidth_rad, 2)) * sky::aerosol_phase(cosine);
}

glm::dvec3 colour(const sky::Values& values) {
    sky::Spectrum spectrum{};
    std::copy(values.begin(), values.end(), spectrum.begin());
    return sky::colour_of(spectrum);
}

/// The sky at one height of the sun, row by row from the horizon.
using Picture = std::vector<glm::dvec3>;
struct Skies {
    Picture bare;   // without the aureole
    Picture whole;  // with it
};

Skies make_skies(const sky::Atmosphere& air, double sun_sine) {
    Skies skies;
    skies.bare.resize(static_cast<std::size_t>(Layout::kAround * Layout::kUp));
    skies.whole = skies.bare;
    std::vector<sky::Sun> suns;
    for (int x = 0; x < Layout::kAround; ++x)
        suns.push_back({sun_sine, 2 * (x / (Layout::kAround - 1.0)) - 1});
    parallel_for(0, Layout::kUp, 1, [&](int first, int last) {
        for (int y = first; y < last; ++y) {
            const double sine = Layout::sine_of(y / (Layout::kUp - 1.0));
            const std::vector<sky::Brought> row = air.brought(0, sine, suns);
            for (std::size_t x = 0; x < suns.size(); ++x) {
                const auto at = static_cast<std::size_t>(y * Layout::kAround) + x;
                const double cosine = sky::ray_sun_cosine(sine, suns[x]),
                             ring = aureole_phase(cosine);
                const glm::dvec3 aerosol = kPi * colour(row[x].aerosol);
                const glm::dvec3 bare =
                    kPi * colour(row[x].air) + (sky::aerosol_phase(cosine) - ring) * aerosol;
                // Interpolated texels must not reach below black where a colour is outside of sRGB.
                skies.bare[at] = glm::max(bare, glm::dvec3(0)) +
                                 sky::night_radiance(0, sine, colour(row[x].through).g);
                skies.whole[at] = skies.bare[at] + glm::max(ring * aerosol, glm::dvec3(0));
            }
        }
    });
    return skies;
}

/// Bilinear, as a sampler reads it.
glm::dvec3 read(const Picture& picture, double s, double t) {
    const double x = std::clamp(s, 0.0, 1.0) * (Layout::kAround - 1),
                 y = std::clamp(t, 0.0, 1.0) * (Layout::kUp - 1);
    const int x0 = std::min(static_cast<int>(x), Layout::kAround - 2),
              y0 = std::min(static_cast<int>(y), Layout::kUp - 2);
    const auto at = [&](int c, int r) {
        return picture[static_cast<std::size_t>(r * Layout::kAround + c)];
    };
    return glm::mix(glm::mix(at(x0, y0), at(x0 + 1, y0), x - x0),
                    glm::mix(at(x0, y0 + 1), at(x0 + 1, y0 + 1), x - x0), y - y0);
}

/// Light of a picture of the sky on a slope. @param normal_up  z of its normal
/// @param normal_cos  of the angle between the normal's azimuth and the sun's
glm::dvec3 slope_irradiance(const Picture& picture, double normal_up, double normal_cos) {
    constexpr int kRows = 48, kColumns = 96;
    const double level = std::sqrt(std::max(0.0, 1 - normal_up * normal_up));
    const double normal_sin = std::sqrt(std::max(0.0, 1 - normal_cos * normal_cos));
    glm::dvec3 sum(0);
    for (int r = 0; r < kRows; ++r) {
        const double t = (r + 0.5) / kRows;
        const double sine = t * t, flat = std::sqrt(1 - sine * sine);
        for (int c = 0; c < kColumns; ++c) {
            const double azimuth = 2 * kPi * (c + 0.5) / kColumns;
            const double facing =
                normal_up * sine +
                level * flat * (normal_cos * std::cos(azimuth) + normal_sin * std::sin(azimuth));
            if (facing <= 0) continue;
            // d(sine) = 2 t dt
            sum += read(picture, 0.5 + 0.5 * std::cos(azimuth), t) * facing * 2.0 * t;
        }
    }
    return sum * (2.0 / (kRows * kColumns));
}

image::TextureData texture(int width, int height, int depth) {
    image::TextureData data(PixelFormat::RGBA16F, width, height, depth, 1, 1);
    data.metadata = {{"KTXorientation", depth > 1 ? "rui" : "ru"}};
    return data;
}

}  // namespace

double Layout::sine_of(double t) {
    constexpr double kEnd = 0.0314;  // sin 1.8 deg
    return std::min(1.0, std::sqrt(t * t * t * t + kEnd * kEnd));
}

double Layout::slice_of(double sun_sine) {
    const auto folded = [](double y) { return y / (kFold + std::abs(y)); };
    const double lowest = folded(std::sin(radians(kLowestSun_deg)));
    return (folded(sun_sine) - lowest) / (folded(1) - lowest);
}

double Layout::sun_sine_of(double slice) {
    const auto folded = [](double y) { return y / (kFold + std::abs(y)); };
    const double lowest = folded(std::sin(radians(kLowestSun_deg)));
    const double x = lowest + slice * (folded(1) - lowest);
    return kFold * x / (1 - std::abs(x));
}

void write_texel(std::span<std::byte> texels, std::size_t index, const glm::dvec4& value) {
    for (std::size_t c = 0; c < 4; ++c) {
        const std::uint16_t half =
            glm::packHalf1x16(static_cast<float>(value[static_cast<glm::length_t>(c)]));
        texels[8 * index + 2 * c] = static_cast<std::byte>(half & 0xff);
        texels[8 * index + 2 * c + 1] = static_cast<std::byte>(half >> 8);
    }
}

double luminance(const glm::dvec3& c) {
    return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
}

glm::dvec3 level_irradiance(const sky::Atmosphere& air, double sun_sine) {
    return slope_irradiance(make_skies(air, sun_sine).whole, 1, 0);
}

image::TextureData light_texture(const sky::Atmosphere& air) {
    constexpr int n = Layout::kNormals;
    image::TextureData made = texture(n, n, Layout::kSuns);
    const std::span<std::byte> light = made.writable_level(0);
    for (int slice = 0; slice < Layout::kSuns; ++slice) {
        const double sun_sine = Layout::sun_sine_of(slice / (Layout::kSuns - 1.0));
        const Skies skies = make_skies(air, sun_sine);
        const glm::dvec3 level = slope_irradiance(skies.whole, 1, 0);
        parallel_for(0, n * n, 1, [&](int first, int last) {
            for (int i = first; i < last; ++i)
                write_texel(light, static_cast<std::size_t>(slice * n * n + i),
                            glm::dvec4(slope_irradiance(skies.whole, i / n / (n - 1.0),
                                                        2 * (i % n) / (n - 1.0) - 1) /
                                           level,
                                       1));
        });
    }
    return made;
}

image::TextureData single_texture(const sky::Atmosphere& air, double sun_sine) {
    image::TextureData data = texture(Layout::kAround, Layout::kUp, 1);
    const Skies skies = make_skies(air, sun_sine);
    const double level = luminance(slope_irradiance(skies.whole, 1, 0));
    std::size_t index = 0;
    for (const glm::dvec3& colour : skies.bare)
        write_texel(data.writable_level(0), index++, glm::dvec4(colour / level, 1));
    return data;
}

}  // namespace relevo::skymaker
