#include "render/natural_ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "base/units.h"
#include "climate/land_classes.h"
#include "climate/rivers.h"

namespace relevo::render {
namespace {

using climate::Land;
using climate::LandShares;

constexpr int kMostSites = 512;       // along a side of the DEM
constexpr double kLeastApart_m = 12;  // nearer sites show houses and trees as slopes
constexpr int kAround = 160;          // texels along a side of what is around
constexpr double kLeastAround_deg = 0.5;

using Texel = LandTexel;

std::uint8_t byte_of(float share) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0F, 1.0F)));
}

/// As lib/land.glsl reads it.
Texel texel_of(const LandShares& shares) {
    const auto of = [&](Land land) { return shares[static_cast<std::size_t>(land)]; };
    return {byte_of(of(Land::Needleleaf) + of(Land::Broadleaf)), byte_of(of(Land::Crop)),
            byte_of(of(Land::Bare)), byte_of(of(Land::Urban))};
}

std::vector<Texel> texels_of(const Array2d<LandShares>& covers) {
    std::vector<Texel> texels(covers.size());
    std::ranges::transform(covers, texels.begin(), texel_of);
    return texels;
}

/// Means of two by two texels.
std::vector<Texel> halved(const std::vector<Texel>& texels, const glm::ivec2& from,
                          const glm::ivec2& to) {
    std::vector<Texel> means;
    for (int row = 0; row < to.y; ++row)
        for (int column = 0; column < to.x; ++column) {
            std::array<int, 4> sum{};
            for (int k = 0; k < 4; ++k) {
                const int x = std::min(2 * column + (k & 1), from.x - 1);
                const int y = std::min(2 * row + (k >> 1), from.y - 1);
                const Texel& texel = texels[static_cast<std::size_t>(y * from.x + x)];
                for (std::size_t i = 0; i < sum.size(); ++i)
                    sum[i] += texel[i];
            }
            Texel mean;
            for (std::size_t i = 0; i < sum.size(); ++i)
                mean[i] = static_cast<std::uint8_t>((sum[i] + 2) / 4);
            means.push_back(mean);
        }
    return means;
}

/// All levels down to one texel. (Devices may compile programs to make them: 60 ms.)
std::vector<std::vector<Texel>> mipmaps_of(std::vector<Texel> texels, glm::ivec2 size) {
    std::vector<std::vector<Texel>> levels{std::move(texels)};
    while (size.x > 1 || size.y > 1) {
        const glm::ivec2 next = glm::max(size / 2, glm::ivec2(1));
        levels.push_back(halved(levels.back(), size, next));
        size = next;
    }
    return levels;
}

dem::Pyramid::Bounds all_of(const dem::Pyramid& pyramid) {
    return pyramid.bounds(pyramid.levels() - 1, {0, 0});
}

/// The box and as much again on each side, at least so far [deg].
climate::Box widened(climate::Box box, double least_deg) {
    constexpr double kGlobe_deg = 360;
    const double up = std::max(box.north_deg - box.south_deg, least_deg);
    const double right = std::max(box.east_deg - box.west_deg, least_deg);
    box.south_deg = std::max(box.south_deg - up, -90.0);
    box.north_deg = std::min(box.north_deg + up, 90.0);
    const double most = 0.5 * (kGlobe_deg - (box.east_deg - box.west_deg));
    box.west_deg -= std::min(right, most);
    box.east_deg += std::min(right, most);
    return box;
}

/// As lib/rivers.glsl reads them. Only the last number has a mean: how much of a texel is river.
std::vector<Texel> river_texels(const climate::LandSites& sites) {
    const auto apart_m = static_cast<float>(std::sqrt(sites.apart_m.x * sites.apart_m.y));
    const auto reach_m = static_cast<float>(climate::kRiverReach) * apart_m;
    const Array2d<climate::RiverSite> rivers = climate::rivers(sites);
    std::vector<Texel> texels;
    texels.reserve(rivers.size());
    for (const climate::RiverSite& river : rivers) {
        const float half_m = 0.5F * river.width_m, away_m = std::abs(river.off_m);
        const float inside_m =
            std::min(half_m, away_m + 0.5F * apart_m) - std::max(-half_m, away_m - 0.5F * apart_m);
        texels.push_back({byte_of(river.normal_rad / std::numbers::pi_v<float>),
                          byte_of(0.5F + 0.5F * river.off_m / reach_m),
                          byte_of(std::sqrt(river.width_m / (4 * apart_m))),
                          byte_of(inside_m / apart_m)});
    }
    return texels;
}

