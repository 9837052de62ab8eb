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
#include "render/device_shadows.h"
#include "render/shadow_texels.h"

namespace relevo::render {
namespace {

constexpr int kMostLevels = 9;      // of means; the coarsest are of 512 x 512 posts
constexpr int kMostSide = 16384;    // of textures, by OpenGL 4.5
constexpr double kMarginPosts = 4;  // a margin of so many spacings counts as one of any size

/// Means of squares of posts, as Source::read() makes them: holes take no part.
Array2d<float> means_of(const Array2d<float>& height_m, int side, float factor) {
    const int columns = height_m.width() / side, rows = height_m.height() / side;
    Array2d<float> means(columns, rows);
    parallel_for(0, rows, 8, [&](int first, int last) {
        for (int row = first; row < last; ++row)
            for (int column = 0; column < columns; ++column) {
                float sum = 0;
                int count = 0;
                for (int y = row * side; y < (row + 1) * side; ++y)
                    for (int x = column * side; x < (column + 1) * side; ++x) {
                        const float h = height_m.at(x, y);
                        if (std::isnan(h)) continue;
                        sum += h;
                        ++count;
                    }
                means.at(column, row) = count > 0 ? factor * sum / static_cast<float>(count)
                                                  : std::numeric_limits<float>::quiet_NaN();
            }
    });
    return means;
}

/// Two bytes a texel.
struct Bytes2 {
    std::uint8_t value, coverage;
};

/// Values and coverage with levels of means. Sides are such that each level halves the one before;
/// what is beyond the posts has no coverage.
class Shares {
  public:
    /// @param width, height  of what level 0 has to have
    void resize(int width, int height) {
        if (width == asked_.x && height == asked_.y) return;
        asked_ = {width, height};
        int levels = 1;
        while (levels < kMostLevels && std::max(width, height) >> levels > 0)
            ++levels;
        const int unit = 1 << (levels - 1);
        const auto padded = [&](int side) { return (side + unit - 1) / unit * unit; };
        levels_.clear();
        for (int level = 0; level < levels; ++level)
            levels_.emplace_back(padded(width) >> level, padded(height) >> level, Bytes2{0, 0});
        texture_.reset();
    }

    Array2d<Bytes2>& base() { return levels_.front(); }

    /// Without coverage, where it is new.
    const gl::Texture& make_texture(const char* name) {
        if (texture_) return *texture_;
        const Array2d<Bytes2>& base = levels_.front();
        texture_.emplace(gl::TextureKind::D2, gl::Format::RG8,
                         gl::Extent{base.width(), base.height(), 1},
                         static_cast<int>(levels_.size()), name);
        texture_->set_sampling(gl::Filter::Mipmap, gl::Wrap::Clamp);
        texture_->fill(std::byte{0});
        return *texture_;
    }

    void upload(const char* name) {
        for (std::size_t level = 1; level < levels_.size(); ++level)
            reduce(levels_[level - 1], levels_[level]);
        make_texture(name);
        for (std::size_t level = 0; level < levels_.size(); ++level)
            texture_->write(static_cast<int>(level), {0, 0, 0},
                            {levels_[level].width(), levels_[level].height(), 1},
                            std::as_bytes(std::span(levels_[level].data(), levels_[level].size())));
    }

    const gl::Texture* texture() const { return texture_ ? &*texture_ : nullptr; }

  private:
    static void reduce(const Array2d<Bytes2>& fine, Array2d<Bytes2>& coarse) {
        parallel_for(0, coarse.height(), 64, [&](int first, int last) {
            for (int row = first; row < last; ++row) {
                const Bytes2 *const a = fine.row(2 * row).data(), *const b =
                                                                      fine.row(2 * row + 1).data();
                Bytes2* const to = coarse.row(row).data();
                for (int i = 0; i < coarse.width(); ++i) {
                    const auto mean = [&](std::uint8_t Bytes2::*part) {
                        return static_cast<std::uint8_t>((a[2 * i].*part + a[2 * i + 1].*part +
                                                          b[2 * i].*part + b[2 * i + 1].*part + 2) /
                                                         4);
                    };
                    to[i] = {mean(&Bytes2::value), mean(&Bytes2::coverage)};
                }
            }
        });
    }

