#include "climate/rivers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <queue>
#include <vector>

#include <glm/glm.hpp>

namespace relevo::climate {
namespace {

constexpr float kNarrowest = 0.004F;  // rivers that are drawn, in sites
constexpr int kNobody = -1;

/// Water that the climate leaves of the rain [mm a year]: CoverColumn::dryness() is rain over what
/// the warmth takes in dry country, and evaporation can take twice that.
float runoff_mm(const Growing& growing) {
    const float limit_mm = std::max(20 * growing.temperature_c + 140, 60.0F);
    const float dryness = std::max(growing.dryness, 0.01F);
    return dryness * limit_mm * std::exp(-2 / dryness);
}

/// Where the water of each site goes, and the sites from the mouths upwards.
/// source: L. Wang and H. Liu, Int. J. Geogr. Inf. Sci. 20 (2006), 193: least-cost search with a
/// queue; what lies in a hollow drains over the lowest point of its rim
class Drainage {
  public:
    explicit Drainage(const Array2d<float>& height_m)
        : height_m_(height_m),
          width_(height_m.width()),
          rows_(height_m.height()),
          to_(height_m.size(), kNobody),
          is_reached_(height_m.size(), false),
          level_m_(height_m.size(), std::numeric_limits<float>::quiet_NaN()) {
        upwards_.reserve(height_m.size());
        for (int row = 0; row < rows_; ++row)
            for (int column = 0; column < width_; ++column)
                if (is_mouth(column, row)) reach(row * width_ + column, kNobody, -kFar_m);
        while (!queue_.empty()) {
            const Site site = queue_.top();
            queue_.pop();
            turn_downhill(site);
            upwards_.push_back(site.index);
            level_m_[static_cast<std::size_t>(site.index)] = site.level_m;
            climb_from(site);
        }
    }

    const std::vector<int>& upwards() const { return upwards_; }
    /// The next site downstream; kNobody: a mouth.
    int to(int index) const { return to_[static_cast<std::size_t>(index)]; }
    bool is_land(int index) const { return height_m_.data()[index] > 0; }  // not of NaN
    /// Of the water, which is level in hollows.
    float level_m(int index) const { return level_m_[static_cast<std::size_t>(index)]; }

  private:
    static constexpr float kFar_m = 1e6F;

    struct Site {
        float level_m;
        int number, index;  // number: what was reached first goes first
        bool operator<(const Site& other) const {
            return level_m != other.level_m ? level_m > other.level_m : number > other.number;
        }
    };

    bool is_mouth(int column, int row) const {
        return column == 0 || row == 0 || column == width_ - 1 || row == rows_ - 1 ||
               !is_land(row * width_ + column);
    }

    void reach(int index, int to, float least_m) {
        const auto at = static_cast<std::size_t>(index);
        if (is_reached_[at]) return;
        is_reached_[at] = true;
        to_[at] = to;
        const float height_m = is_land(index) ? height_m_.data()[index] : 0;
        queue_.push({std::max(height_m, least_m), number_++, index});
    }

    template <typename F>
    void for_around(int index, F&& each) const {
        const int column = index % width_, row = index / width_;
        for (int j = std::max(row - 1, 0); j <= std::min(row + 1, rows_ - 1); ++j)
            for (int i = std::max(column - 1, 0); i <= std::min(column + 1, width_ - 1); ++i)
                each(j * width_ + i, i != column && j != row);
    }

    void climb_from(const Site& site) {
        for_around(site.index, [&](int index, bool) { reach(index, site.index, site.level_m); });
    }

    /// By the steepest way to what is known to drain. Where all is level: as it was reached.
    void turn_downhill(const Site& site) {
        if (to(site.index) == kNobody) return;
        float steepest = 0;
        for_around(site.index, [&](int index, bool is_corner) {
            const float down = site.level_m - level_m_[static_cast<std::size_t>(index)];
            const float steep = is_corner ? down * std::numbers::sqrt2_v<float> / 2 : down;
            if (!(steep > steepest)) return;  // so of what has no level yet
            steepest = steep;
            to_[static_cast<std::size_t>(site.index)] = index;
        });
    }