/// Of a texel of what is around.
geo::Geodetic place_in(const climate::Box& box, double column, double row) {
    return geo::geodetic_deg(box.south_deg + (box.north_deg - box.south_deg) * row / (kAround - 1),
                             box.west_deg + (box.east_deg - box.west_deg) * column / (kAround - 1));
}

/// Adds a layer to each level.
void append(const std::vector<std::vector<Texel>>& layer, std::vector<std::vector<Texel>>& levels) {
    for (std::size_t level = 0; level < levels.size(); ++level)
        levels[level].insert(levels[level].end(), layer[level].begin(), layer[level].end());
}

/// A layer of what is around, of texels by latitude and longitude [deg].
std::vector<std::vector<Texel>> layer_around(
    const climate::Box& box, const std::function<Texel(double lat_deg, double lon_deg)>& texel) {
    std::vector<Texel> texels;
    for (int row = 0; row < kAround; ++row)
        for (int column = 0; column < kAround; ++column) {
            const geo::Geodetic place = place_in(box, column, row);
            texels.push_back(texel(degrees(place.lat_rad), degrees(place.lon_rad)));
        }
    return mipmaps_of(std::move(texels), {kAround, kAround});
}

/// Tint and share of shrubs.
Texel looks_at(const climate::LandMap& map, double lat_deg, double lon_deg) {
    const auto coded = [](float factor) { return byte_of(0.25F * std::log2(factor) + 0.5F); };
    const climate::Colour tint = map.tint(lat_deg, lon_deg);
    const LandShares shares = map.shares(lat_deg, lon_deg);
    const float shrub = shares[static_cast<std::size_t>(Land::Shrub)];
    const float grass = shares[static_cast<std::size_t>(Land::Grass)];
    return {coded(tint[0]), coded(tint[1]), coded(tint[2]),
            byte_of(shrub / std::max(shrub + grass, 1e-3F))};
}

}  // namespace

const climate::ClimateMap& NaturalGround::climate_map() {
    if (!climate_map_) climate_map_ = climate::ClimateMap::shipped();
    return *climate_map_;
}

float NaturalGround::mean_height_m(const geo::Geodetic& place) const {
    const int level = pyramid_.levels() - 1;
    const glm::dvec2 post = grid_.post(place), last(grid_.columns() - 1, grid_.rows() - 1);
    if (!(post.x >= 0 && post.y >= 0 && post.x <= last.x && post.y <= last.y)) return NAN;
    const glm::ivec2 node(
        round(post / max(last, glm::dvec2(1)) * glm::dvec2(pyramid_.size(level) - 1)));
    return pyramid_.height(level, node.x, node.y);
}

void NaturalGround::make_climate() {
    const dem::Pyramid::Bounds all = all_of(pyramid_);
    climate_.emplace(climate_map(), grid_, frame_, all.lowest_m, all.highest_m,
                     [this](const geo::Geodetic& place) { return mean_height_m(place); });
}

void NaturalGround::update_climate(int day, GroundBlock& block) {
    if (!climate_) make_climate();
    finish_land();  // which reads the tables
    climate_->set_day(day);
    climate_->write(block);
}

void NaturalGround::update_land(GroundBlock& block) {
    if (!has_land_) {
        has_land_ = true;
        country_m_ = block.beyond_m;
        if (!climate_) update_climate(0, block);
        begin_land();
    }
    block.land_place = land_place_;
    block.land_cover = {block.land_cover.x, knows_land_ ? 1 : 0,
                        glm::vec2(1.0F / static_cast<float>(1 << level_of_sites()))};
}

void NaturalGround::begin_land() {
    std::shared_ptr<const climate::LandMap> map;
    const climate::Box box = widened(box_of(grid_, frame_.origin()), kLeastAround_deg);
    if (!climate_alone_) map = std::make_shared<const climate::LandMap>(climate_map(), box);
    knows_land_ = map && map->is_known();
    if (!knows_land_) map = nullptr;
    if (map) land_place_ = place_of(box, frame_.origin(), {kAround, kAround});
    making_ = std::async(std::launch::async | std::launch::deferred,
                         [this, map, box] { return make_land(map.get(), box); });
}