    glm::ivec2 asked_{0};
    std::vector<Array2d<Bytes2>> levels_;
    std::optional<gl::Texture> texture_;
};

/// How many posts a mean is of, each way, where there may be so many means.
int reduction_to(const Array2d<float>& h, std::int64_t most_posts) {
    int reduction = 1;
    while (std::min(h.width(), h.height()) / (2 * reduction) >= 2 &&
           (std::max(h.width(), h.height()) / reduction > kMostSide ||
            std::int64_t{h.width() / reduction} * (h.height() / reduction) > most_posts))
        reduction *= 2;
    return reduction;
}

/// A DEM's posts at the height that they are drawn at, or means of them.
struct DrawnPosts {
    std::optional<dem::Heightfield> own;  ///< unless they are the given ones
    std::optional<dem::Posts> posts;
    double exaggeration = 0;
    int reduction = 1;  ///< of the given posts to one of these, each way

    void make(const dem::Heightfield& given, double wanted, int wanted_reduction) {
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
            means_of(h, reduction, static_cast<float>(exaggeration)),
            given.grid.part({0, 0, columns * reduction, rows * reduction}, columns, rows),
            given.about});
        own->about.statistics = dem::statistics(own->height_m);
        posts.emplace(*own);
    }
};

/// The sun that textures were made for.
struct SunMade {
    glm::dvec3 direction{0};
    double semidiameter_rad = 0;
    friend bool operator==(const SunMade&, const SunMade&) = default;
};

/// The air that margins were made for, told apart by how it bends rays.
struct AirMade {
    std::array<double, 3> refraction_rad{};
    double terrestrial = 0;
    friend bool operator==(const AirMade&, const AirMade&) = default;

    static AirMade of(const SunLight& sun) {
        AirMade made;
        made.terrestrial = sun.terrestrial_refraction;
        if (sun.air && sun.refraction_rad)
            made.refraction_rad = {sun.refraction_rad(0), sun.refraction_rad(0.1),
                                   sun.refraction_rad(0.7)};
        return made;
    }
};

}  // namespace

struct SkyFound {
    DrawnPosts ground;
    Array2d<float> share;  ///< of the sky that they see; all of it on maps of the world
};

namespace {

std::shared_ptr<const SkyFound> find_sky(const dem::Heightfield& field, double exaggeration) {
    const auto found = std::make_shared<SkyFound>();
    found->ground.make(field, exaggeration,
                       reduction_to(field.height_m, GroundLight::kMostSkyPosts));
    light::SkyViewOptions options;
    options.directions = GroundLight::kSkyDirections;
    options.of_open_slope = true;
    const dem::Grid& grid = found->ground.posts->grid();
    try {
        found->share = light::sky_view(*found->ground.posts, options).share;
    } catch (const Error& error) {
        if (error.code() != ErrorCode::BadInput) throw;
        log::info("sky shading is off: this grid is too near the pole");
        log::debug(error.what());
        found->share = {grid.columns(), grid.rows(), 1};
    }
    return found;
}

}  // namespace

struct GroundLight::Impl {
    const dem::Heightfield& field;
    const geo::LocalFrame& frame;

    /// Posts, or means of them, and what is the same for all suns.
    struct Level {
        DrawnPosts ground;
        std::optional<light::Clearances> margins;  // of the posts above
        std::optional<DeviceShadows::Ground> on_device;
        AirMade air;

        void clear() {
            on_device.reset();
            margins.reset();
        }
    };
    std::map<int, Level> levels;  // by reduction
    Level* level = nullptr;       // of the textures
    ShadowsOn where;
    std::optional<DeviceShadows> device;
    bool of_device = false;  // the textures
    SkyAhead sky_ahead;
    std::shared_ptr<const SkyFound> sky_found;  // what the texture has
    std::optional<SunMade> sun;
    double told_error_rad = 0;

    Array2d<std::uint32_t> halves;       // upper limb's margin in the low half, lower one's above
    Array2d<std::uint16_t> post_shares;  // value and coverage, a byte each
    std::optional<gl::Texture> margin_texture;
    Shares shares, sky;
    bool has_sun = true;  // one can be found over the DEM

    Impl(const dem::Heightfield& f, const geo::LocalFrame& l, SkyAhead ahead, ShadowsOn on)
        : field(f), frame(l), where(on), sky_ahead(std::move(ahead)) {}

    /// Means are finer than the pixels, and few where pixels allow it.
    int reduction_for(double pixel_posts) const {
        const int few = reduction_to(field.height_m, kFewPosts);
        int reduction = reduction_to(field.height_m, kMostPosts);
        while (2 * reduction * field.reduction <= pixel_posts && 2 * reduction <= few)
            reduction *= 2;
        return reduction;
    }

