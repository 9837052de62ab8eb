#include "noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace relevo::ground {
namespace {

std::uint32_t finalised(std::uint32_t h) {
    h ^= h >> 16;
    h *= 0x7FEB352Du;
    h ^= h >> 15;
    h *= 0x846CA68Bu;
    return h ^ h >> 16;
}

int wrapped(int i, int period) {
    const int r = i % period;
    return r < 0 ? r + period : r;
}

/// std::floor without the call that it is on processors of 2003, which this is compiled for.
int floor_int(float x) {
    const int i = static_cast<int>(x);
    return i - (x < static_cast<float>(i));
}

/// a / positive, rounded down; exact while |a| is less than 2^22.
int floor_divided(int a, float reciprocal) {
    return floor_int((static_cast<float>(a) + 0.5f) * reciprocal);
}

/// 6t^5 - 15t^4 + 10t^3: first and second derivatives vanish at 0 and 1 (Perlin 2002).
template <typename T>
T fade(T t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}

float lerp(float a, float b, float t) {
    return a + t * (b - a);
}

}  // namespace

std::uint32_t hash(std::uint32_t seed, int x, int y) {
    return finalised(seed * 0x9E3779B9u + static_cast<std::uint32_t>(x) * 0x85EBCA77u +
                     static_cast<std::uint32_t>(y) * 0xC2B2AE3Du);
}

std::uint32_t hash(std::uint32_t seed, int x, int y, int z) {
    return finalised(hash(seed, x, y) + static_cast<std::uint32_t>(z) * 0x27D4EB2Fu);
}

float hash_unit(std::uint32_t seed, int x, int y, int z) {
    return static_cast<float>(hash(seed, x, y, z) >> 8) * 0x1p-24f;
}

float hash_normal(std::uint32_t seed, int x, int y, int z) {
    const std::uint32_t a = hash(seed, x, y, z), b = finalised(a + 0x9E3779B9u);
    const auto sum = static_cast<float>((a & 0xFFFFu) + (a >> 16) + (b & 0xFFFFu) + (b >> 16));
    return (sum * 0x1p-16f - 2.0f) * 1.7320508f;
}

glm::ivec2 Lattice::wrapped(int i, int j) const {
    // Steps over the tile's edges that lead to (i, j): the inverse matrix, rounded down. In whole
    // numbers, so that both sides of an edge agree.
    const int s = floor_divided(d_ * i - b_ * j, reciprocal_);
    const int t = floor_divided(a_ * j - c_ * i, reciprocal_);
    return {i - a_ * s - b_ * t, j - c_ * s - d_ * t};
}

float gradient_noise(std::uint32_t seed, const Lattice& lattice, glm::vec2 q) {
    static const std::array<glm::vec2, 16> kGradients = [] {
        std::array<glm::vec2, 16> g;
        for (int i = 0; i < 16; ++i) {
            const double angle = (i + 0.5) * std::numbers::pi / 8;
            g[static_cast<std::size_t>(i)] = {std::cos(angle), std::sin(angle)};
        }
        return g;
    }();
    const int i = floor_int(q.x), j = floor_int(q.y);
    const float dx = q.x - static_cast<float>(i), dy = q.y - static_cast<float>(j);
    const auto corner = [&](int ci, int cj) {
        const glm::ivec2 cell = lattice.wrapped(i + ci, j + cj);
        const glm::vec2 g = kGradients[hash(seed, cell.x, cell.y) & 15u];
        return g.x * (dx - static_cast<float>(ci)) + g.y * (dy - static_cast<float>(cj));
    };
    const float u = fade(dx), v = fade(dy);
    return 1.4f * lerp(lerp(corner(0, 0), corner(1, 0), u), lerp(corner(0, 1), corner(1, 1), u), v);
}

float fractal_noise(std::uint32_t seed, const Lattice& cells, float s, float t, int octaves,
                    float gain) {
    float sum = 0, strength = 1, square = 0;
    Lattice lattice = cells;
    for (int o = 0; o < octaves; ++o) {
        sum += strength * gradient_noise(seed + static_cast<std::uint32_t>(o) * 101u, lattice,
                                         lattice.at(s, t));
        square += strength * strength;
        strength *= gain;
        lattice = lattice.finer();
    }
    return sum / std::sqrt(square);
}

