#include "climate/land_classes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "base/parallel_for.h"
#include "base/sliding_window.h"
#include "base/units.h"
#include "climate/land_noise.h"
#include "climate/smooth.h"

namespace relevo::climate {
namespace {

constexpr double kEarthRadius_m = 6371000;
constexpr float kSoft = 0.35F;     // temperature of the choice while shares are met
constexpr double kCell_deg = 0.1;  // in which shares are met
constexpr std::size_t kIceLand = static_cast<std::size_t>(Land::Ice);

float& of(LandShares& shares, Land land) {
    return shares[static_cast<std::size_t>(land)];
}

float ramp(float value, float from, float to) {
    return std::clamp((value - from) / (to - from), 0.0F, 1.0F);
}

/// The shape of the ground at the sites.
struct Shape {
    float slope_deg = 0, north = 0;   // north: 1 where a slope looks there, -1 to the south
    float above_m = 0, relief_m = 0;  // over the lowest, and highest over lowest, within 2.5 km
    float hollow = 0;                 // 1 in hollows, -1 on humps
    float high = 0;                   // over the DEM's lower fifth [900 m], 0 to 1
};

/// Heights thinned to some 250 m, and what is around each of them.
class Relief {
  public:
    Relief(const Array2d<float>& height_m, double apart_m)
        : thin_(std::max(1, static_cast<int>(250 / apart_m))) {
        const int width = (height_m.width() - 1) / thin_ + 1;
        const int height = (height_m.height() - 1) / thin_ + 1;
        Array2d<float> few(width, height);
        for (int row = 0; row < height; ++row)
            for (int column = 0; column < width; ++column)
                few.at(column, row) = height_m.at(column * thin_, row * thin_);
        const double cell_m = apart_m * thin_;
        const int reach = std::max(1, static_cast<int>(1250 / cell_m));
        low_ = lowest_around(few, reach);
        high_ = highest_around(few, reach);
        smooth(low_, 0.5 * reach);
        smooth(high_, 0.5 * reach);
        mean_ = few;
        smooth(mean_, std::max(0.4, 300 / cell_m));
    }

    void set(int column, int row, float height_m, Shape& shape) const {
        const double x = static_cast<double>(column) / thin_, y = static_cast<double>(row) / thin_;
        const float low = bilinear(low_, x, y);
        shape.above_m = std::max(0.0F, height_m - low);
        shape.relief_m = bilinear(high_, x, y) - low;
        shape.hollow = std::clamp((bilinear(mean_, x, y) - height_m) / 30, -1.0F, 1.0F);
    }

  private:
    int thin_;
    Array2d<float> low_, high_, mean_;
};

/// What the climate of a site permits, each 0 to 1.
struct Limits {
    float humid, lush;   // lush: warm, too
    float alpine, rock;  // above the tree line; and above closed plants
    float far_below;     // the tree line: 1 some 600 m below it