    void prepare(const SunLight& light, double exaggeration, int reduction) {
        const AirMade wanted = AirMade::of(light);
        Level& here = levels[reduction];
        if (level != &here) sun.reset();
        level = &here;
        if (here.air != wanted) here.clear();
        if (here.margins && here.ground.exaggeration == exaggeration) return;
        here.clear();
        here.ground.make(field, exaggeration, reduction);
        here.air = wanted;
        sun.reset();
        light::ShadowOptions options;
        options.refraction = light.terrestrial_refraction;
        if (light.air)
            options.air = [&](const geo::Geodetic& place) {
                geo::Geodetic at = place;
                at.height_m /= exaggeration;  // of the ground that there is
                return light.air(at);
            };
        here.margins.emplace(*here.ground.posts, options);
    }

    void make_textures() {
        const dem::Grid& grid = level->ground.posts->grid();
        const gl::Extent size{grid.columns(), grid.rows(), 1};
        shares.resize((size.width + 1) / 2, (size.height + 1) / 2);
        if (margin_texture && margin_texture->extent() == size) return;
        margin_texture.emplace(gl::TextureKind::D2, gl::Format::RG16F, size, 1, "light_margins");
        margin_texture->set_sampling(gl::Filter::Linear, gl::Wrap::Clamp);
    }

    void make_room() {
        make_textures();
        const auto [columns, rows, depth] = margin_texture->extent();
        if (halves.width() == columns && halves.height() == rows) return;
        halves = Array2d<std::uint32_t>(columns, rows);
        post_shares = Array2d<std::uint16_t>(columns, rows);
    }

    void take(const light::ClearanceRun& run) {
        encode_shadows(run, &halves.at(run.column, run.row), &post_shares.at(run.column, run.row));
    }

    /// All posts are in the shade, or none.
    void set_all(bool lit) {
        const std::uint32_t margin = half_of(lit ? kMostMargin : -kMostMargin);
        std::ranges::fill(halves, margin << 16 | margin);
        std::ranges::fill(post_shares, std::uint16_t(lit ? 0xffffU : 0xff00U));
    }

    /// Textures of a sun, computed on the device; false where the processor has to: at night, for
    /// DEMs without a sun, and after the device has failed.
    bool find_on_device(const light::SunOverDem& over) {
        if (where != ShadowsOn::Device || !has_sun) return false;
        try {
            make_textures();
            if (!device) device.emplace();
            if (!level->on_device) level->on_device.emplace(level->margins->terrain());
            const light::Clearances::Found found =
                device->find(*level->margins, *level->on_device, frame.origin(), over,
                             *margin_texture, shares.make_texture("light_shares"));
            if (!found.night) tell(found.error_rad);
            return !found.night;
        } catch (const Error& error) {
            if (error.code() == ErrorCode::BadInput) return false;
            if (error.code() != ErrorCode::Failed) throw;
            log::warning(fmt::format("shadows: computed on the processor: {}", error.what()));
            where = ShadowsOn::Processor;
            for (auto& [reduction, each] : levels)
                each.on_device.reset();
            return false;
        }
    }

    /// Margins of a sun, where the DEM has one; false on maps of the world, whose rows end in
    /// poles.
    bool find_margins(const light::SunOverDem& over) {
        make_room();
        if (!has_sun) return false;
        try {
            const light::Clearances::Found found = level->margins->each(
                frame.origin(), over, [&](const light::ClearanceRun& run) { take(run); });
            if (found.night) set_all(false);
            tell(found.error_rad);
        } catch (const Error& error) {
            if (error.code() != ErrorCode::BadInput) throw;
            has_sun = false;
            log::info("shadows are off: this grid is too near the pole");
            log::debug(error.what());
        }
        return has_sun;
    }

