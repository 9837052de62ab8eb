#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/array2d.h"
#include "base/parallel_for.h"
#include "base/units.h"
#include "dem/load.h"
#include "effect/loaded_selection.h"
#include "gl/context.h"
#include "render/ground.h"
#include "render/renderer.h"
#include "support/device.h"
#include "support/support.h"

/// Shadows computed twice: by marching along rays in double precision, and by drawing pictures.
namespace relevo::shadow {

/// Ground as steep as a gorge's out of hills.
inline dem::Heightfield times_as_high(dem::Heightfield dem, double factor) {
    for (float& height : dem.height_m)
        height = static_cast<float>(factor * height);
    dem.about.statistics = dem::statistics(dem.height_m);
    return dem;
}

/// Cast shadows of a sun at every post, from the posts alone.
///
/// The plane through a post that holds the sun's rays and is upright at the DEM's centre cuts the
/// grid's lines, on which heights are linear, in points; the post is in shadow if one of them lies
/// sunward of it and above its ray. No projection and no flat Earth is in this: the posts are
/// placed by the grid and GeographicLib.
class Truth {
  public:
    Truth(const dem::Heightfield& dem, const geo::LocalFrame& frame) : dem_(dem) {
        const int columns = dem.grid.columns(), rows = dem.grid.rows();
        posts_ = Array2d<glm::dvec3>(columns, rows);
        parallel_for(0, rows, 1, [&](int first, int last) {
            for (int y = first; y < last; ++y)
                for (int x = 0; x < columns; ++x)
                    posts_.at(x, y) = frame.to_local(dem.place(x, y));
        });
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x)
                if (!std::isnan(posts_.at(x, y).z))
                    highest_m_ = std::max(highest_m_, posts_.at(x, y).z);
    }

    const Array2d<glm::dvec3>& posts() const { return posts_; }

    /// In the light's space: x across, y up, z towards the sun.
    static glm::dmat3 axes(const glm::dvec3& to_sun) {
        const glm::dvec3 right = normalize(cross(glm::dvec3(0, 0, 1), to_sun));
        return {right, cross(to_sun, right), to_sun};
    }

    struct Mask {
        Array2d<std::uint8_t> shaded;  ///< 1 in cast shadow
        Array2d<std::uint8_t> facing;  ///< 1 where the ground is turned to the sun; 0 on the rim
        Array2d<glm::dvec3> light_m;   ///< the posts in the light's space
    };