    explicit Limits(const Growing& growing)
        : humid(ramp(growing.dryness, 0.6F, 1.8F)),
          lush(humid * ramp(growing.temperature_c, 12, 20)) {
        const float season_c = 3.2F + 3.2F * growing.growth;  // mean of the growing season
        alpine = 1 - ramp(season_c, 6.0F, 6.8F);
        rock = alpine * (0.10F + 0.90F * ramp(-season_c, -5.4F, -3.0F));
        far_below = ramp(season_c, 6.0F, 9.5F);
    }
};

/// Shares that the map cannot know: no trees above their line, rock above the plants and on cliffs,
/// shrubs and open woods where warm grassland is rough and half dry.
void correct(LandShares& shares, const Growing& growing, const Limits& limits, const Shape& shape) {
    const auto move = [&](Land from, Land to, float amount) {
        of(shares, from) -= amount;
        of(shares, to) += amount;
    };
    for (const Land land : {Land::Needleleaf, Land::Broadleaf, Land::Crop, Land::Urban}) {
        const float gone = of(shares, land) * limits.alpine * (land == Land::Urban ? 0.8F : 0.95F);
        move(land, Land::Grass, 0.7F * gone);
        move(land, Land::Shrub, 0.3F * gone);
    }
    const float cliff = ramp(shape.slope_deg, 34, 48) * 0.8F * (1 - 0.8F * limits.lush);
    for (const float share : {0.95F * limits.rock, cliff})
        for (const Land land :
             {Land::Needleleaf, Land::Broadleaf, Land::Shrub, Land::Grass, Land::Crop, Land::Urban})
            move(land, Land::Bare, of(shares, land) * share);
    const float rough = 0.6F * ramp(shape.relief_m, 80, 330) * ramp(growing.dryness, 0.35F, 0.65F) *
                        ramp(-growing.dryness, -1.9F, -1.4F) * ramp(growing.temperature_c, 2, 6) *
                        (1 - limits.alpine);
    for (const Land land : {Land::Grass, Land::Bare}) {
        const float part = of(shares, land) * rough * (land == Land::Bare ? 0.5F : 1.0F);
        move(land, Land::Shrub, 0.5F * part);
        move(land, Land::Needleleaf, 0.5F * part);
    }
}

/// How well a site suits each cover, as a logarithm.
LandShares suitability(const Growing& growing, const Limits& limits, const Shape& shape,
                       float mapped_ice) {
    const auto& [humid, lush, alpine, rock, far_below] = limits;
    const float dry = 1 - humid;
    const float slope = shape.slope_deg;
    const float low = (1 - ramp(shape.above_m, 0, 60)) * (1 - ramp(slope, 0, 12));
    const float cliff = ramp(slope, 33, 45) * (1 - 0.8F * lush);
    const float say = ramp(shape.relief_m, 0, 250);  // of relief
    const float ridge = std::clamp(shape.above_m / (shape.relief_m + 40), 0.0F, 1.0F);
    const float forest = -9 * alpine - 3 * cliff + say * (1.5F * ramp(slope, 0, 18) - low) +
                         dry * (0.9F * shape.north + 1.3F * shape.high) +
                         0.25F * shape.hollow * dry;
    const float level = (slope / 7) * (slope / 7);
    LandShares u{};
    of(u, Land::Needleleaf) = forest + 0.9F * (1 - far_below);
    of(u, Land::Broadleaf) = forest - 2.2F * (1 - far_below) + 0.3F * low;
    of(u, Land::Shrub) = 0.7F * alpine * (1 - rock) - 2 * rock - cliff +
                         0.4F * dry * ramp(slope, 0, 15) - 0.3F * low;
    of(u, Land::Grass) = 1.8F * alpine * (1 - rock) - 3 * rock - 2 * cliff -
                         0.3F * say * ramp(slope, 0, 25) * (1 - alpine) + 0.5F * say * low;
    of(u, Land::Crop) = -6 * (1 - far_below) - 0.7F * level + 0.8F * say * low - 1.6F * ridge * say;
    of(u, Land::Bare) = 3.5F * rock + 3.2F * cliff + 0.9F * dry * ramp(slope, 4, 24) -
                        0.6F * shape.hollow * dry +
                        say * humid * (1.4F * ridge + 1.4F * ramp(slope, 0, 30) - 1.4F);
    of(u, Land::Urban) = -5 * (1 - far_below) - 0.7F * level + 1.3F * say * low - 2 * ridge * say;
    of(u, Land::Wetland) = -(slope / 1.2F) * (slope / 1.2F) + 0.8F * low + 0.8F * shape.hollow;
    const float ice =
        std::max(ramp(growing.ice_m, -0.3F, 0.3F), mapped_ice * ramp(growing.ice_m, -2.0F, -1.0F));
    of(u, Land::Ice) = -12 + 16 * ice - 3 * ramp(slope, 45, 55);
    return u;
}

/// The noise that decides between covers.
class Chance {
  public:
    explicit Chance(double apart_m)
        : woods_(2500, 1.5 * apart_m, 3),
          fields_(1800, 1.5 * apart_m, 7),
          open_(1200, 1.5 * apart_m, 5),
          towns_(1600, 1.5 * apart_m, 9) {}