    const Array2d<float>& height_m_;
    int width_, rows_, number_ = 0;
    std::vector<int> to_, upwards_;
    std::vector<bool> is_reached_;
    std::vector<float>
        level_m_;  // that water stands at in hollows, else the height; NaN: not known
    std::priority_queue<Site> queue_;
};

/// Discharge of each site [m3/s].
std::vector<float> discharges(const Drainage& drainage, const LandSites& sites) {
    constexpr int kEvery = 8;  // sites to one whose climate is asked for
    constexpr double kYear_s = 365.25 * 86400;
    const int width = sites.height_m.width(), rows = sites.height_m.height();
    Array2d<float> runoff((width - 1) / kEvery + 1, (rows - 1) / kEvery + 1);
    for (int j = 0; j < runoff.height(); ++j)
        for (int i = 0; i < runoff.width(); ++i) {
            const float height_m = sites.height_m.at(kEvery * i, kEvery * j);
            const geo::Geodetic place = sites.place(kEvery * i, kEvery * j);
            if (std::isfinite(place.lat_rad) && std::isfinite(place.lon_rad))
                runoff.at(i, j) = runoff_mm(sites.growing(place, height_m > 0 ? height_m : 0));
        }
    const auto a_mm =
        static_cast<float>(1e-3 * sites.apart_m.x * sites.apart_m.y / kYear_s);  // [m3/s]
    std::vector<float> discharge(sites.height_m.size());
    const std::vector<int>& upwards = drainage.upwards();
    for (auto index = upwards.rbegin(); index != upwards.rend(); ++index) {
        float& here = discharge[static_cast<std::size_t>(*index)];
        if (drainage.is_land(*index))
            here += a_mm * runoff.at(*index % width / kEvery, *index / width / kEvery);
        const int to = drainage.to(*index);
        if (to != kNobody) discharge[static_cast<std::size_t>(to)] += here;
    }
    return discharge;
}

/// Rivers as lines from site to site, and what is near them.
class Lines {
  public:
    Lines(const LandSites& sites)
        : sites_(sites),
          drainage_(sites.height_m),
          width_(sites.height_m.width()),
          apart_m_(static_cast<float>(std::sqrt(sites.apart_m.x * sites.apart_m.y))),
          at_m_(sites.height_m.size()),
          width_m_(sites.height_m.size()) {
        const std::vector<float> discharge = discharges(drainage_, sites);
        for (std::size_t i = 0; i < discharge.size(); ++i)
            width_m_[i] = 7 * std::sqrt(discharge[i]) * calm(static_cast<int>(i));
        for (const int index : drainage_.upwards())
            if (is_river(index)) rivers_.push_back(index);
        bend();
    }

    Array2d<RiverSite> drawn() const {
        Array2d<RiverSite> near(width_, sites_.height_m.height());
        Array2d<float> nearest(width_, near.height(), std::numeric_limits<float>::max());
        for (const int index : rivers_)
            if (const int to = drainage_.to(index); to != kNobody) draw(index, to, near, nearest);
        return near;
    }

  private:
    bool is_river(int index) const {
        return width_m_[static_cast<std::size_t>(index)] > kNarrowest * apart_m_ &&
               drainage_.is_land(index);
    }

    /// How far water runs on a valley's floor, 0 to 1: torrents lie under trees and boulders.
    float calm(int index) const {
        constexpr int kSites = 6;  // heights in whole metres have steps
        constexpr float kCalm = 0.01F, kSteep = 0.03F;
        int down = index, steps = 0;
        for (; steps < kSites; ++steps) {
            const int next = drainage_.to(down);
            if (next == kNobody || !drainage_.is_land(next)) break;
            down = next;
        }
        const float fall_m = drainage_.level_m(index) - drainage_.level_m(down);
        const float steep = fall_m / (apart_m_ * static_cast<float>(std::max(steps, 1)));
        return 1 - std::clamp((steep - kCalm) / (kSteep - kCalm), 0.0F, 1.0F);
    }

