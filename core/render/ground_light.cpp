#include "render/ground_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <future>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/array2d.h"
#include "base/error.h"
#include "base/log.h"
#include "base/parallel_for.h"
#include "base/units.h"
#include "dem/posts.h"
#include "gl/context.h"
#include "light/raster/clearance.h"
#include "light/raster/horizons.h"
#include "render/block_means.h"
#include "render/coverage_texture.h"
#include "render/device_shadows.h"
#include "render/shadow_texels.h"

// Paging of these textures was rejected, because a sweep needs the whole DEM anyway.
namespace relevo::render {
namespace {

constexpr int kMaxSide_px = 16384;     // that OpenGL 4.5 guarantees
constexpr double kClearancePosts = 4;  // shaders clamp clearances to so many post spacings

/// The smallest power of two such that means of reduction x reduction posts number at most
/// `max_posts` and fit into a texture. Leaves at least 2 means a side.
int reduction_within(const Array2d<float>& h, std::int64_t max_posts) {
    int reduction = 1;
    while (std::min(h.width(), h.height()) / (2 * reduction) >= 2 &&
           (std::max(h.width(), h.height()) / reduction > kMaxSide_px ||
            std::int64_t{h.width() / reduction} * (h.height() / reduction) > max_posts))
        reduction *= 2;
    return reduction;
}

/// Posts of a DEM, or means of them, with exaggerated heights.
struct ExaggeratedPosts {
    std::optional<dem::Heightfield> own;  ///< nullopt: `posts` are those of the given heightfield
    std::optional<dem::Posts> posts;
    double exaggeration = 0;
    int reduction = 1;  ///< given posts per post, along a side

    void update(const dem::Heightfield& given, double wanted, int wanted_reduction) {
        if (posts && exaggeration == wanted && reduction == wanted_reduction) return;
        posts.reset();
        exaggeration = wanted;
        reduction = wanted_reduction;
        const Array2d<float>& h = given.height_m;
        if (reduction == 1 && exaggeration == 1 && given.reduction == 1) {
            posts.emplace(given);
            return;
        }
        const int columns = h.width() / reduction, rows = h.height() / reduction;
        own.emplace(dem::Heightfield{
            block_means(h, reduction, static_cast<float>(exaggeration)),
            given.grid.part({0, 0, columns * reduction, rows * reduction}, columns, rows),
            given.about});
        own->about.statistics = dem::statistics(own->height_m);
        posts.emplace(*own);
    }
};

/// The sun of the shadow textures.
struct SunKey {
    glm::dvec3 direction{0};
    double semidiameter_rad = 0;
    friend bool operator==(const SunKey&, const SunKey&) = default;
};

/// The air of the clearances, identified by its refraction at three elevations.
struct AirKey {
    std::array<double, 3> refraction_rad{};
    double terrestrial = 0;
    friend bool operator==(const AirKey&, const AirKey&) = default;

    static AirKey of(const SunLight& sun) {
        AirKey key;
        key.terrestrial = sun.terrestrial_refraction;
        if (sun.air && sun.refraction_rad)
            key.refraction_rad = {sun.refraction_rad(0), sun.refraction_rad(0.1),
                                  sun.refraction_rad(0.7)};
        return key;
    }
};

}  // namespace

struct SkyView {
    ExaggeratedPosts ground;
    Array2d<float> factor;  ///< relative to an unobstructed slope; NaN in voids, 1 near the poles
};

namespace {

std::shared_ptr<const SkyView> compute_sky_view(const dem::Heightfield& field,
                                                double exaggeration) {
    const auto view = std::make_shared<SkyView>();
    view->ground.update(field, exaggeration,
                        reduction_within(field.height_m, GroundLight::kMaxSkyPosts));
    light::SkyViewOptions options;
    options.directions = GroundLight::kSkyDirections;
    options.of_open_slope = true;
    const dem::Grid& grid = view->ground.posts->grid();
    try {
        view->factor = light::sky_view(*view->ground.posts, options).share;
    } catch (const Error& error) {
        if (error.code() != ErrorCode::BadInput) throw;
        log::info("sky shading is off: this grid is too near the pole");
        log::debug(error.what());
        view->factor = {grid.columns(), grid.rows(), 1};
    }
    return view;
}

}  // namespace

struct GroundLight::Impl {
    const dem::Heightfield& field;
    const geo::LocalFrame& frame;
    std::int64_t max_posts;