    /// @param at  from the Earth's centre [m]
    void add(const glm::dvec3& at, LandShares& u) {
        const float woods = woods_.at(at), fields = fields_.at(at), open = open_.at(at);
        const float towns = towns_.at(at);
        of(u, Land::Needleleaf) += 0.6F * woods + 0.2F * open;
        of(u, Land::Broadleaf) += 0.6F * woods - 0.2F * open;
        of(u, Land::Shrub) += 0.5F * open;
        of(u, Land::Grass) -= 0.5F * fields;
        of(u, Land::Crop) += 0.8F * fields;
        of(u, Land::Bare) += 0.4F * (open - fields);
        of(u, Land::Urban) += 1.5F * towns;
        of(u, Land::Wetland) -= towns;
        of(u, Land::Ice) += 0.3F * open;
    }

  private:
    LandNoise woods_, fields_, open_, towns_;
};

/// Natural logarithm of a positive number, within 0.01: log2 as a parabola in the mantissa.
float rough_log(float x) {
    const auto bits = std::bit_cast<std::uint32_t>(x);
    const auto exponent = static_cast<float>(static_cast<int>(bits >> 23) - 127);
    const float m = std::bit_cast<float>((bits & 0x7FFFFFU) | 0x3F800000U) - 1;
    return 0.6931472F * (exponent + m * (1.3465553F - 0.3465553F * m));
}

/// Softmax in place.
void choose(LandShares& u, float temperature) {
    const float highest = *std::ranges::max_element(u);
    float sum = 0;
    for (float& value : u)
        sum += value = std::exp(std::max((value - highest) / temperature, -60.0F));
    for (float& value : u)
        value /= sum;
}

/// Corrections by cell of 0.1 degrees that give covers the shares that they should have.
class Balance {
  public:
    Balance(double west_deg, double north_deg, double east_deg, double south_deg)
        : west_(std::floor((west_deg + 180) / kCell_deg)),
          north_(std::floor((90 - north_deg) / kCell_deg)) {
        const double columns = std::floor((east_deg + 180) / kCell_deg) - west_ + 1;
        const double rows = std::floor((90 - south_deg) / kCell_deg) - north_ + 1;
        // Cells of a wide DEM are larger.
        wide_ = std::max(1.0, std::ceil(std::max(columns, rows) / kMostCells));
        bias_ = Array2d<LandShares>(static_cast<int>(columns / wide_) + 1,
                                    static_cast<int>(rows / wide_) + 1);
    }

    void add_sample(double lat_deg, double lon_deg, const LandShares& goal, const LandShares& u) {
        samples_.push_back({cell_of(lat_deg, lon_deg), goal, u});
    }