// In one piece: what it finds about the near points decides about the far ones.
Cells cells(std::uint32_t seed, const Lattice& lattice, float s, float t, float jitter) {
    const glm::vec2 p = lattice.at(s, t);
    const int i0 = floor_int(p.x), j0 = floor_int(p.y);
    const glm::vec2 inside = p - glm::vec2(i0, j0);
    struct Point {
        glm::vec2 away;  ///< from it to here
        float square;
        std::uint32_t id;
    };
    std::array<Point, 25> points;
    std::size_t count = 0, nearest = 0;
    const auto look_at = [&](int di, int dj) {
        const glm::ivec2 cell = lattice.wrapped(i0 + di, j0 + dj);
        const std::uint32_t id = hash(seed, cell.x, cell.y);
        const glm::vec2 jump{static_cast<float>(id & 0xFFFFu) * 0x1p-16f,
                             static_cast<float>(id >> 16) * 0x1p-16f};
        const glm::vec2 away = inside - (glm::vec2(di, dj) + 0.5f + (jump - 0.5f) * jitter);
        points[count] = {away, glm::dot(away, away), id};
        if (points[count].square < points[nearest].square) nearest = count;
        ++count;
    };
    for (int dj = -1; dj <= 1; ++dj)
        for (int di = -1; di <= 1; ++di)
            look_at(di, dj);

    Cells result;
    result.edge = 9;
    std::size_t other = 0;
    const auto border_with = [&](std::size_t k) {
        if (k == nearest) return;
        // From here to the plane half way between the two points.
        const glm::vec2 between = points[nearest].away - points[k].away;
        const float edge = (points[k].square - points[nearest].square) /
                           (2 * std::sqrt(glm::dot(between, between)));
        if (edge < result.edge) {
            result.edge = edge;
            other = k;
        }
    };
    for (std::size_t k = 0; k < 9; ++k)
        border_with(k);
    // Points two cells away may be neighbours too; most are too far even at their nearest.
    const auto gap = [jitter](float from, int cell) {
        const float middle = static_cast<float>(cell) + 0.5f;
        return std::max(0.0f, std::abs(from - middle) - 0.5f * jitter);
    };
    const float reach = std::sqrt(points[nearest].square) + 2 * result.edge;
    const std::size_t first_far = count;
    const std::size_t nearest_of_near = nearest;
    for (int dj = -2; dj <= 2; ++dj)
        for (int di = -2; di <= 2; ++di) {
            if (std::abs(di) < 2 && std::abs(dj) < 2) continue;
            const float x = gap(inside.x, di), y = gap(inside.y, dj);
            if (x * x + y * y < reach * reach) look_at(di, dj);
        }
    if (nearest != nearest_of_near) {
        result.edge = 9;
        for (std::size_t k = 0; k < first_far; ++k)
            border_with(k);
    }
    for (std::size_t k = first_far; k < count; ++k)
        border_with(k);
    result.id = points[nearest].id;
    result.other = points[other].id;
    result.offset = points[nearest].away;
    result.nearest = std::sqrt(points[nearest].square);
    return result;
}

float perlin_noise(std::uint32_t seed, double x, double y, double z, int period) {
    const double fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
    const int x0 = wrapped(static_cast<int>(fx), period);
    const int y0 = wrapped(static_cast<int>(fy), period);
    const int z0 = wrapped(static_cast<int>(fz), period);
    const double dx = x - fx, dy = y - fy, dz = z - fz;
    const auto corner = [&](int i, int j, int k) {
        const std::uint32_t h =
            hash(seed, wrapped(x0 + i, period), wrapped(y0 + j, period), wrapped(z0 + k, period)) &
            15u;
        // Edges of the cube; four come twice, to fill 16 (Perlin 2002, figure 1).
        const double ox = dx - i, oy = dy - j, oz = dz - k;
        const double u = h < 8 ? ox : oy;
        const double v = h < 4 ? oy : h == 12 || h == 14 ? ox : oz;
        return ((h & 1) == 0 ? u : -u) + ((h & 2) == 0 ? v : -v);
    };
    const double u = fade(dx), v = fade(dy), w = fade(dz);
    const auto mix = [](double a, double b, double f) { return a + f * (b - a); };
    const auto slice = [&](int k) {
        return mix(mix(corner(0, 0, k), corner(1, 0, k), u),
                   mix(corner(0, 1, k), corner(1, 1, k), u), v);
    };
    return static_cast<float>(mix(slice(0), slice(1), w));
}

}  // namespace relevo::ground