    /// Posts of one reduction, with data that all suns share.
    struct Level {
        ExaggeratedPosts ground;
        std::optional<light::Clearances> clearances;  // points to `ground`
        std::optional<DeviceShadows::Ground> device_ground;
        AirKey air;

        void clear() {
            device_ground.reset();
            clearances.reset();
        }
    };
    std::map<int, Level> levels;  // by reduction
    Level* level = nullptr;       // of the shadow textures
    ShadowsOn where;
    std::optional<DeviceShadows> device;
    bool on_device = false;  // the shadow textures were computed there
    SkyViewFuture sky_future;
    std::shared_ptr<const SkyView> sky_view;  // of the sky-view texture
    std::optional<SunKey> sun;                // of the shadow textures
    double reported_error_rad = 0;

    Array2d<std::uint32_t> half_clearances;  // two half floats: upper limb low, lower limb high
    Array2d<std::uint16_t> fractions;        // value and coverage, a byte each
    std::optional<gl::Texture> clearance_texture;
    CoverageTexture fraction, sky;
    bool has_shadows = true;  // false: the grid is too near a pole

    Impl(const dem::Heightfield& f, const geo::LocalFrame& l, SkyViewFuture future, ShadowsOn on,
         std::int64_t most)
        : field(f),
          frame(l),
          max_posts(std::min<std::int64_t>(most, kMaxPosts)),
          where(on),
          sky_future(std::move(future)) {}

    /// The largest reduction whose means are not coarser than the pixels, within kCoarsePosts.
    int reduction_for(double pixel_posts) const {
        int reduction = reduction_within(field.height_m, max_posts);
        const int coarsest = std::max(reduction, reduction_within(field.height_m, kCoarsePosts));
        while (2 * reduction * field.reduction <= pixel_posts && 2 * reduction <= coarsest)
            reduction *= 2;
        return reduction;
    }

    /// Selects the level of a reduction, and computes what its suns share.
    void select_level(const SunLight& light, double exaggeration, int reduction) {
        const AirKey wanted = AirKey::of(light);
        Level& here = levels[reduction];
        if (level != &here) sun.reset();
        level = &here;
        if (here.air != wanted) here.clear();
        if (here.clearances && here.ground.exaggeration == exaggeration) return;
        here.clear();
        here.ground.update(field, exaggeration, reduction);
        here.air = wanted;
        sun.reset();
        light::ShadowOptions options;
        options.refraction = light.terrestrial_refraction;
        if (light.air)
            options.air = [&](const geo::Geodetic& place) {
                geo::Geodetic at = place;
                at.height_m /= exaggeration;  // true height
                return light.air(at);
            };
        here.clearances.emplace(*here.ground.posts, options);
    }

    void resize_textures() {
        const dem::Grid& grid = level->ground.posts->grid();
        const gl::Extent size{grid.columns(), grid.rows(), 1};
        fraction.resize((size.width + 1) / 2, (size.height + 1) / 2);
        if (clearance_texture && clearance_texture->extent() == size) return;
        clearance_texture.emplace(gl::TextureKind::D2, gl::Format::RG16F, size, 1,
                                  "light_clearance");
        clearance_texture->set_sampling(gl::Filter::Linear, gl::Wrap::Clamp);
    }

    void resize_buffers() {
        resize_textures();
        const auto [columns, rows, depth] = clearance_texture->extent();
        if (half_clearances.width() == columns && half_clearances.height() == rows) return;
        half_clearances = Array2d<std::uint32_t>(columns, rows);
        fractions = Array2d<std::uint16_t>(columns, rows);
    }

    void store(const light::ClearanceRun& run) {
        encode_shadows(run, &half_clearances.at(run.column, run.row),
                       &fractions.at(run.column, run.row));
    }

    /// Sets all posts to sunlight or to shadow.
    void fill(bool lit) {
        const std::uint32_t clearance = to_half(lit ? kMaxClearance_m : -kMaxClearance_m);
        std::ranges::fill(half_clearances, clearance << 16 | clearance);
        std::ranges::fill(fractions, std::uint16_t(lit ? 0xffffU : 0xff00U));
    }