    Mask cast(const glm::dvec3& to_sun) const {
        const int columns = posts_.width(), rows = posts_.height();
        const glm::dmat3 to_light = transpose(axes(to_sun));
        Mask mask{Array2d<std::uint8_t>(columns, rows), Array2d<std::uint8_t>(columns, rows),
                  Array2d<glm::dvec3>(columns, rows)};
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x)
                mask.light_m.at(x, y) = to_light * posts_.at(x, y);
        const double rise = axes(to_sun)[1].z, sine = to_sun.z;
        parallel_for(0, rows, 4, [&](int first, int last) {
            for (int y = first; y < last; ++y) {
                for (int x = 0; x < columns; ++x) {
                    mask.shaded.at(x, y) = is_shaded(mask.light_m, glm::dvec2(x, y), rise, sine);
                    mask.facing.at(x, y) = faces(to_sun, x, y);
                }
            }
        });
        return mask;
    }

    /// Whether a point of the ground is in shadow; between posts it is on the drawn grid's
    /// triangles.
    /// @param light  the posts in the light's space
    /// @param at     its column and row
    bool is_shaded(const Array2d<glm::dvec3>& light, const glm::dvec2& at, double rise,
                   double sine) const {
        const glm::ivec2 low(floor(at)), high(ceil(at));
        const glm::dvec2 share = at - glm::dvec2(low);
        const glm::dvec3 a = light.at(low.x, low.y), b = light.at(high.x, high.y);
        const glm::dvec3 from = a + (share.x + share.y) * (b - a);
        if (std::isnan(from.x)) return false;
        return walk<0>(light, low, high, from, rise, sine) ||
               walk<1>(light, low, high, from, rise, sine);
    }

  private:
    bool faces(const glm::dvec3& to_sun, int x, int y) const {
        if (x < 1 || y < 1 || x + 1 >= posts_.width() || y + 1 >= posts_.height()) return false;
        const glm::dvec3 n = cross(posts_.at(x + 1, y) - posts_.at(x - 1, y),
                                   posts_.at(x, y - 1) - posts_.at(x, y + 1));
        return (n.z < 0 ? -1 : 1) * dot(n, to_sun) > 0;
    }

    /// Goes from grid line to grid line of one family (Along 0: column by column) sunward.
    template <int Along>
    bool walk(const Array2d<glm::dvec3>& light, glm::ivec2 low, glm::ivec2 high,
              const glm::dvec3& from, double rise, double sine) const {
        constexpr int Across = 1 - Along;
        const glm::ivec2 size(light.width(), light.height());
        const auto at = [&](int line, int place) -> const glm::dvec3& {
            return Along == 0 ? light.at(line, place) : light.at(place, line);
        };
        for (const int step : {1, -1}) {
            int place = std::min(low[Across], size[Across] - 2);
            const double own = rise * from.z - sine * from.y;  // level, towards the sun
            // From the first line beyond the point.
            for (int line = (step > 0 ? low : high)[Along] + step; line >= 0 && line < size[Along];
                 line += step) {
                // The segment of this line that the plane cuts.
                const bool grows = at(line, size[Across] - 1).x > at(line, 0).x;
                while (place > 0 && (at(line, place).x > from.x) == grows)
                    --place;
                while (place < size[Across] - 2 && (at(line, place + 1).x < from.x) == grows)
                    ++place;
                const glm::dvec3 a = at(line, place), b = at(line, place + 1);
                const double f = (from.x - a.x) / (b.x - a.x);
                if (!(f >= 0 && f <= 1)) break;  // left the DEM, or never meets the plane
                const glm::dvec3 cut = a + f * (b - a);
                const double beyond = rise * cut.z - sine * cut.y - own;
                if (beyond < -1e-6) break;  // away from the sun
                if (std::isnan(cut.y)) continue;
                if (cut.y > from.y && beyond > 1e-6) return true;
                // Where the ray is above all ground there is nothing left to meet.
                if (rise * from.y + sine * cut.z > highest_m_ + 1) break;
            }
        }
        return false;
    }

    const dem::Heightfield& dem_;
    Array2d<glm::dvec3> posts_;
    double highest_m_ = -1e9;
};

/// How much of the sun the program draws at every post, 0 to 1: a picture from high above, two
/// pixels a post, with the shadows and without, read as radiance.
class Drawn {
  public:
    /// @param scratch   a folder that may be written
    /// @param settings  "vsm.bleed=0.1"
    /// @param size      of the pictures [px]; 0: from above, 2 to 8 pixels a post
    /// @param effect    that makes the shadows
    Drawn(const dem::Heightfield& dem, const std::filesystem::path& scratch,
          const std::vector<std::string>& settings = {}, double pixel_error = 2,
          glm::ivec2 size = glm::ivec2(0), const std::string& effect = "vsm")
        : dem_(dem), ground_(render::make_ground(dem)), context_({.device = test::gl_device()}) {
        // A surface that sends the sun's light on as it comes, and none of the sky's.
        std::filesystem::create_directories(scratch / "probe");
        std::ofstream(scratch / "probe/plugin.json")
            << R"({"format": 1, "id": "probe", "name": "Probe", "version": "1"})";
        std::ofstream(scratch / "probe/probe.glsl")
            << "vec3 probe_on_brdf(in Surface s, in vec3 to_sun, in vec3 to_eye) { return "
               "vec3(1.0); }\n"
               "void probe_on_ambient(in Surface s, inout vec3 irradiance) { irradiance = "
               "vec3(0.0); }\n";
        registry_ = effect::Registry::load({test::source_dir() / "plugins" / effect, scratch}, {});
        values_.declare([&] {
            std::vector<shader::Param> params = registry_.params();
            for (const shader::Param& param : render::core_params())
                params.push_back(param);
            return params;
        }());
        for (const std::string& setting : settings) {
            const auto equals = setting.find('=');
            values_.set(setting.substr(0, equals), setting.substr(equals + 1));
        }
        // A post is a corner of the ground: between pixels far apart its light is blurred.
        const double pixels = std::clamp(2600.0 / dem.grid.columns(), 2.0, 8.0);
        size_ = size.x > 0 ? size
                           : glm::ivec2(static_cast<int>(pixels * dem.grid.columns()) + 8,
                                        static_cast<int>(pixels * dem.grid.rows()) + 8);
        terrain_.emplace(
            dem_, ground_.frame,
            render::TerrainOptions{.pixel_error = pixel_error,
                                   .max_array_layers = context_.info().max_array_layers});
        inputs_.camera = scene::orbit_camera({180, 90, 1}, render::points_to_show(dem, ground_, 1),
                                             radians(8), double(size_.x) / size_.y);
        shadowed_ = select({"probe", effect});
        plain_ = select({"probe"});
    }

