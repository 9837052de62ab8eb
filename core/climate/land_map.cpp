#include "climate/land_map.h"

#include <algorithm>
#include <cmath>

#include "base/paths.h"
#include "base/units.h"
#include "climate/cover.h"
#include "climate/earth_grids.h"
#include "climate/land_colour.h"
#include "climate/smooth.h"

namespace relevo::climate {
namespace {

/// The grids in the file's order.
enum LandLayer { kClass, kGround, kTowns, kLandLayers };
constexpr std::array<EarthGrids::Layer, kLandLayers> kLandGrids{
    {{"class", 1, 8}, {"ground", 3, 8}, {"towns", 1, 8}}};

constexpr double kClass_deg = 0.05, kGround_deg = 0.2;
constexpr int kMostCells = 400, kMostGround = 64;  // along a side of the nets
constexpr int kMargin = 14;                        // cells around the box, for what reaches into it
constexpr int kCity = 13;                          // IGBP

/// What IGBP's classes 0 to 16 are made of, by their definitions.
enum Part { kTreePart, kGrassPart = 2, kBarePart = 4, kUrbanPart = 5, kWaterPart = 8, kParts };
using Parts = std::array<float, kParts>;
constexpr std::array<Parts, 17> kMade{{{0, 0, 0, 0, 0, 0, 0, 0, 1},
                                       {.84F, .05F, .08F, 0, .03F, 0, 0, 0, 0},
                                       {.93F, .03F, .03F, .01F, 0, 0, 0, 0, 0},
                                       {.72F, .14F, .12F, 0, .02F, 0, 0, 0, 0},
                                       {.84F, .04F, .08F, .03F, 0, .01F, 0, 0, 0},
                                       {.84F, .05F, .08F, .02F, 0, .01F, 0, 0, 0},
                                       {.05F, .70F, .13F, .02F, .10F, 0, 0, 0, 0},
                                       {.02F, .38F, .22F, 0, .38F, 0, 0, 0, 0},
                                       {.50F, .13F, .27F, .06F, .03F, .01F, 0, 0, 0},
                                       {.20F, .15F, .50F, .08F, .06F, .01F, 0, 0, 0},
                                       {.03F, .10F, .72F, .06F, .08F, .01F, 0, 0, 0},
                                       {.15F, .10F, .15F, 0, 0, 0, .55F, 0, .05F},
                                       {.07F, .02F, .09F, .79F, .01F, .02F, 0, 0, 0},
                                       {.17F, .03F, .15F, .08F, .01F, .56F, 0, 0, 0},
                                       {.28F, .06F, .17F, .46F, .01F, .02F, 0, 0, 0},
                                       {0, 0, 0, 0, .1F, 0, 0, .9F, 0},
                                       {0, .03F, .03F, 0, .94F, 0, 0, 0, 0}}};

/// Share of a forest's trees that have needles; below 0: no forest.
float needles_of(int igbp) {
    constexpr std::array<float, 6> kNeedles{-1, 1, 0, 1, 0, 0.5F};
    return igbp < std::ssize(kNeedles) ? kNeedles[static_cast<std::size_t>(igbp)] : -1;
}

/// How many of a place's trees have needles, where no forest is mapped nearby.
float expected_needles(const CoverColumn& column) {
    const double relief_m = column.normals().relief_m;
    const Months month_c = column.temperature_c(relief_m);
    const double coldest_c = *std::ranges::min_element(month_c);
    if (coldest_c >= 12) return 0.02F;
    const double dry = std::clamp((1.7 - column.dryness(relief_m)) / 0.6, 0.0, 1.0);
    const double share =
        0.2 + (9 - column.mean_c(relief_m)) / 8 + (coldest_c < 2 ? 0.6 * dry : 0.0);
    return static_cast<float>(std::clamp(share, 0.05, 0.95));
}

/// Of the cell that a place is in.
int value_at(EarthGrids& grids, LandLayer layer, int plane, double lat_deg, double lon_deg) {
    const int columns = grids.columns(layer), rows = grids.rows(layer);
    const double x = (lon_deg + 180) / 360, y = (90 - lat_deg) / 180;
    return grids.cell(layer, plane,
                      std::clamp(static_cast<int>((x - std::floor(x)) * columns), 0, columns - 1),
                      std::clamp(static_cast<int>(y * rows), 0, rows - 1));
}

struct MappedCell {
    int igbp = 0;
    Parts parts{};
};

/// @param wetter  how far open shrub and barren ground have more plants than in deserts
MappedCell cell_at(EarthGrids& grids, double lat_deg, double lon_deg, float wetter) {
    MappedCell cell{.igbp = std::clamp(value_at(grids, kClass, 0, lat_deg, lon_deg), 0, 16)};
    cell.parts = kMade[static_cast<std::size_t>(cell.igbp)];
    Parts& parts = cell.parts;
    if (cell.igbp != kCity && parts[kWaterPart] < 0.5F) {  // lights tell of towns where it does not
        const float light = static_cast<float>(value_at(grids, kTowns, 0, lat_deg, lon_deg)) / 15;
        const float town = 0.5F * light * light;
        const float more = std::max(0.0F, town - parts[kUrbanPart]);
        for (float& part : parts)
            part *= 1 - more / std::max(1 - parts[kUrbanPart], 0.2F);
        parts[kUrbanPart] = std::max(parts[kUrbanPart], town);
    }
    if (cell.igbp >= 6 && cell.igbp <= 10) {
        const float plants = 0.75F * wetter * parts[kBarePart];
        parts[kBarePart] -= plants;
        parts[kGrassPart] += plants;
    }
    return cell;
}

/// What leaves the trees of a net's cells have.
class Forests {
  public:
    Forests(int columns, int rows) : needles_(columns, rows), forests_(columns, rows) {}

