#include "preview.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/glm.hpp>
#include <png.h>

#include "base/array2d.h"
#include "base/error.h"
#include "base/parallel_for.h"
#include "base/units.h"
#include "material.h"

namespace relevo::ground {
namespace {

using image::TextureData;
using Picture = Array2d<glm::vec3>;  ///< encoded, row 0 at the bottom

void write_png(const std::filesystem::path& path, const Picture& picture) {
    const auto width = static_cast<std::size_t>(picture.width());
    std::vector<unsigned char> bytes;
    bytes.reserve(3 * picture.size());
    for (int r = picture.height(); r-- > 0;)
        for (std::size_t c = 0; c < width; ++c)
            for (int channel = 0; channel < 3; ++channel) {
                const float v = picture.at(static_cast<int>(c), r)[channel];
                bytes.push_back(
                    static_cast<unsigned char>(std::lround(255 * std::clamp(v, 0.0f, 1.0f))));
            }
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(picture.width());
    png.height = static_cast<png_uint_32>(picture.height());
    png.format = PNG_FORMAT_RGB;
    if (!png_image_write_to_file(&png, path.c_str(), 0, bytes.data(), 0, nullptr))
        failed(fmt::format("write_png: {}: cannot be written, {}", path.string(), png.message));
}

/// One level of a ground in floating point.
struct Level {
    int n = 0;
    Array2d<glm::vec4> albedo_gloss;  ///< linear
    Array2d<glm::vec4> normal_height;
};

Level decoded(const Ground& ground, int l) {
    Level level;
    level.n = ground.albedo->level_width(l);
    level.albedo_gloss = {level.n, level.n};
    level.normal_height = {level.n, level.n};
    const auto albedo = ground.albedo->level(l), normal = ground.normal->level(l);
    for (int r = 0; r < level.n; ++r)
        for (int c = 0; c < level.n; ++c) {
            const auto i = static_cast<std::size_t>(4 * (r * level.n + c));
            const auto unit = [&](std::span<const std::byte> bytes, std::size_t k) {
                return static_cast<float>(std::to_integer<int>(bytes[i + k])) / 255.0f;
            };
            level.albedo_gloss.at(c, r) = {srgb_decoded(unit(albedo, 0)),
                                           srgb_decoded(unit(albedo, 1)),
                                           srgb_decoded(unit(albedo, 2)), unit(albedo, 3)};
            level.normal_height.at(c, r) = {2 * unit(normal, 0) - 1, 2 * unit(normal, 1) - 1,
                                            2 * unit(normal, 2) - 1, unit(normal, 3)};
        }
    return level;
}

struct Texel {
    glm::vec4 albedo_gloss{0}, normal_height{0};
};

/// Bilinear, wrapped; s and t in tiles.
Texel sampled(const Level& level, double s, double t) {
    const double x = s * level.n - 0.5, y = t * level.n - 0.5;
    const auto wrapped = [&](double i) {
        const int k = static_cast<int>(static_cast<long long>(i) % level.n);
        return k < 0 ? k + level.n : k;
    };
    const int c0 = wrapped(std::floor(x)), r0 = wrapped(std::floor(y));
    const int c1 = (c0 + 1) % level.n, r1 = (r0 + 1) % level.n;
    const auto u = static_cast<float>(x - std::floor(x)), v = static_cast<float>(y - std::floor(y));
    const auto mixed = [&](const Array2d<glm::vec4>& f) {
        return glm::mix(glm::mix(f.at(c0, r0), f.at(c1, r0), u),
                        glm::mix(f.at(c0, r1), f.at(c1, r1), u), v);
    };
    return {mixed(level.albedo_gloss), mixed(level.normal_height)};
}

struct Light {
    glm::vec3 to_sun, sun, sky;  ///< direction; irradiance on a plane that faces it
    float exposure;
};

/// A sun in the north-west over a clear sky, exposed so that white level ground is just white.
Light light_at(double elevation_deg, double azimuth_deg = 315) {
    const double e = radians(elevation_deg), a = radians(azimuth_deg);
    Light light;
    light.to_sun = {std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)};
    // Direct beam by Kasten and Young's air mass and an optical depth by colour of a clear day.
    const double mass = 1 / (std::sin(e) + 0.50572 * std::pow(6.07995 + elevation_deg, -1.6364));
    light.sun = {std::exp(-0.12 * mass), std::exp(-0.17 * mass), std::exp(-0.28 * mass)};
    light.sky = glm::vec3(0.045f, 0.065f, 0.105f) * static_cast<float>(0.4 + std::sin(e));
    const glm::vec3 white = light.sun * static_cast<float>(std::sin(e)) + light.sky;
    light.exposure = 0.95f / luminance(white);
    return light;
}

/// Reflectance of a dielectric of index 1.5 that is met head on.
constexpr float kFresnel = 0.04f;

glm::vec3 lit(const Texel& texel, const Light& light, const glm::vec3& to_eye, double shininess) {
    const glm::vec3 n = glm::normalize(glm::vec3(texel.normal_height));
    const glm::vec3 albedo(texel.albedo_gloss);
    const float facing = std::max(0.0f, glm::dot(n, light.to_sun));
    const glm::vec3 mirrored = 2 * glm::dot(n, light.to_sun) * n - light.to_sun;
    const float glint = facing > 0 ? std::pow(std::max(0.0f, glm::dot(mirrored, to_eye)),
                                              static_cast<float>(shininess))
                                   : 0.0f;
    return light.exposure * (albedo * (light.sun * facing + light.sky * (0.5f + 0.5f * n.z)) +
                             light.sun * (kFresnel * 0.5f * (static_cast<float>(shininess) + 2) *
                                          texel.albedo_gloss.a * glint));
}

glm::vec3 encoded(glm::vec3 linear) {
    // The shoulder of a film: what is brighter than white rolls off.
    for (int i = 0; i < 3; ++i) {
        float& v = linear[i];
        if (v > 0.8f) v = 0.8f + 0.2f * (1 - std::exp(-(v - 0.8f) / 0.2f));
        v = srgb_encoded(v);
    }
    return linear;
}

Picture picture(int width, int height, const std::function<glm::vec3(int, int)>& pixel) {
    Picture result(width, height);
    parallel_for(0, height, 8, [&](int first, int last) {
        for (int r = first; r < last; ++r)
            for (int c = 0; c < width; ++c)
                result.at(c, r) = pixel(c, r);
    });
    return result;
}

double number(const TextureData& texture, const char* key) {
    return std::stod(texture.metadata.at(key));
}

/// Ground seen from straight above, `tiles` across `size` pixels.
Picture from_above(const Ground& ground, int size, double tiles, double sun_elevation_deg) {
    const double texels = tiles * ground.albedo->width() / size;
    const int l = std::clamp(static_cast<int>(std::lround(std::log2(texels))), 0,
                             ground.albedo->levels() - 1);
    const Level level = decoded(ground, l);
    const Light light = light_at(sun_elevation_deg);
    const double shininess = number(*ground.albedo, "relevo.shininess");
    return picture(size, size, [&](int c, int r) {
        const Texel texel = sampled(level, (c + 0.5) * tiles / size, (r + 0.5) * tiles / size);
        return encoded(lit(texel, light, {0, 0, 1}, shininess));
    });
}

/// Level ground as a person sees it, with mip levels mixed and up to 16 samples along the
/// footprint.
Picture standing_view(const Ground& ground, int width, int height, double eye_m, double pitch_deg,
                      double sun_elevation_deg) {
    const double tile_m = number(*ground.albedo, "relevo.tile_m");
    const double shininess = number(*ground.albedo, "relevo.shininess");
    std::vector<Level> levels;
    for (int l = 0; l < ground.albedo->levels(); ++l)
        levels.push_back(decoded(ground, l));
    const Light light = light_at(sun_elevation_deg);
    const double half = std::tan(radians(30)), pitch = radians(pitch_deg);
    const auto direction = [&](double c, double r) {
        const double x = (2 * c / width - 1) * half;
        const double y = (2 * r / height - 1) * half * height / width;
        return glm::dvec3(x, std::cos(pitch) - y * std::sin(pitch),
                          std::sin(pitch) + y * std::cos(pitch));
    };
    const auto hit = [&](double c, double r) {
        const glm::dvec3 d = direction(c, r);
        const double distance = eye_m / std::max(1e-6, -d.z);
        return glm::dvec2(0.37 * tile_m + d.x * distance, 0.21 * tile_m + d.y * distance) / tile_m;
    };
    return picture(width, height, [&](int c, int r) {
        const glm::dvec3 d = direction(c + 0.5, r + 0.5);
        if (d.z > -0.004) return encoded({0.45f, 0.6f, 0.8f});
        const glm::dvec2 here = hit(c + 0.5, r + 0.5);
        const glm::dvec2 right = hit(c + 1.5, r + 0.5) - here, up = hit(c + 0.5, r + 1.5) - here;
        const bool up_is_longer = glm::length(up) > glm::length(right);
        const glm::dvec2 longer = up_is_longer ? up : right;
        const double short_side = std::min(glm::length(up), glm::length(right));
        const int taps = std::clamp(
            static_cast<int>(std::ceil(glm::length(longer) / std::max(short_side, 1e-9))), 1, 16);
        const double texels = glm::length(longer) / taps * levels[0].n;
        const double lod = std::clamp(std::log2(std::max(texels, short_side * levels[0].n)), 0.0,
                                      static_cast<double>(levels.size()) - 1.001);
        const auto l = static_cast<std::size_t>(lod);
        const auto f = static_cast<float>(lod - static_cast<double>(l));
        Texel sum;
        for (int i = 0; i < taps; ++i) {
            const glm::dvec2 p = here + longer * ((i + 0.5) / taps - 0.5);
            const Texel a = sampled(levels[l], p.x, p.y), b = sampled(levels[l + 1], p.x, p.y);
            sum.albedo_gloss += glm::mix(a.albedo_gloss, b.albedo_gloss, f);
            sum.normal_height += glm::mix(a.normal_height, b.normal_height, f);
        }
        sum.albedo_gloss /= static_cast<float>(taps);
        return encoded(lit(sum, light, glm::vec3(-glm::normalize(d)), shininess));
    });
}

Picture beside(const std::vector<Picture>& pictures) {
    const int side = pictures[0].width();
    Picture all(side * static_cast<int>(pictures.size()), pictures[0].height());
    for (std::size_t i = 0; i < pictures.size(); ++i)
        for (int r = 0; r < all.height(); ++r)
            for (int c = 0; c < side; ++c)
                all.at(c + side * static_cast<int>(i), r) = pictures[i].at(c, r);
    return all;
}

}  // namespace