LandTexels NaturalGround::make_land(const climate::LandMap* map, const climate::Box& box) const {
    const glm::ivec2 size = pyramid_.size(level_of_sites());
    const climate::LandSites all = sites();
    LandTexels land{.classes = mipmaps_of(map ? texels_of(climate::land_classes(*map, all))
                                              : std::vector<Texel>(all.height_m.size()),
                                          size),
                    .around = {{Texel{}, Texel{}, Texel{}}}};
    append(mipmaps_of(river_texels(all), size), land.classes);
    if (!map) return land;
    land.around = mipmaps_of(classes_around(*map, box), {kAround, kAround});
    append(layer_around(box, [&](double lat_deg,
                                 double lon_deg) { return looks_at(*map, lat_deg, lon_deg); }),
           land.around);
    append(layer_around(box,
                        [&](double lat_deg, double lon_deg) {
                            return Texel{byte_of(map->water(lat_deg, lon_deg)), 0, 0, 0};
                        }),
           land.around);
    return land;
}

void NaturalGround::finish_land() const {
    if (!making_.valid()) return;
    const LandTexels made = making_.get();
    const int around = knows_land_ ? kAround : 1;
    land_classes_ =
        texture_of(made.classes, {pyramid_.size(level_of_sites()), 2}, kLandClassesTexture);
    land_around_ = texture_of(made.around, {around, around, 3}, kLandAroundTexture);
}

gl::Texture NaturalGround::texture_of(const std::vector<std::vector<Texel>>& levels,
                                      const glm::ivec3& extent, const char* name) {
    gl::Texture texture(gl::TextureKind::D2Array, gl::Format::RGBA8, {extent.x, extent.y, extent.z},
                        0, name);
    texture.set_sampling(gl::Filter::Mipmap, gl::Wrap::Clamp);
    for (int level = 0; level < texture.levels(); ++level)
        texture.write(level, {0, 0, 0}, texture.level_extent(level),
                      std::as_bytes(std::span(levels[static_cast<std::size_t>(level)])));
    return texture;
}

int NaturalGround::level_of_sites() const {
    const glm::dvec2 apart_m = grid_.post_spacing_m();
    int level = pyramid_.first_in_memory();
    const auto is_too_fine = [&] {
        const glm::ivec2 size = pyramid_.size(level);
        return std::max(size.x, size.y) > kMostSites ||
               std::sqrt(apart_m.x * apart_m.y) * (1 << level) < kLeastApart_m;
    };
    while (level + 1 < pyramid_.levels() && is_too_fine())
        ++level;
    return level;
}

climate::LandSites NaturalGround::sites() const {
    const int level = level_of_sites();
    const double posts = 1 << level;  // to a site
    return {.height_m = pyramid_.heights(level),
            .apart_m = posts * grid_.post_spacing_m(),
            .place = [this, posts](double column,
                                   double row) { return grid_.place(posts * column, posts * row); },
            .growing = [this](const geo::Geodetic& place,
                              float height_m) { return climate_->growing(place, height_m); }};
}

std::vector<Texel> NaturalGround::classes_around(const climate::LandMap& map,
                                                 const climate::Box& box) const {
    const double middle_rad = radians(0.5 * (box.south_deg + box.north_deg));
    const double wide_deg = (box.east_deg - box.west_deg) * std::max(std::cos(middle_rad), 0.05);
    const Array2d<float> level(kAround, kAround, std::max(country_m_, 0.0F));
    return texels_of(climate::land_classes(
        map, {.height_m = level,
              .apart_m =
                  glm::dvec2(wide_deg, box.north_deg - box.south_deg) * (kDegree_m / (kAround - 1)),
              .place = [&](double column, double row) { return place_in(box, column, row); },
              .growing = [&](const geo::Geodetic& place,
                             float height_m) { return climate_->growing(place, height_m); }}));
}

const gl::Texture* NaturalGround::texture(std::string_view name) const {
    if (name == kLandClassesTexture || name == kLandAroundTexture) finish_land();
    if (name == kClimateTexture) return climate_ ? &climate_->texture() : nullptr;
    if (name == kLandClassesTexture) return land_classes_.name() ? &land_classes_ : nullptr;
    if (name == kLandAroundTexture) return land_around_.name() ? &land_around_ : nullptr;
    return nullptr;
}

}  // namespace relevo::render