    const render::Ground& ground() const { return ground_; }
    double spacing_m() const { return terrain_->normal_spacing_m(); }  ///< from post to post
    glm::ivec2 size() const { return size_; }
    render::FrameInputs& inputs() { return inputs_; }
    /// Half the width of the suns to come; 0, a point, at first.
    double& semidiameter_rad() { return semidiameter_rad_; }

    /// For every pixel; NaN where there is no ground or none that faces the sun.
    Array2d<float> picture(const glm::dvec3& to_sun) {
        shine(to_sun);
        const image::ImageF with = draw(shadowed_);
        const image::ImageF without = draw(plain_);
        Array2d<float> lit(size_.x, size_.y);
        for (int y = 0; y < size_.y; ++y)
            for (int x = 0; x < size_.x; ++x)
                lit.at(x, y) = without.at(x, y, 1) > 1e-6f ? with.at(x, y, 1) / without.at(x, y, 1)
                                                           : std::nanf("");
        return lit;
    }

    Array2d<float> at_posts(const glm::dvec3& to_sun, const Array2d<glm::dvec3>& posts) {
        shine(to_sun);
        const image::ImageF with = draw(shadowed_);
        const image::ImageF without = draw(plain_);
        Array2d<float> lit(posts.width(), posts.height());
        spread_ = Array2d<float>(posts.width(), posts.height());
        for (int y = 0; y < posts.height(); ++y) {
            for (int x = 0; x < posts.width(); ++x) {
                lit.at(x, y) = 1;
                spread_.at(x, y) = 2;
                if (std::isnan(posts.at(x, y).z)) continue;
                if (dot(posts.at(x, y) - inputs_.camera.eye_m, inputs_.camera.forward) <= 0)
                    continue;
                // Between the middles of the four pixels around.
                const glm::dvec2 at = project(posts.at(x, y)) - 0.5;
                const glm::ivec2 pixel(floor(at));
                const glm::vec2 share(at - glm::dvec2(pixel));
                if (pixel.x < 0 || pixel.y < 0 || pixel.x + 1 >= size_.x || pixel.y + 1 >= size_.y)
                    continue;
                const auto ratio = [&](int i, int j) {
                    return with.at(pixel.x + i, pixel.y + j, 1) /
                           std::max(without.at(pixel.x + i, pixel.y + j, 1), 1e-6f);
                };
                float least = 1e9f, most = -1e9f;
                const glm::ivec2 first = glm::max(pixel - 1, 0),
                                 last = glm::min(pixel + 2, size_ - 1);
                for (int j = first.y; j <= last.y; ++j)
                    for (int i = first.x; i <= last.x; ++i) {
                        least = std::min(least, ratio(i - pixel.x, j - pixel.y));
                        most = std::max(most, ratio(i - pixel.x, j - pixel.y));
                    }
                spread_.at(x, y) = most - least;
                const float above = ratio(0, 0) + share.x * (ratio(1, 0) - ratio(0, 0));
                const float below = ratio(0, 1) + share.x * (ratio(1, 1) - ratio(0, 1));
                lit.at(x, y) = above + share.y * (below - above);
            }
        }
        return lit;
    }

    /// Has pictures show a part of the DEM from above, with so many pixels a post, so that they
    /// show what is at the posts themselves.
    void watch(const dem::Window& posts, int pixels) {
        std::vector<glm::dvec3> points;
        for (int y = posts.row; y < posts.row + posts.rows; ++y)
            for (int x = posts.column; x < posts.column + posts.columns; ++x)
                if (!std::isnan(dem_.height_m.at(x, y)))
                    points.push_back(ground_.frame.to_local(dem_.place(x, y)));
        size_ = pixels * glm::ivec2(posts.columns, posts.rows);
        inputs_.camera =
            scene::orbit_camera({180, 90, 1}, points, radians(8), double(size_.x) / size_.y);
        for (Chosen* const each : {&shadowed_, &plain_})
            each->renderer->resize(size_.x, size_.y);
    }