    /// Computes the shadow textures on the device.
    /// @returns false if the processor must: at night, too near a pole, and after the device failed
    bool compute_on_device(const light::SunOverDem& over) {
        if (where != ShadowsOn::Device || !has_shadows) return false;
        try {
            resize_textures();
            if (!device) device.emplace();
            if (!level->device_ground) level->device_ground.emplace(level->clearances->terrain());
            const light::Clearances::Found found =
                device->find(*level->clearances, *level->device_ground, frame.origin(), over,
                             *clearance_texture, fraction.make_texture("light_fraction"));
            if (!found.night) report_error(found.error_rad);
            return !found.night;
        } catch (const Error& error) {
            if (error.code() == ErrorCode::BadInput) return false;
            if (error.code() != ErrorCode::Failed) throw;
            log::warning(fmt::format("shadows: computed on the processor: {}", error.what()));
            where = ShadowsOn::Processor;
            for (auto& [reduction, each] : levels)
                each.device_ground.reset();
            return false;
        }
    }

    /// Computes shadows into the buffers of the processor.
    /// @returns false if the grid is too near a pole, as maps of the world are
    bool compute_on_processor(const light::SunOverDem& over) {
        resize_buffers();
        if (!has_shadows) return false;
        try {
            const light::Clearances::Found found = level->clearances->each(
                frame.origin(), over, [&](const light::ClearanceRun& run) { store(run); });
            if (found.night) fill(false);
            report_error(found.error_rad);
        } catch (const Error& error) {
            if (error.code() != ErrorCode::BadInput) throw;
            has_shadows = false;
            log::info("shadows are off: this grid is too near the pole");
            log::debug(error.what());
        }
        return has_shadows;
    }

    void upload_shadows() {
        clearance_texture->write(
            0, {0, 0, 0}, {half_clearances.width(), half_clearances.height(), 1},
            std::as_bytes(std::span(half_clearances.data(), half_clearances.size())));
        Array2d<CoverageTexel>& base = fraction.base();
        const int columns = half_clearances.width(), rows = half_clearances.height();
        parallel_for(0, (rows + 1) / 2, 32, [&](int first, int last) {
            for (int row = first; row < last; ++row) {
                const std::uint16_t* const a = fractions.row(2 * row).data();
                const std::uint16_t* const b =
                    fractions.row(std::min(2 * row + 1, rows - 1)).data();
                CoverageTexel* const to = base.row(row).data();
                for (int i = 0; i < (columns + 1) / 2; ++i) {
                    const int x = 2 * i, y = std::min(x + 1, columns - 1);
                    const auto mean = [&](int shift) {
                        return static_cast<std::uint8_t>(
                            ((a[x] >> shift & 255) + (a[y] >> shift & 255) + (b[x] >> shift & 255) +
                             (b[y] >> shift & 255) + 2) /
                            4);
                    };
                    to[i] = {mean(0), mean(8)};
                }
            }
        });
        fraction.upload("light_fraction");
    }