    /// @param sample_deg2  what a sample stands for
    void find(double sample_deg2) {
        const std::size_t cells = bias_.size();
        std::vector<LandShares> goal(cells), got(cells);
        std::vector<float> count(cells);
        for (const Sample& sample : samples_) {
            count[sample.cell] += 1;
            for (std::size_t i = 0; i < kLands; ++i)
                goal[sample.cell][i] += sample.goal[i];
        }
        for (int step = 0; step < kSteps; ++step) {
            std::ranges::fill(got, LandShares{});
            for (const Sample& sample : samples_) {
                LandShares u = sample.u;
                for (std::size_t i = 0; i < kLands; ++i)
                    u[i] += bias_.data()[sample.cell][i];
                choose(u, kSoft);
                for (std::size_t i = 0; i < kLands; ++i)
                    got[sample.cell][i] += u[i];
            }
            for (std::size_t cell = 0; cell < cells; ++cell)
                for (std::size_t i = 0; i < kIceLand && count[cell] > 0; ++i) {
                    constexpr float kSome = 0.003F, kPart = 0.3F, kMost = 4;
                    const float ratio = (goal[cell][i] / count[cell] + kSome) /
                                        (got[cell][i] / count[cell] + kSome);
                    float& bias = bias_.data()[cell][i];
                    bias = std::clamp(bias + kPart * std::log(ratio), -kMost, kMost);
                }
        }
        // A cell of which little is known has less of a say.
        const double whole = kCell_deg * kCell_deg * wide_ * wide_;
        for (std::size_t cell = 0; cell < cells; ++cell)
            for (float& bias : bias_.data()[cell])
                bias *= static_cast<float>(std::sqrt(
                    std::min(1.0, static_cast<double>(count[cell]) * sample_deg2 / whole)));
    }

    void add(double lat_deg, double lon_deg, LandShares& u) const {
        const double x = ((lon_deg + 180) / kCell_deg - west_) / wide_ - 0.5;
        const double y = ((90 - lat_deg) / kCell_deg - north_) / wide_ - 0.5;
        const LandShares bias = bilinear(bias_, x, y);
        for (std::size_t i = 0; i < kLands; ++i)
            u[i] += bias[i];
    }

  private:
    static constexpr double kMostCells = 128;
    static constexpr int kSteps = 8;

    struct Sample {
        std::size_t cell;
        LandShares goal, u;
    };

    std::size_t cell_of(double lat_deg, double lon_deg) const {
        const auto x = static_cast<int>(((lon_deg + 180) / kCell_deg - west_) / wide_);
        const auto y = static_cast<int>(((90 - lat_deg) / kCell_deg - north_) / wide_);
        const int column = std::clamp(x, 0, bias_.width() - 1);
        const int row = std::clamp(y, 0, bias_.height() - 1);
        return static_cast<std::size_t>(row * bias_.width() + column);
    }

    double west_, north_, wide_ = 1;
    Array2d<LandShares> bias_;  // 0 for ice
    std::vector<Sample> samples_;
};

/// Places of all sites, exact at some and between them linear, in degrees; longitudes go on past
/// 180.
class Places {
  public:
    Places(const LandSites& sites)
        : columns_(sites.height_m.width()), rows_(sites.height_m.height()) {
        lat_ = lon_ = Array2d<float>(kNet, kNet);
        from_centre_m_ = Array2d<std::array<float, 3>>(kNet, kNet);
        const geo::Geodetic middle = sites.place(0.5 * (columns_ - 1), 0.5 * (rows_ - 1));
        middle_lat_ = degrees(middle.lat_rad);
        middle_lon_ = degrees(middle.lon_rad);
        for (int j = 0; j < kNet; ++j)
            for (int i = 0; i < kNet; ++i) {
                const geo::Geodetic at =
                    sites.place((columns_ - 1.0) * i / (kNet - 1), (rows_ - 1.0) * j / (kNet - 1));
                const bool is_place = std::isfinite(at.lat_rad) && std::isfinite(at.lon_rad);
                lat_.at(i, j) =
                    static_cast<float>(is_place ? degrees(at.lat_rad) - middle_lat_ : 0);
                lon_.at(i, j) = static_cast<float>(
                    is_place ? geo::normalized_lon_deg(degrees(at.lon_rad) - middle_lon_) : 0);
                const double lat_rad = is_place ? at.lat_rad : middle.lat_rad;
                const double lon_rad = is_place ? at.lon_rad : middle.lon_rad;
                const double r = kEarthRadius_m * std::cos(lat_rad);
                from_centre_m_.at(i, j) = {static_cast<float>(r * std::cos(lon_rad)),
                                           static_cast<float>(r * std::sin(lon_rad)),
                                           static_cast<float>(kEarthRadius_m * std::sin(lat_rad))};
            }
    }