    /// Of the last picture: by how much the 16 pixels around each post differ; 2 outside of it.
    const Array2d<float>& spread() const { return spread_; }

    /// Which map of the last picture a point is in: 0 of all that is seen, 1 and 2 nearer ones; and
    /// how far inside the rim of the nearer map that is nearest to it, as a share of its sides,
    /// negative outside. As vsm_place() of vsm.glsl.
    struct Place {
        int map = 0;
        double inside = -1;
    };
    Place place(const glm::dvec3& point) const {
        const auto& values = shadowed_.renderer->values();
        const glm::dvec4 at(point - inputs_.camera.eye_m, 1);
        const auto vector = [&](const char* address) {
            const auto v = values.value(address);
            return glm::dvec4(v[0], v[1], v[2], v[3]);
        };
        const glm::dvec2 first(dot(vector("vsm.across"), at), dot(vector("vsm.along"), at));
        Place result;
        int map = 0;
        for (const char* address : {"vsm.nearer", "vsm.nearest"}) {
            const glm::dvec4 v = vector(address);
            const glm::dvec2 in =
                glm::min(first * glm::dvec2(v.x, v.y) + glm::dvec2(v.z, v.w),
                         1.0 - first * glm::dvec2(v.x, v.y) - glm::dvec2(v.z, v.w)) -
                0.004;
            ++map;
            if (v.x == 0) continue;
            const double inside = std::min(in.x, in.y);
            if (inside >= 0) result.map = map;
            if (std::abs(inside) < std::abs(result.inside)) result.inside = inside;
        }
        return result;
    }

    /// Across and up [m]: a texel of the map that the last picture was drawn with; of an effect
    /// without maps half a post.
    glm::dvec2 texel_m() const {
        if (!shadowed_.renderer->values().find("vsm.texel_m"))
            return glm::dvec2(0.5, 0.5 * inputs_.sun.direction.z) * spacing_m();
        const auto value = shadowed_.renderer->values().value("vsm.texel_m");
        return {value[0], value[1]};
    }

  private:
    struct Chosen {
        effect::LoadedSelection native;
        std::unique_ptr<render::Renderer> renderer;
    };

    void shine(const glm::dvec3& to_sun) {
        sun::Position position{};
        position.direction = to_sun;
        position.semidiameter_rad = semidiameter_rad_;
        inputs_.sun = render::make_sun_light(position, sun::Refraction::none(), ground_, dem_.grid);
        inputs_.sun.terrestrial_refraction = 0;  // the march goes straight on
    }

    Chosen select(const std::vector<std::string>& only) {
        effect::Switches switches;
        switches.only = only;
        Chosen chosen{effect::select_and_load(registry_, {}, switches, values_), nullptr};
        render::EffectInputs inputs;
        inputs.stitch.snippets = chosen.native.selection.snippets();
        inputs.stitch.capabilities = chosen.native.selection.capabilities;
        inputs.stitch.values = &values_;
        for (const effect::NativeModule& module : chosen.native.modules)
            inputs.modules.push_back(&module);
        if (chosen.native.selection.effects.size() != only.size())
            failed(chosen.native.selection.notices.at(0));
        chosen.renderer = std::make_unique<render::Renderer>(
            context_, inputs,
            render::RendererOptions{
                .width_px = size_.x, .height_px = size_.y, .antialias = false, .radiance = true});
        return chosen;
    }

    image::ImageF draw(Chosen& chosen) {
        chosen.renderer->render_frame(*terrain_, ground_, inputs_);
        return chosen.renderer->read_radiance();
    }

    glm::dvec2 project(const glm::dvec3& point) const {
        const scene::Camera& camera = inputs_.camera;
        const glm::dvec3 to = point - camera.eye_m;
        const double depth = dot(to, camera.forward);
        const double scale = size_.y / 2.0 / std::tan(camera.fov_y_rad / 2);
        return {size_.x / 2.0 + scale * dot(to, cross(camera.forward, camera.up)) / depth,
                size_.y / 2.0 - scale * dot(to, camera.up) / depth};
    }

    const dem::Heightfield& dem_;
    render::Ground ground_;
    gl::Context context_;
    effect::Registry registry_;
    shader::ParamStore values_;
    glm::ivec2 size_{};
    double semidiameter_rad_ = 0;
    Array2d<float> spread_;
    render::FrameInputs inputs_;
    std::optional<render::Terrain> terrain_;
    Chosen shadowed_, plain_;
};

