#pragma once

#include <cstdint>

#include <glm/glm.hpp>

/// Random functions that are the same on every run: integer hashes, and noises built on them.
/// All of them are periodic, so that tiles fit together.
namespace relevo::ground {

/// A hash of up to three coordinates and a seed; every bit depends on every bit.
/// Source: the 32-bit mixer "lowbias32" of C. Wellons, Prospecting for Hash Functions, 2018 (public
/// domain), over a sum of the coordinates times the primes of xxHash.
std::uint32_t hash(std::uint32_t seed, int x, int y);
std::uint32_t hash(std::uint32_t seed, int x, int y, int z);

/// The same as a number, 0 <= u < 1.
float hash_unit(std::uint32_t seed, int x, int y = 0, int z = 0);

/// A number with mean 0 and standard deviation 1 (the sum of four uniform ones).
float hash_normal(std::uint32_t seed, int x, int y = 0, int z = 0);

/// A grid of cells that may be turned and drawn out, and still fits the tile.
///
/// Its coordinates are q = (a s + b t, c s + d t), with whole numbers a to d. One step over the
/// tile's edge in s is a step by (a, c) cells, in t by (b, d), so cells that are so far apart are
/// one.
class Lattice {
  public:
    /// @param a, b  cells along the first direction that a step over the tile in s and in t passes
    /// @param c, d  the same along the second direction; a d - b c > 0 is the number of cells
    Lattice(int a, int b, int c, int d)
        : a_(a), b_(b), c_(c), d_(d), reciprocal_(1 / static_cast<float>(a * d - b * c)) {}
    /// Square cells, not turned.
    explicit Lattice(int cells) : Lattice(cells, 0, 0, cells) {}

    /// Square root of 5, 2.24, times as fine, and turned by 26.6 degrees: times ((2, 1), (-1, 2)).
    Lattice finer() const { return {2 * a_ + c_, 2 * b_ + d_, 2 * c_ - a_, 2 * d_ - b_}; }

    glm::vec2 at(float s, float t) const {
        return {static_cast<float>(a_) * s + static_cast<float>(b_) * t,
                static_cast<float>(c_) * s + static_cast<float>(d_) * t};
    }
    /// The one of all cells that are one by the tile's edges.
    glm::ivec2 wrapped(int i, int j) const;

  private:
    int a_, b_, c_, d_;
    float reciprocal_;  ///< of the number of cells
};

/// Gradient noise in the plane, with unit gradients in 16 directions, zero at every lattice point.
/// @param q  in cells of the lattice
/// @returns -1..1, standard deviation about 0.30
float gradient_noise(std::uint32_t seed, const Lattice& lattice, glm::vec2 q);

/// Octaves of gradient_noise, each on the finer() lattice and `gain` times as strong, divided by
/// the root of the sum of their squares, so that the standard deviation stays that of one. As every
/// octave is turned against the one before, their lattices do not show as a weave.
/// @param cells    of the first octave
/// @param s, t     place in the tile; any number, the tile repeats
float fractal_noise(std::uint32_t seed, const Lattice& cells, float s, float t, int octaves,
                    float gain = 0.5f);
inline float fractal_noise(std::uint32_t seed, float s, float t, int cells, int octaves,
                           float gain = 0.5f) {
    return fractal_noise(seed, Lattice(cells), s, t, octaves, gain);
}

/// Where a place is among the cells that a jittered grid of points has around them.
struct Cells {
    float nearest = 0;        ///< distance to the nearest point [cells]
    float edge = 0;           ///< distance to the nearest border of its cell [cells]
    std::uint32_t id = 0;     ///< of the cell; wraps with the tile
    std::uint32_t other = 0;  ///< of the cell across that border
    glm::vec2 offset{0, 0};   ///< from the nearest point to here [cells]
};

/// Worley's cells over the tile, with exact distances to their borders.
/// @param jitter  0 is a regular grid, 1 anywhere in the cell
/// Source: S. Worley, A Cellular Texture Basis Function, SIGGRAPH 1996, doi:10.1145/237170.237267
Cells cells(std::uint32_t seed, const Lattice& lattice, float s, float t, float jitter = 1.0f);

/// Perlin's improved noise in space: 12 gradients, quintic fade, zero at every lattice point.
/// His table of permutations is replaced by hash(), so that any period and seed can be had.
/// @returns -1..1
/// Source: K. Perlin, Improving Noise, ACM Transactions on Graphics 21(3), 2002,
/// doi:10.1145/566654.566636
float perlin_noise(std::uint32_t seed, double x, double y, double z, int period);

}  // namespace relevo::ground