    void upload_sun() {
        margin_texture->write(0, {0, 0, 0}, {halves.width(), halves.height(), 1},
                              std::as_bytes(std::span(halves.data(), halves.size())));
        Array2d<Bytes2>& base = shares.base();
        const int columns = halves.width(), rows = halves.height();
        parallel_for(0, (rows + 1) / 2, 32, [&](int first, int last) {
            for (int row = first; row < last; ++row) {
                const std::uint16_t* const a = post_shares.row(2 * row).data();
                const std::uint16_t* const b =
                    post_shares.row(std::min(2 * row + 1, rows - 1)).data();
                Bytes2* const to = base.row(row).data();
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
        shares.upload("light_shares");
    }

    /// Says once how far off the sun is where one does not hold for enough posts.
    void tell(double error_rad) {
        if (error_rad <= told_error_rad) return;
        told_error_rad = error_rad;
        log::info(fmt::format(
            "shadows: on this wide DEM the sun's direction is off by up to {:.1f} degrees",
            degrees(error_rad)));
    }
};

SkyAhead find_sky_ahead(const dem::Heightfield& field, double exaggeration) {
    // Where the system gives no further thread it is found when it is waited for.
    return std::async(std::launch::async | std::launch::deferred,
                      [&field, exaggeration] { return find_sky(field, exaggeration); });
}

GroundLight::GroundLight(const dem::Heightfield& field, const geo::LocalFrame& frame, SkyAhead sky,
                         ShadowsOn where)
    : impl_(std::make_unique<Impl>(field, frame, std::move(sky), where)) {}
GroundLight::GroundLight(GroundLight&&) noexcept = default;
GroundLight& GroundLight::operator=(GroundLight&&) noexcept = default;
GroundLight::~GroundLight() = default;

void GroundLight::follow(const SunLight& light, double exaggeration, double pixel_posts) {
    Impl& my = *impl_;
    my.prepare(light, exaggeration, my.reduction_for(pixel_posts));
    const SunMade wanted{light.direction, light.semidiameter_rad};
    if (my.sun == wanted) return;
    const glm::dvec3& d = light.direction;
    const light::SunOverDem over{std::atan2(d.x, d.y), std::atan2(d.z, std::hypot(d.x, d.y)),
                                 light.semidiameter_rad};
    my.of_device = my.find_on_device(over);
    if (!my.of_device) {
        if (!my.find_margins(over)) my.set_all(true);
        my.upload_sun();
    }
    my.sun = wanted;
}

bool GroundLight::is_of_device() const {
    return impl_->of_device;
}

std::optional<glm::dvec3> GroundLight::followed() const {
    if (!impl_->sun) return std::nullopt;
    return impl_->sun->direction;
}

void GroundLight::look_up(double exaggeration) {
    Impl& my = *impl_;
    if (my.sky_found && my.sky_found->ground.exaggeration == exaggeration) return;
    if (my.sky_ahead.valid()) my.sky_found = std::exchange(my.sky_ahead, {}).get();
    if (!my.sky_found || my.sky_found->ground.exaggeration != exaggeration)
        my.sky_found = find_sky(my.field, exaggeration);
    const Array2d<float>& share = my.sky_found->share;
    my.sky.resize(share.width(), share.height());
    for (int row = 0; row < share.height(); ++row)
        for (int column = 0; column < share.width(); ++column) {
            const float seen = share.at(column, row);
            my.sky.base().at(column, row) =
                std::isnan(seen)
                    ? Bytes2{0, 0}
                    : Bytes2{static_cast<std::uint8_t>(255 * std::clamp(seen, 0.0F, 1.0F) + 0.5F),
                             255};
        }
    my.sky.upload("light_sky");
}

const gl::Texture* GroundLight::texture(std::string_view name) const {
    const Impl& my = *impl_;
    if (name == "light_margins") return my.margin_texture ? &*my.margin_texture : nullptr;
    if (name == "light_shares") return my.shares.texture();
    if (name == "light_sky") return my.sky.texture();
    return nullptr;
}

void GroundLight::describe(FrameBlock& block) const {
    const Impl& my = *impl_;
    const dem::Grid& grid = my.field.grid;
    const double given = my.field.reduction;
    const glm::dvec2 spacing_m = grid.post_spacing_m();
    const int reduction = my.level ? my.level->ground.reduction : 1;
    const int sky_reduction = my.sky_found ? my.sky_found->ground.reduction : 1;
    const double exaggeration = my.level ? my.level->ground.exaggeration : 1;
    block.light_grid = {static_cast<float>(1 / (given * reduction)),
                        static_cast<float>(1 / (given * sky_reduction)), 0,
                        static_cast<float>(kMarginPosts * reduction *
                                           std::max(spacing_m.x, spacing_m.y) * exaggeration)};
    const geo::Geodetic centre = grid.center();
    const double step_m = std::max(spacing_m.x, spacing_m.y);
    const auto posts_a_metre = [&](double azimuth_rad) {
        return (grid.post(geo::destination(centre, azimuth_rad, step_m)) -
                grid.post(geo::destination(centre, azimuth_rad, -step_m))) /
               (2 * step_m);
    };
    block.light_axes = {posts_a_metre(kPi / 2), posts_a_metre(0)};
    block.light_map = {grid.crs().is_geographic() ? 1 : 0, 0, 0, 0};
}

}  // namespace relevo::render