void write_previews(const std::filesystem::path& dir, const std::string& name,
                    const TextureData& albedo, const TextureData& normal) {
    const Ground ground{&albedo, &normal};
    const Level level = decoded(ground, 0);
    const auto path = [&](const char* what) { return dir / fmt::format("{}_{}.png", name, what); };
    write_png(path("albedo"), picture(level.n, level.n, [&](int c, int r) {
                  const glm::vec4 v = level.albedo_gloss.at(c, r);
                  return glm::vec3(srgb_encoded(v.r), srgb_encoded(v.g), srgb_encoded(v.b));
              }));
    write_png(path("gloss"), picture(level.n, level.n, [&](int c, int r) {
                  return glm::vec3(level.albedo_gloss.at(c, r).a);
              }));
    write_png(path("normal"), picture(level.n, level.n, [&](int c, int r) {
                  return 0.5f + 0.5f * glm::vec3(level.normal_height.at(c, r));
              }));
    write_png(path("height"), picture(level.n, level.n, [&](int c, int r) {
                  return glm::vec3(level.normal_height.at(c, r).a);
              }));
    write_png(path("high"), from_above(ground, level.n, 1, 60));
    write_png(path("low"), from_above(ground, level.n, 1, 12));
    write_png(path("repeat"), from_above(ground, level.n, 8, 40));
    write_png(path("view"), standing_view(ground, 1280, 720, 1.7, -14, 35));
}

void write_composite(const std::filesystem::path& path, const std::vector<Ground>& grounds,
                     double side_m, double sun_elevation_deg) {
    std::vector<Picture> pictures;
    for (const Ground& ground : grounds)
        pictures.push_back(from_above(ground, 480, side_m / number(*ground.albedo, "relevo.tile_m"),
                                      sun_elevation_deg));
    write_png(path, beside(pictures));
}

void write_volume_preview(const std::filesystem::path& path, const TextureData& volume) {
    const int n = volume.width();
    const auto bytes = volume.level(0);
    std::vector<Picture> pictures;
    for (const int slice : {0, n / 16, n / 2})
        pictures.push_back(picture(4 * n, 4 * n, [&](int c, int r) {
            const int texel = (slice * n + r / 2 % n) * n + c / 2 % n;
            return glm::vec3(
                static_cast<float>(std::to_integer<int>(bytes[static_cast<std::size_t>(texel)])) /
                255);
        }));
    write_png(path, beside(pictures));
}

}  // namespace relevo::ground