    glm::vec2 step_m() const { return glm::vec2(sites_.apart_m); }
    glm::vec2& at(int index) { return at_m_[static_cast<std::size_t>(index)]; }
    const glm::vec2& at(int index) const { return at_m_[static_cast<std::size_t>(index)]; }

    /// Ways in eighths of a turn become rounder: each site moves towards the widest river that
    /// comes to it, and to the next.
    void bend() {
        std::vector<int> from(at_m_.size(), kNobody);
        for (const int index : rivers_) {
            at(index) = step_m() * glm::vec2(index % width_, index / width_);
            const int to = drainage_.to(index);
            if (to == kNobody) continue;
            at(to) = step_m() * glm::vec2(to % width_, to / width_);
            int& widest = from[static_cast<std::size_t>(to)];
            if (widest == kNobody || width_m_[static_cast<std::size_t>(index)] >
                                         width_m_[static_cast<std::size_t>(widest)])
                widest = index;
        }
        constexpr int kTimes = 6;
        for (int time = 0; time < kTimes; ++time) {
            const std::vector<glm::vec2> before = at_m_;
            for (const int index : rivers_) {
                const int to = drainage_.to(index), up = from[static_cast<std::size_t>(index)];
                if (to == kNobody || up == kNobody) continue;
                at(index) = 0.5F * before[static_cast<std::size_t>(index)] +
                            0.25F * (before[static_cast<std::size_t>(to)] +
                                     before[static_cast<std::size_t>(up)]);
            }
        }
    }

    void draw(int from, int to, Array2d<RiverSite>& near, Array2d<float>& nearest) const {
        const glm::vec2 a = at(from), b = at(to);
        const float long_m = glm::length(b - a);
        if (!(long_m > 0)) return;
        const glm::vec2 along = (b - a) / long_m;
        glm::vec2 normal(-along.y, along.x);
        if (normal.y < 0) normal = -normal;
        const float reach_m = static_cast<float>(kRiverReach) * apart_m_;
        const glm::ivec2 first = glm::max(glm::ivec2(floor((min(a, b) - reach_m) / step_m())), 0);
        const glm::ivec2 last = glm::min(glm::ivec2(ceil((max(a, b) + reach_m) / step_m())),
                                         glm::ivec2(near.width(), near.height()) - 1);
        for (int row = first.y; row <= last.y; ++row)
            for (int column = first.x; column <= last.x; ++column) {
                const glm::vec2 site = step_m() * glm::vec2(column, row);
                const float way_m = glm::dot(site - a, along);
                const float t_m = glm::clamp(way_m, 0.0F, long_m);
                // A site past the end of this stretch does not have it: its line would go on.
                if (std::abs(way_m - t_m) > 0.75F * apart_m_) continue;
                const float width_m = width_m_[static_cast<std::size_t>(from)];
                const float away_m = glm::length(site - a - t_m * along);
                // A site within one of several rivers has the widest, or creeks would cut it up.
                const float outside_m = std::max(away_m, apart_m_) - 0.5F * width_m;
                if (away_m > reach_m || !(outside_m < nearest.at(column, row))) continue;
                nearest.at(column, row) = outside_m;
                near.at(column, row) = {std::atan2(normal.y, normal.x), glm::dot(a - site, normal),
                                        width_m};
            }
    }

    const LandSites& sites_;
    Drainage drainage_;
    int width_;
    float apart_m_;
    std::vector<int> rivers_;  // upwards
    std::vector<glm::vec2> at_m_;
    std::vector<float> width_m_;
};

}  // namespace

Array2d<RiverSite> rivers(const LandSites& sites) {
    if (std::max(sites.apart_m.x, sites.apart_m.y) > kRiverSites_m)
        return {sites.height_m.width(), sites.height_m.height()};
    return Lines(sites).drawn();
}

}  // namespace relevo::climate