/// One sun over one DEM.
struct Score {
    double shaded_share = 0;  ///< of the cells that face the sun
    double balanced = 0;      ///< mean of the shares of lit and of shaded cells that are right
    double beyond = 0;        ///< the same over cells more than two texels from the true line
    double lit_right = 0, shaded_right = 0;
    glm::dvec2 texel_m{};
};

inline glm::dvec3 direction(double azimuth_deg, double elevation_deg) {
    const double a = radians(azimuth_deg), e = radians(elevation_deg);
    return {std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)};
}

/// Posts within two texels of a change from light to shadow, in the light's space.
inline Array2d<std::uint8_t> near_line(const Truth& truth, const Truth::Mask& mask,
                                       const glm::dvec2& texel_m, const glm::dvec3& to_sun,
                                       double spacing_m) {
    const int columns = mask.shaded.width(), rows = mask.shaded.height();
    Array2d<std::uint8_t> result(columns, rows);
    const double sine = to_sun.z, rise = Truth::axes(to_sun)[1].z;
    const double reach_m = 2 * std::max(texel_m.x, texel_m.y / std::max(sine, 0.01));
    const int window = std::min(20, static_cast<int>(std::ceil(reach_m / spacing_m)));
    const auto is_near = [&](const glm::dvec3& from, const glm::dvec3& to) {
        return std::abs(to.x - from.x) <= 2 * texel_m.x && std::abs(to.y - from.y) <= 2 * texel_m.y;
    };
    parallel_for(0, rows, 4, [&](int first, int last) {
        for (int y = first; y < last; ++y) {
            for (int x = 0; x < columns; ++x) {
                const glm::dvec3 here = mask.light_m.at(x, y);
                const bool own = mask.shaded.at(x, y) != 0;
                bool near = false;
                for (int j = std::max(0, y - window); j <= std::min(rows - 1, y + window); ++j)
                    for (int i = std::max(0, x - window); i <= std::min(columns - 1, x + window);
                         ++i)
                        near = near || ((mask.shaded.at(i, j) != 0) != own &&
                                        is_near(here, mask.light_m.at(i, j)));
                // Where on the four grid lines the change is.
                for (const glm::ivec2 step : {glm::ivec2(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
                    const glm::ivec2 next = glm::ivec2(x, y) + step;
                    if (near || next.x < 0 || next.y < 0 || next.x >= columns || next.y >= rows ||
                        (mask.shaded.at(next.x, next.y) != 0) == own)
                        continue;
                    double same = 0, other = 1;
                    for (int i = 0; i < 8; ++i) {
                        const double middle = 0.5 * (same + other);
                        const bool shaded = truth.is_shaded(
                            mask.light_m, glm::dvec2(x, y) + middle * glm::dvec2(step), rise, sine);
                        (shaded == own ? same : other) = middle;
                    }
                    near = is_near(here, glm::mix(here, mask.light_m.at(next.x, next.y), same));
                }
                result.at(x, y) = near;
            }
        }
    });
    return result;
}

inline double balanced(std::int64_t lit_right, std::int64_t lit, std::int64_t shaded_right,
                       std::int64_t shaded) {
    if (lit == 0 || shaded == 0) return 1;
    return 0.5 * (static_cast<double>(lit_right) / static_cast<double>(lit) +
                  static_cast<double>(shaded_right) / static_cast<double>(shaded));
}

/// @param shown  1 for the posts that count; null: all do
inline Score score(const Truth& truth, const Truth::Mask& mask, const Array2d<float>& drawn,
                   const glm::dvec2& texel_m, const glm::dvec3& to_sun, double spacing_m,
                   const Array2d<std::uint8_t>* shown = nullptr) {
    const Array2d<std::uint8_t> near = near_line(truth, mask, texel_m, to_sun, spacing_m);
    std::array<std::array<std::int64_t, 2>, 2> all{}, right{};  // [beyond][shaded]
    for (int y = 0; y < drawn.height(); ++y) {
        for (int x = 0; x < drawn.width(); ++x) {
            if (!mask.facing.at(x, y) || (shown && !shown->at(x, y))) continue;
            const std::size_t truly = mask.shaded.at(x, y);
            const std::size_t said = drawn.at(x, y) < 0.5f;
            for (std::size_t beyond = 0; beyond < 2; ++beyond) {
                if (beyond && near.at(x, y)) continue;
                ++all[beyond][truly];
                right[beyond][truly] += truly == said;
            }
        }
    }
    Score s;
    s.shaded_share = static_cast<double>(all[0][1]) / static_cast<double>(all[0][0] + all[0][1]);
    s.balanced = balanced(right[0][0], all[0][0], right[0][1], all[0][1]);
    s.beyond = balanced(right[1][0], all[1][0], right[1][1], all[1][1]);
    s.lit_right = static_cast<double>(right[0][0]) /
                  static_cast<double>(std::max<std::int64_t>(all[0][0], 1));
    s.shaded_right = static_cast<double>(right[0][1]) /
                     static_cast<double>(std::max<std::int64_t>(all[0][1], 1));
    s.texel_m = texel_m;
    return s;
}

constexpr double kSunRadius_rad = 0.004654;  // at one astronomical unit

/// How well the share of the sun's disc is drawn that posts see, of those that face the sun and see
/// some of it and not all.
struct Penumbra {
    std::int64_t posts = 0;
    double mean = 0, mean_size = 0;  ///< of drawn less true, 0 to 1
};

/// @param lit    as drawn, of a sun of kSunRadius_rad
/// @param shown  1 for the posts that count
inline Penumbra penumbra(const Truth& truth, const Array2d<float>& lit,
                         const Array2d<std::uint8_t>& shown, const glm::dvec3& to_sun) {
    constexpr int kPoints = 64;  // evenly over the disc, after Vogel, Math. Biosciences 44, 1979
    const glm::dmat3 axes = Truth::axes(to_sun);
    Array2d<int> seen(lit.width(), lit.height());
    Truth::Mask mask;
    for (int i = 0; i < kPoints; ++i) {
        const double angle = 2.39996323 * i, radius = std::sqrt((i + 0.5) / kPoints);
        const glm::dvec2 off =
            kSunRadius_rad * radius * glm::dvec2(std::cos(angle), std::sin(angle));
        mask = truth.cast(normalize(to_sun + off.x * axes[0] + off.y * axes[1]));
        for (std::size_t k = 0; k < seen.size(); ++k)
            seen.data()[k] += 1 - mask.shaded.data()[k];
    }
    mask = truth.cast(to_sun);
    Penumbra result;
    for (std::size_t k = 0; k < seen.size(); ++k) {
        if (!shown.data()[k] || !mask.facing.data()[k]) continue;
        if (seen.data()[k] == 0 || seen.data()[k] == kPoints) continue;
        const double apart = double{lit.data()[k]} - seen.data()[k] / double{kPoints};
        ++result.posts;
        result.mean += apart;
        result.mean_size += std::abs(apart);
    }
    if (result.posts > 0) {
        result.mean /= static_cast<double>(result.posts);
        result.mean_size /= static_cast<double>(result.posts);
    }
    return result;
}

/// What is drawn at the posts themselves, of windows all over a DEM.
struct AtPosts {
    Array2d<float> lit;
    Array2d<std::uint8_t> shown;  ///< 1 for the posts of a window
};

/// @param windows  along a side of the DEM
/// @param posts    along a side of a window
inline AtPosts at_posts_themselves(Drawn& drawn, const Truth& truth, const glm::dvec3& to_sun,
                                   int windows = 2, int posts = 60, int pixels = 16) {
    const int columns = truth.posts().width(), rows = truth.posts().height();
    AtPosts result{Array2d<float>(columns, rows, 1), Array2d<std::uint8_t>(columns, rows)};
    for (int j = 0; j < windows; ++j)
        for (int i = 0; i < windows; ++i) {
            const dem::Window window{(columns - posts) * (2 * i + 1) / (2 * windows),
                                     (rows - posts) * (2 * j + 1) / (2 * windows), posts, posts};
            drawn.watch(window, pixels);
            const Array2d<float> lit = drawn.at_posts(to_sun, truth.posts());
            for (int y = window.row + 2; y < window.row + posts - 2; ++y)
                for (int x = window.column + 2; x < window.column + posts - 2; ++x) {
                    if (drawn.spread().at(x, y) > 1.5f) continue;
                    result.lit.at(x, y) = lit.at(x, y);
                    result.shown.at(x, y) = 1;
                }
        }
    return result;
}

}  // namespace relevo::shadow