    glm::dvec2 lat_lon_deg(int column, int row) const {
        const double x = static_cast<double>(column) * (kNet - 1) / std::max(columns_ - 1, 1);
        const double y = static_cast<double>(row) * (kNet - 1) / std::max(rows_ - 1, 1);
        return {middle_lat_ + static_cast<double>(bilinear(lat_, x, y)),
                middle_lon_ + static_cast<double>(bilinear(lon_, x, y))};
    }

    glm::dvec3 from_centre_m(int column, int row) const {
        const double x = static_cast<double>(column) * (kNet - 1) / std::max(columns_ - 1, 1);
        const double y = static_cast<double>(row) * (kNet - 1) / std::max(rows_ - 1, 1);
        const std::array<float, 3> at = bilinear(from_centre_m_, x, y);
        return {at[0], at[1], at[2]};
    }

    Balance balance() const {
        const auto [south, north] = std::ranges::minmax(lat_);
        const auto [west, east] = std::ranges::minmax(lon_);
        return {middle_lon_ + static_cast<double>(west), middle_lat_ + static_cast<double>(north),
                middle_lon_ + static_cast<double>(east), middle_lat_ + static_cast<double>(south)};
    }

    /// From steps along columns and rows to east and north, as unit vectors of the middle.
    std::array<glm::vec2, 2> axes() const {
        const auto axis = [&](int i, int j) {
            constexpr int kMiddle = kNet / 2;
            const glm::vec2 step((lon_.at(kMiddle + i, kMiddle + j) - lon_.at(kMiddle, kMiddle)) *
                                     static_cast<float>(std::cos(radians(middle_lat_))),
                                 lat_.at(kMiddle + i, kMiddle + j) - lat_.at(kMiddle, kMiddle));
            return step / std::max(glm::length(step), 1e-12F);
        };
        return {axis(1, 0), axis(0, 1)};
    }

  private:
    static constexpr int kNet = 33;

    int columns_, rows_;
    double middle_lat_ = 0, middle_lon_ = 0;
    Array2d<float> lat_, lon_;  // off the middle
    Array2d<std::array<float, 3>> from_centre_m_;
};

/// All that decides on the cover of a site.
class Sites {
  public:
    Sites(const LandMap& map, const LandSites& sites)
        : map_(map),
          sites_(sites),
          places_(sites),
          axes_(places_.axes()),
          apart_m_(std::sqrt(sites.apart_m.x * sites.apart_m.y)),
          heights_(filled(sites.height_m)),
          relief_(heights_, apart_m_) {
        std::vector<float> all(heights_.begin(), heights_.end());
        const auto fifth = all.begin() + std::ssize(all) / 5;
        std::nth_element(all.begin(), fifth, all.end());
        lower_fifth_m_ = *fifth;
    }

    const Places& places() const { return places_; }
    double apart_m() const { return apart_m_; }

    /// @returns the logarithm of how likely each cover is, without the balance
    /// @param goal  the shares that covers should have around
    LandShares weigh(int column, int row, Chance& chance, LandShares* goal = nullptr) const {
        const glm::dvec2 at = places_.lat_lon_deg(column, row);
        const geo::Geodetic place = geo::geodetic_deg(at.x, at.y);
        const float height_m = heights_.at(column, row);
        const Growing growing = sites_.growing(place, height_m);
        const Limits limits(growing);
        const Shape shape = shape_at(column, row);
        LandShares shares = map_.shares(at.x, at.y);
        const float mapped_ice = shares[kIceLand] > 0.25F ? 1.0F : 0.0F;
        correct(shares, growing, limits, shape);
        if (goal) *goal = shares;
        LandShares u = suitability(growing, limits, shape, mapped_ice);
        chance.add(places_.from_centre_m(column, row), u);
        for (std::size_t i = 0; i < kLands; ++i)
            u[i] += rough_log(std::max(shares[i], kLeast[i]) + 1e-7F);
        return u;
    }

