#include "dem/surface.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "base/sliding_window.h"

namespace relevo::dem {
namespace {

using Kind = SurfaceKind;

constexpr std::array<std::array<int, 2>, 8> kNext = {
    {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};

/// A post's number, row by row.
using Post = std::int32_t;

constexpr std::size_t index(int i) {
    return static_cast<std::size_t>(i);
}

class Finder {
  public:
    Finder(const Array2d<float>& heights_m, double apart_m)
        : h_(heights_m),
          columns_(heights_m.width()),
          rows_(heights_m.height()),
          apart_m_(apart_m),
          kind_(columns_, rows_, Kind::Ground),
          house_(columns_, rows_, 0) {}

    Surface find() {
        find_high();
        drop_hills(Kind::Canopy);
        tell_roofs();
        number_houses();
        find_walls();
        find_streets();
        const std::array<double, 5> share = shares();
        return {std::move(kind_), std::move(house_), share};
    }

  private:
    static constexpr double kSlope = 0.15;  // of ground that rises to a crest
    static constexpr double kLow_m = 1;     // lower things are ground
    static constexpr float kRim_m = 2;      // rise of a thing's rim
    static constexpr double kRim = 0.5;     // of a rim rises so
    static constexpr double kTop_m = 2.5, kTopsAround_m = 7.5;
    static constexpr float kMostUneven_m = 4, kEven_m = 1.3F;  // of tops
    static constexpr float kSmooth_m = 0.36F;                  // mean roughness
    static constexpr double kRoofAround_m = 5;                 // over which they are even
    static constexpr double kLeastRoof_m2 = 40, kLone_m2 = 700, kPeaked_m2 = 300, kFull = 0.66;
    static constexpr double kAloneAround_m = 80;
    static constexpr float kAlone = 0.09F;  // of the ground around is roofs
    static constexpr double kTown_m = 45;
    static constexpr float kTown = 0.12F;  // of the ground around streets is houses

    bool has(int x, int y) const { return x >= 0 && y >= 0 && x < columns_ && y < rows_; }
    int posts(double m) const { return std::max(1, static_cast<int>(std::lround(m / apart_m_))); }

    /// Marks what stands above the ground as Canopy.
    void find_high() {
        Array2d<float> level = h_;
        for (float& height : level)
            if (std::isnan(height)) height = 1e6F;
        double before_m = 0;
        for (double reach_m : {0.0, 4.0, 8.0, 15.0, 25.0, 40.0}) {
            reach_m = std::max(reach_m, apart_m_);
            if (reach_m <= before_m) continue;
            // Without what is narrower than twice the reach.
            const int reach = posts(reach_m);
            const Array2d<float> lower = highest_around(lowest_around(level, reach), reach);
            const auto most = static_cast<float>(kLow_m + kSlope * (reach_m - before_m));
            for (int y = 0; y < rows_; ++y)
                for (int x = 0; x < columns_; ++x)
                    if (level.at(x, y) - lower.at(x, y) > most && !std::isnan(h_.at(x, y)))
                        kind_.at(x, y) = Kind::Canopy;
            level = lower;
            before_m = reach_m;
        }
        ground_m_ = std::move(level);
    }

    /// Visits the connected posts of a kind, a vector of them at a time.
    void each_piece(Kind kind, const std::function<void(const std::vector<Post>&)>& visit) const {
        Array2d<std::uint8_t> seen(columns_, rows_, 0);
        std::vector<Post> piece;
        for (Post from = 0; from < columns_ * rows_; ++from) {
            if (kind_.at(from % columns_, from / columns_) != kind ||
                seen.at(from % columns_, from / columns_))
                continue;
            piece.assign(1, from);
            seen.at(from % columns_, from / columns_) = 1;
            for (std::size_t i = 0; i < piece.size(); ++i)
                for (std::size_t k = 0; k < 4; ++k) {
                    const int x = piece[i] % columns_ + kNext[k][0],
                              y = piece[i] / columns_ + kNext[k][1];
                    if (!has(x, y) || kind_.at(x, y) != kind || seen.at(x, y)) continue;
                    seen.at(x, y) = 1;
                    piece.push_back(y * columns_ + x);
                }
            visit(piece);
        }
    }

    void set(const std::vector<Post>& piece, Kind kind) {
        for (const Post post : piece)
            kind_.at(post % columns_, post / columns_) = kind;
    }

    /// Hills and the tops of cliffs go over into the ground on some side.
    void drop_hills(Kind kind) {
        const int reach = posts(3);
        each_piece(kind, [&](const std::vector<Post>& piece) {
            double rim = 0, rises = 0;
            for (const Post post : piece) {
                const int x = post % columns_, y = post / columns_;
                for (std::size_t k = 0; k < 4; ++k) {
                    const int nx = x + kNext[k][0], ny = y + kNext[k][1];
                    if (!has(nx, ny) || kind_.at(nx, ny) != Kind::Ground) continue;
                    const int ix = x - (reach - 1) * kNext[k][0],
                              iy = y - (reach - 1) * kNext[k][1];
                    ++rim;
                    if (has(ix, iy) && h_.at(ix, iy) > h_.at(nx, ny) + kRim_m) ++rises;
                }
            }
            if (rises < kRim * rim) set(piece, Kind::Ground);
        });
    }

    /// How far the tops around a post differ [m]: ridges are level for some way, crowns are not.
    /// @param tops_m  the highest heights near each post
    float unevenness(const Array2d<float>& tops_m, int x, int y, std::vector<float>& room) const {
        constexpr int kAside = 3;  // posts of the window, a few are enough
        room.clear();
        for (int j = -kAside; j <= kAside; ++j)
            for (int i = -kAside; i <= kAside; ++i) {
                const int nx = x + i * posts(kTopsAround_m / kAside),
                          ny = y + j * posts(kTopsAround_m / kAside);
                if (has(nx, ny) && kind_.at(nx, ny) == Kind::Canopy)
                    room.push_back(tops_m.at(nx, ny));
            }
        std::ranges::sort(room);
        return std::min(room[room.size() * 9 / 10] - room[room.size() / 3], kMostUneven_m);
    }

    /// How far a post is off the line between two opposite ones, where that is least [m].
    float roughness(int x, int y) const {
        float least_m = kMostUneven_m;
        for (const std::size_t i : {0, 1, 4, 5}) {
            const auto [dx, dy] = kNext[i];
            if (!has(x + dx, y + dy) || !has(x - dx, y - dy)) continue;
            const float off_m =
                std::abs(h_.at(x + dx, y + dy) + h_.at(x - dx, y - dy) - 2 * h_.at(x, y));
            if (off_m < least_m) least_m = off_m;
        }
        return least_m;
    }

    /// Even tops, or what is smooth like the roofs of halls of several heights.
    void tell_roofs() {
        Array2d<float> tops_m = h_, uneven(columns_, rows_, 0), high(columns_, rows_, 0);
        Array2d<float> rough(columns_, rows_, 0);
        std::vector<float> room;
        for (float& height : tops_m)
            if (std::isnan(height)) height = -1e6F;
        tops_m = highest_around(std::move(tops_m), posts(kTop_m));
        for (int y = 0; y < rows_; ++y)
            for (int x = 0; x < columns_; ++x) {
                if (kind_.at(x, y) != Kind::Canopy) continue;
                uneven.at(x, y) = unevenness(tops_m, x, y, room);
                rough.at(x, y) = roughness(x, y);
                high.at(x, y) = 1;
            }
        rough = mean_around(std::move(rough), posts(kRoofAround_m));
        uneven = mean_around(std::move(uneven), posts(kRoofAround_m));
        high = mean_around(std::move(high), posts(kRoofAround_m));
        for (int y = 0; y < rows_; ++y)
            for (int x = 0; x < columns_; ++x)
                if (kind_.at(x, y) == Kind::Canopy && (uneven.at(x, y) < kEven_m * high.at(x, y) ||
                                                       rough.at(x, y) < kSmooth_m * high.at(x, y)))
                    kind_.at(x, y) = Kind::Roof;
        drop_small();
        drop_hills(Kind::Roof);
        drop_alone();
    }

    /// Mean height above the ground over the greatest: 1 of a box, 1/3 of a cone.
    double fullness(const std::vector<Post>& piece) const {
        double sum = 0, most = 0;
        for (const Post post : piece) {
            const int x = post % columns_, y = post / columns_;
            const double above_m = double{h_.at(x, y)} - double{ground_m_.at(x, y)};
            sum += above_m;
            most = std::max(most, above_m);
        }
        return sum / (most * static_cast<double>(piece.size()));
    }

    /// Roofs that stand alone are crowns, unless they are large, and so are small ones with a peak.
    void drop_alone() {
        const Array2d<float> town = mean_around(those_of(Kind::Roof), posts(kAloneAround_m));
        each_piece(Kind::Roof, [&](const std::vector<Post>& piece) {
            const double area_m2 = static_cast<double>(piece.size()) * apart_m_ * apart_m_;
            const float around = town.at(piece.front() % columns_, piece.front() / columns_);
            const bool peaked = area_m2 < kPeaked_m2 && fullness(piece) < kFull;
            if (peaked || (area_m2 < kLone_m2 && around < kAlone)) set(piece, Kind::Canopy);
        });
    }

    Array2d<float> those_of(Kind kind) const {
        Array2d<float> those(columns_, rows_, 0);
        std::ranges::transform(kind_, those.begin(),
                               [&](Kind of) { return of == kind ? 1.0F : 0.0F; });
        return those;
    }

    /// Small roofs are of what is around them, and so is canopy on roofs.
    void drop_small() {
        const auto few = static_cast<std::size_t>(kLeastRoof_m2 / (apart_m_ * apart_m_));
        for (const auto& [kind, other] :
             {std::pair(Kind::Roof, Kind::Canopy), std::pair(Kind::Canopy, Kind::Roof)})
            each_piece(kind, [&, kind = kind, other = other](const std::vector<Post>& piece) {
                if (piece.size() >= few) return;
                for (const Post post : piece)  // a crown that stands alone stays one
                    for (std::size_t k = 0; k < 4; ++k) {
                        const int x = post % columns_ + kNext[k][0],
                                  y = post / columns_ + kNext[k][1];
                        if (kind == Kind::Canopy && has(x, y) && kind_.at(x, y) == other) {
                            set(piece, other);
                            return;
                        }
                    }
                if (kind == Kind::Roof) set(piece, other);
            });
    }

    void number_houses() {
        std::uint32_t number = 0;
        each_piece(Kind::Roof, [&](const std::vector<Post>& piece) {
            const auto tone = static_cast<std::uint8_t>(1 + (++number * 2654435761U >> 24) % 255);
            for (const Post post : piece)
                house_.at(post % columns_, post / columns_) = tone;
        });
    }

    /// Posts at the edge of a roof that are well below it.
    void find_walls() {
        const Array2d<Kind> before = kind_;
        for (int y = 0; y < rows_; ++y)
            for (int x = 0; x < columns_; ++x) {
                if (before.at(x, y) != Kind::Roof) continue;
                float highest_m = h_.at(x, y);
                bool edge = false;
                for (const auto [dx, dy] : kNext) {
                    if (!has(x + dx, y + dy)) continue;
                    if (before.at(x + dx, y + dy) == Kind::Roof)
                        highest_m = std::max(highest_m, h_.at(x + dx, y + dy));
                    else
                        edge = true;
                }
                if (edge && highest_m > h_.at(x, y) + 1.2 * apart_m_) kind_.at(x, y) = Kind::Wall;
            }
    }

    void find_streets() {
        Array2d<float> built(columns_, rows_, 0);
        for (int y = 0; y < rows_; ++y)
            for (int x = 0; x < columns_; ++x)
                built.at(x, y) = house_.at(x, y) != 0 ? 1 : 0;
        built = mean_around(std::move(built), posts(kTown_m));
        for (int y = 0; y < rows_; ++y)
            for (int x = 0; x < columns_; ++x)
                if (kind_.at(x, y) == Kind::Ground && !std::isnan(h_.at(x, y)) &&
                    built.at(x, y) > kTown)
                    kind_.at(x, y) = Kind::Street;
    }

    std::array<double, 5> shares() const {
        std::array<double, 5> shares{};
        double all = 0;
        for (int y = 0; y < rows_; ++y)
            for (int x = 0; x < columns_; ++x) {
                if (std::isnan(h_.at(x, y))) continue;
                ++all;
                ++shares[static_cast<std::size_t>(kind_.at(x, y))];
            }
        for (double& share : shares)
            share /= std::max(all, 1.0);
        return shares;
    }

    const Array2d<float>& h_;
    int columns_, rows_;
    double apart_m_;
    Array2d<Kind> kind_;
    Array2d<std::uint8_t> house_;
    Array2d<float> ground_m_;
};

double apart_m_of(const Grid& grid) {
    const glm::dvec2 apart_m = grid.post_spacing_m();
    return std::sqrt(apart_m.x * apart_m.y);
}

}  // namespace

Surface find_surface(const Array2d<float>& heights_m, const Grid& grid) {
    return Finder(heights_m, apart_m_of(grid)).find();
}

bool looks_like_surface(const Array2d<float>& heights_m, const Grid& grid) {
    constexpr int kMost = 1000;  // posts along a side
    constexpr double kLeastRoofs = 0.01;
    if (apart_m_of(grid) > kSurfacePosts_m) return false;
    const int columns = std::min(heights_m.width(), kMost),
              rows = std::min(heights_m.height(), kMost);
    const int left = (heights_m.width() - columns) / 2, top = (heights_m.height() - rows) / 2;
    Array2d<float> window(columns, rows);
    for (int y = 0; y < rows; ++y)
        std::ranges::copy(heights_m.row(top + y).subspan(static_cast<std::size_t>(left),
                                                         static_cast<std::size_t>(columns)),
                          window.row(y).begin());
    const Surface found = Finder(window, apart_m_of(grid)).find();
    return found.share[static_cast<std::size_t>(SurfaceKind::Roof)] > kLeastRoofs;
}

}  // namespace relevo::dem