    void add(int column, int row, float needles) {
        if (needles < 0) return;
        needles_.at(column, row) += needles;
        forests_.at(column, row) += 1;
    }

    /// Share of needles, as in the forests around, most of all in the cell's own.
    Array2d<float> needles(double sigma, float expected) const {
        Array2d<float> sum = needles_, count = forests_;
        smooth(sum, sigma);
        smooth(count, sigma);
        for (std::size_t i = 0; i < sum.size(); ++i) {
            const float around = (sum.data()[i] + 0.02F * expected) / (count.data()[i] + 0.02F);
            const float own =
                forests_.data()[i] > 0 ? needles_.data()[i] / forests_.data()[i] : around;
            sum.data()[i] = 0.7F * own + 0.3F * around;
        }
        return sum;
    }

  private:
    Array2d<float> needles_, forests_;
};

}  // namespace

LandMap::Net LandMap::Net::over(const Box& box, double cell_deg, int margin) {
    Net net{.cell_deg = cell_deg};
    // On the globe's own cells, so that every box has the same ones.
    const auto first = [&](double from_deg) { return std::floor(from_deg / cell_deg) - margin; };
    const auto last = [&](double to_deg) { return std::ceil(to_deg / cell_deg) + margin; };
    const double west = first(box.west_deg + 180), east = last(box.east_deg + 180);
    const double north = first(90 - box.north_deg), south = last(90 - box.south_deg);
    net.west_deg = west * cell_deg - 180;
    net.north_deg = 90 - north * cell_deg;
    net.columns = static_cast<int>(east - west);
    net.rows = static_cast<int>(south - north);
    return net;
}

template <typename Value>
Value LandMap::Net::at(const Array2d<Value>& cells, double lat_deg, double lon_deg) const {
    return bilinear(cells, (lon_deg - west_deg) / cell_deg - 0.5,
                    (north_deg - lat_deg) / cell_deg - 0.5);
}

LandMap::LandMap(const ClimateMap& climate, const Box& box) {
    const double side_deg = std::max(box.east_deg - box.west_deg, box.north_deg - box.south_deg);
    const double step = std::max(1.0, std::ceil(side_deg / kClass_deg / kMostCells));
    net_ = Net::over(box, kClass_deg * step, kMargin);
    const double ground_step = std::max(1.0, std::ceil(side_deg / kGround_deg / kMostGround));
    ground_net_ = Net::over(box, kGround_deg * ground_step, 1);
    EarthGrids grids(share_dir() / "data/climate/land.bin", "land 1", kLandGrids);
    read_shares(grids, climate);
    read_ground(grids);
    find_tint(climate);
}

void LandMap::read_shares(EarthGrids& grids, const ClimateMap& climate) {
    const CoverColumn middle(climate.at(geo::geodetic_deg(
        std::clamp(net_.lat_deg(net_.rows / 2), -89.0, 89.0), net_.lon_deg(net_.columns / 2))));
    const auto wetter = static_cast<float>(
        std::clamp((middle.dryness(middle.normals().relief_m) - 0.7) / 0.6, 0.0, 1.0));
    const int step = static_cast<int>(std::lround(net_.cell_deg / kClass_deg));
    std::array<Array2d<float>, kParts> parts;
    parts.fill(Array2d<float>(net_.columns, net_.rows));
    Forests forests(net_.columns, net_.rows);
    const int samples = std::min(step, 3);
    for (int row = 0; row < net_.rows; ++row)
        for (int column = 0; column < net_.columns; ++column)
            for (int k = 0; k < samples * samples; ++k) {
                const double up = (k / samples + 0.5) / samples - 0.5;
                const double right = (k % samples + 0.5) / samples - 0.5;
                const MappedCell cell =
                    cell_at(grids, net_.lat_deg(row) + up * net_.cell_deg,
                            net_.lon_deg(column) + right * net_.cell_deg, wetter);
                for (std::size_t part = 0; part < kParts; ++part)
                    parts[part].at(column, row) +=
                        cell.parts[part] / static_cast<float>(samples * samples);
                forests.add(column, row, needles_of(cell.igbp));
            }
    const Array2d<float> needles = forests.needles(5.0 / step, expected_needles(middle));
    std::array<Array2d<float>, kLands> lands;
    lands[0] = lands[1] = parts[kTreePart];
    for (std::size_t i = 0; i < needles.size(); ++i) {
        lands[0].data()[i] *= needles.data()[i];
        lands[1].data()[i] *= 1 - needles.data()[i];
    }
    for (std::size_t land = 2; land < kLands; ++land)
        lands[land] = std::move(parts[land - 1]);
    water_ = std::move(parts[kWaterPart]);
    spread_shares(std::move(lands));
}

void LandMap::spread_shares(std::array<Array2d<float>, kLands> lands) {
    Array2d<float> land(net_.columns, net_.rows);
    std::ranges::transform(water_, land.begin(), [](float water) { return 1 - water; });
    known_ = std::ranges::any_of(land, [](float share) { return share > 0; });
    if (!known_) return;
    constexpr double kBlur = 0.7;  // cells
    smooth(land, kBlur);
    smooth(water_, kBlur);
    for (Array2d<float>& share : lands)
        smooth(share, kBlur);
    // Off the map's coast it is as at the nearest land.
    constexpr float kSomeLand = 0.02F;
    fill_outwards(std::span(lands),
                  [&](int column, int row) { return land.at(column, row) >= kSomeLand; });
    shares_ = Array2d<LandShares>(net_.columns, net_.rows);
    for (std::size_t i = 0; i < land.size(); ++i) {
        float sum = 0;
        for (const Array2d<float>& share : lands)
            sum += share.data()[i];
        for (std::size_t k = 0; k < kLands; ++k)
            shares_.data()[i][k] = lands[k].data()[i] / std::max(sum, 1e-6F);
    }
}

void LandMap::read_ground(EarthGrids& grids) {
    const int columns = ground_net_.columns, rows = ground_net_.rows;
    has_ground_ = Array2d<float>(columns, rows);
    for (Array2d<float>& band : ground_)
        band = Array2d<float>(columns, rows);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            for (int band = 0; band < 3; ++band) {
                const int value = value_at(grids, kGround, band, ground_net_.lat_deg(row),
                                           ground_net_.lon_deg(column));
                const float root = 3 * static_cast<float>(value) / 255;
                ground_[static_cast<std::size_t>(band)].at(column, row) = root * root;
                if (value > 0) has_ground_.at(column, row) = 1;
            }
}

LandShares LandMap::shares(double lat_deg, double lon_deg) const {
    return known_ ? net_.at(shares_, lat_deg, lon_deg) : LandShares{};
}

float LandMap::water(double lat_deg, double lon_deg) const {
    return net_.at(water_, lat_deg, lon_deg);
}

std::optional<Colour> LandMap::ground(double lat_deg, double lon_deg) const {
    constexpr float kEnough = 0.2F;
    const float has = ground_net_.at(has_ground_, lat_deg, lon_deg);
    if (has <= kEnough) return std::nullopt;
    Colour colour{};
    for (std::size_t band = 0; band < 3; ++band)
        colour[band] = ground_net_.at(ground_[band], lat_deg, lon_deg) / has;
    return colour;
}

Colour LandMap::tint(double lat_deg, double lon_deg) const {
    Colour tint{};
    for (std::size_t band = 0; band < 3; ++band)
        tint[band] = std::exp2(ground_net_.at(tint_[band], lat_deg, lon_deg));
    return tint;
}

void LandMap::find_tint(const ClimateMap& climate) {
    for (Array2d<float>& band : tint_)
        band = Array2d<float>(ground_net_.columns, ground_net_.rows);
    for (int row = 0; row < ground_net_.rows; ++row)
        for (int column = 0; column < ground_net_.columns; ++column) {
            const double lat = std::clamp(ground_net_.lat_deg(row), -89.9, 89.9);
            const double lon = ground_net_.lon_deg(column);
            const std::optional<Colour> ground = this->ground(lat, lon);
            if (!ground || !known_) continue;
            const Colour tint = tint_of(CoverColumn(climate.at(geo::geodetic_deg(lat, lon))),
                                        shares(lat, lon), *ground);
            for (std::size_t band = 0; band < 3; ++band)
                tint_[band].at(column, row) = std::log2(tint[band]);
        }
    for (Array2d<float>& band : tint_)
        smooth(band, 0.5);
}

}  // namespace relevo::climate