    /// Logs the error of the sun's direction on DEMs that are too wide for one direction; again
    /// only if it increases.
    void report_error(double error_rad) {
        if (error_rad <= reported_error_rad) return;
        reported_error_rad = error_rad;
        log::info(fmt::format(
            "shadows: on this wide DEM the sun's direction is off by up to {:.1f} degrees",
            degrees(error_rad)));
    }
};

SkyViewFuture compute_sky_view_async(const dem::Heightfield& field, double exaggeration) {
    // Deferred to get() if the system cannot start another thread.
    return std::async(std::launch::async | std::launch::deferred,
                      [&field, exaggeration] { return compute_sky_view(field, exaggeration); });
}

GroundLight::GroundLight(const dem::Heightfield& field, const geo::LocalFrame& frame,
                         SkyViewFuture sky, ShadowsOn where, std::int64_t max_posts)
    : impl_(std::make_unique<Impl>(field, frame, std::move(sky), where, max_posts)) {}
GroundLight::GroundLight(GroundLight&&) noexcept = default;
GroundLight& GroundLight::operator=(GroundLight&&) noexcept = default;
GroundLight::~GroundLight() = default;

void GroundLight::update_shadows(const SunLight& light, double exaggeration, double pixel_posts) {
    Impl& my = *impl_;
    my.select_level(light, exaggeration, my.reduction_for(pixel_posts));
    const SunKey wanted{light.direction, light.semidiameter_rad};
    if (my.sun == wanted) return;
    const glm::dvec3& d = light.direction;
    const light::SunOverDem over{std::atan2(d.x, d.y), std::atan2(d.z, std::hypot(d.x, d.y)),
                                 light.semidiameter_rad};
    my.on_device = my.compute_on_device(over);
    if (!my.on_device) {
        if (!my.compute_on_processor(over)) my.fill(true);
        my.upload_shadows();
    }
    my.sun = wanted;
}

bool GroundLight::is_computed_on_device() const {
    return impl_->on_device;
}

std::optional<glm::dvec3> GroundLight::shadow_sun() const {
    if (!impl_->sun) return std::nullopt;
    return impl_->sun->direction;
}

void GroundLight::update_sky_view(double exaggeration) {
    Impl& my = *impl_;
    const auto is_current = [&] {
        return my.sky_view && my.sky_view->ground.exaggeration == exaggeration;
    };
    if (is_current()) return;
    if (my.sky_future.valid()) my.sky_view = std::exchange(my.sky_future, {}).get();
    if (!is_current()) my.sky_view = compute_sky_view(my.field, exaggeration);
    const Array2d<float>& factors = my.sky_view->factor;
    my.sky.resize(factors.width(), factors.height());
    for (int row = 0; row < factors.height(); ++row)
        for (int column = 0; column < factors.width(); ++column) {
            const float factor = factors.at(column, row);
            my.sky.base().at(column, row) =
                std::isnan(factor)
                    ? CoverageTexel{0, 0}
                    : CoverageTexel{
                          static_cast<std::uint8_t>(255 * std::clamp(factor, 0.0F, 1.0F) + 0.5F),
                          255};
        }
    my.sky.upload("light_sky");
}

const gl::Texture* GroundLight::texture(std::string_view name) const {
    const Impl& my = *impl_;
    if (name == "light_clearance") return my.clearance_texture ? &*my.clearance_texture : nullptr;
    if (name == "light_fraction") return my.fraction.texture();
    if (name == "light_sky") return my.sky.texture();
    return nullptr;
}

namespace {

/// @returns 1e9 where no ground is known
double eye_above_ground_m(const dem::Heightfield& field, const FrameBlock& block,
                          double exaggeration) {
    constexpr double kNoGround_m = 1e9;
    if (block.eye_axes == glm::vec4(0)) return kNoGround_m;
    const glm::dvec4 eye(block.eye_post);
    const glm::dvec2 post =
        (glm::dvec2(eye.x + eye.z, eye.y + eye.w) + 0.5) / static_cast<double>(field.reduction) -
        0.5;
    const double ground_m = field.height_at(post.x, post.y);
    return std::isnan(ground_m) ? kNoGround_m : block.eye_m.w - exaggeration * ground_m;
}

}  // namespace

void GroundLight::describe(FrameBlock& block) const {
    const Impl& my = *impl_;
    const dem::Grid& grid = my.field.grid;
    const double given = my.field.reduction;
    const glm::dvec2 spacing_m = grid.post_spacing_m();
    const int reduction = my.level ? my.level->ground.reduction : 1;
    const int sky_reduction = my.sky_view ? my.sky_view->ground.reduction : 1;
    const double exaggeration = my.level ? my.level->ground.exaggeration : 1;
    block.light_grid = {static_cast<float>(1 / (given * reduction)),
                        static_cast<float>(1 / (given * sky_reduction)), block.light_grid.z,
                        static_cast<float>(kClearancePosts * reduction *
                                           std::max(spacing_m.x, spacing_m.y) * exaggeration)};
    block.eye_above_ground = static_cast<float>(eye_above_ground_m(my.field, block, exaggeration));
    const geo::Geodetic centre = grid.center();
    const double step_m = std::max(spacing_m.x, spacing_m.y);
    const auto posts_per_m = [&](double azimuth_rad) {
        return (grid.post(geo::destination(centre, azimuth_rad, step_m)) -
                grid.post(geo::destination(centre, azimuth_rad, -step_m))) /
               (2 * step_m);
    };
    block.light_axes = {posts_per_m(kPi / 2), posts_per_m(0)};
    block.light_map.x = grid.crs().is_geographic() ? 1 : 0;
}

}  // namespace relevo::render