  private:
    // Of covers that climate and shape may bring where the map has none.
    static constexpr LandShares kLeast{0, 0, .002F, .004F, 0, .004F, 0, 0, .002F};

    /// Voids get the height of the ground beside them: else there would be cliffs around them.
    static Array2d<float> filled(const Array2d<float>& heights) {
        Array2d<float> whole = heights;
        for (float& height : whole)
            if (!std::isfinite(height)) height = 0;
        fill_outwards(std::span(&whole, 1),
                      [&](int column, int row) { return std::isfinite(heights.at(column, row)); });
        return whole;
    }

    Shape shape_at(int column, int row) const {
        const auto height = [&](int i, int j) {
            return heights_.at(std::clamp(i, 0, heights_.width() - 1),
                               std::clamp(j, 0, heights_.height() - 1));
        };
        const glm::vec2 up = (height(column + 1, row) - height(column - 1, row)) /
                                 static_cast<float>(2 * sites_.apart_m.x) * axes_[0] +
                             (height(column, row + 1) - height(column, row - 1)) /
                                 static_cast<float>(2 * sites_.apart_m.y) * axes_[1];
        const float steep = glm::length(up);
        Shape shape;
        shape.slope_deg = static_cast<float>(degrees(std::atan(steep)));
        shape.north = -up.y / std::max(steep, 1e-6F) * std::min(1.0F, shape.slope_deg / 15);
        const float height_m = heights_.at(column, row);
        shape.high = ramp(height_m - lower_fifth_m_, 0, 900);
        relief_.set(column, row, height_m, shape);
        return shape;
    }

    const LandMap& map_;
    const LandSites& sites_;
    Places places_;
    std::array<glm::vec2, 2> axes_;
    double apart_m_;
    Array2d<float> heights_;
    Relief relief_;
    float lower_fifth_m_ = 0;
};

}  // namespace

Array2d<LandShares> land_classes(const LandMap& map, const LandSites& sites) {
    constexpr int kThin = 5, kGrain = 16;
    const int columns = sites.height_m.width(), rows = sites.height_m.height();
    const Sites all(map, sites);
    Balance balance = all.places().balance();
    Chance chance(all.apart_m());
    for (int row = 0; row < rows; row += kThin)
        for (int column = 0; column < columns; column += kThin) {
            LandShares goal{};
            const LandShares u = all.weigh(column, row, chance, &goal);
            const glm::dvec2 at = all.places().lat_lon_deg(column, row);
            balance.add_sample(at.x, at.y, goal, u);
        }
    const double sample_m2 = kThin * kThin * all.apart_m() * all.apart_m();
    const double cosine = std::cos(radians(all.places().lat_lon_deg(columns / 2, rows / 2).x));
    balance.find(sample_m2 / (kDegree_m * kDegree_m * std::max(cosine, 0.01)));
    const float mixed = std::min(0.75F, ramp(static_cast<float>(all.apart_m()), 150, 850));
    Array2d<LandShares> covers(columns, rows);
    parallel_for(0, rows, kGrain, [&](int first, int last) {
        Chance own(all.apart_m());
        for (int row = first; row < last; ++row)
            for (int column = 0; column < columns; ++column) {
                LandShares u = all.weigh(column, row, own);
                const glm::dvec2 at = all.places().lat_lon_deg(column, row);
                balance.add(at.x, at.y, u);
                const auto most = std::ranges::max_element(u) - u.begin();
                if (mixed > 0) choose(u, 0.5F);
                for (float& share : u)
                    share = mixed > 0 ? mixed * share : 0;
                u[static_cast<std::size_t>(most)] += 1 - mixed;
                covers.at(column, row) = u;
            }
    });
    return covers;
}

}  // namespace relevo::climate
