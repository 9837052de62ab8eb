#include "field.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "base/parallel_for.h"

namespace relevo::ground {
namespace {

/// Frequencies that flatten() touches: -7 to 7 cycles a tile.
constexpr int kFlattened = 7;

/// exp(2 pi i k x) for k = 0 to kFlattened at the centre of texel x of n.
struct Waves {
    std::array<float, kFlattened + 1> cosine, sine;
};

std::vector<Waves> waves(int n) {
    std::vector<Waves> table(static_cast<std::size_t>(n));
    for (int x = 0; x < n; ++x)
        for (std::size_t k = 0; k <= kFlattened; ++k) {
            const double angle = 2 * std::numbers::pi * static_cast<double>(k) * (x + 0.5) / n;
            table[static_cast<std::size_t>(x)].cosine[k] = static_cast<float>(std::cos(angle));
            table[static_cast<std::size_t>(x)].sine[k] = static_cast<float>(std::sin(angle));
        }
    return table;
}

/// Sum over a row of value times exp(-2 pi i k x), k = 0 to kFlattened.
using RowWaves = std::array<std::complex<double>, kFlattened + 1>;

/// exp(-2 pi i k y) or its inverse for any sign of k.
std::complex<double> wave(const Waves& at, int k, bool inverse) {
    const auto index = static_cast<std::size_t>(std::abs(k));
    const double sine = (k < 0) == inverse ? -at.sine[index] : at.sine[index];
    return {at.cosine[index], sine};
}

}  // namespace

void for_each_texel(int n, const std::function<void(int, int)>& body) {
    parallel_for(0, n, 16, [&](int first, int last) {
        for (int r = first; r < last; ++r)
            for (int c = 0; c < n; ++c)
                body(c, r);
    });
}

Field make_field(int n, const std::function<float(float, float)>& value) {
    Field field(n, n);
    const float step = 1.0f / static_cast<float>(n);
    for_each_texel(n, [&](int c, int r) {
        field.at(c, r) =
            value((static_cast<float>(c) + 0.5f) * step, (static_cast<float>(r) + 0.5f) * step);
    });
    return field;
}

Field make_coarse_field(int n, const std::function<float(float, float)>& value) {
    return make_field(n / 4, value);
}

float sample(const Field& field, float s, float t) {
    const int n = field.width();
    assert(std::has_single_bit(static_cast<unsigned>(n)));
    const float x = s * static_cast<float>(n) - 0.5f, y = t * static_cast<float>(n) - 0.5f;
    // Rounded down without std::floor, which is a call on the processors this is compiled for;
    // sides are powers of two, so a mask wraps.
    int c0 = static_cast<int>(x), r0 = static_cast<int>(y);
    c0 -= x < static_cast<float>(c0);
    r0 -= y < static_cast<float>(r0);
    const float u = x - static_cast<float>(c0), v = y - static_cast<float>(r0);
    c0 &= n - 1;
    r0 &= n - 1;
    const int c1 = (c0 + 1) & (n - 1), r1 = (r0 + 1) & (n - 1);
    return (field.at(c0, r0) * (1 - u) + field.at(c1, r0) * u) * (1 - v) +
           (field.at(c0, r1) * (1 - u) + field.at(c1, r1) * u) * v;
}

float smooth_sample(const Field& field, float s, float t) {
    const int n = field.width();
    assert(std::has_single_bit(static_cast<unsigned>(n)));
    const float x = s * static_cast<float>(n), y = t * static_cast<float>(n);
    int c = static_cast<int>(x), r = static_cast<int>(y);
    c -= x < static_cast<float>(c);
    r -= y < static_cast<float>(r);
    const auto weights = [](float f) {  // f from the texel's centre, -0.5..0.5
        return std::array<float, 3>{0.5f * (0.5f - f) * (0.5f - f), 0.75f - f * f,
                                    0.5f * (0.5f + f) * (0.5f + f)};
    };
    const auto across = weights(x - static_cast<float>(c) - 0.5f);
    const auto up = weights(y - static_cast<float>(r) - 0.5f);
    float sum = 0;
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
            sum += across[static_cast<std::size_t>(i)] * up[static_cast<std::size_t>(j)] *
                   field.at((c + i - 1) & (n - 1), (r + j - 1) & (n - 1));
    return sum;
}

double mean(const Field& field) {
    // By rows first, so that the result does not depend on the threads.
    std::vector<double> sums(static_cast<std::size_t>(field.height()));
    parallel_for(0, field.height(), 32, [&](int first, int last) {
        for (int r = first; r < last; ++r)
            for (const float value : field.row(r))
                sums[static_cast<std::size_t>(r)] += static_cast<double>(value);
    });
    double sum = 0;
    for (const double s : sums)
        sum += s;
    return sum / static_cast<double>(field.size());
}

Field blurred(const Field& field, double sigma_px) {
    const int n = field.width();
    const int radius = static_cast<int>(std::ceil(3.5 * sigma_px));
    assert(radius < n);
    std::vector<float> kernel(static_cast<std::size_t>(2 * radius + 1));
    double sum = 0;
    for (int i = -radius; i <= radius; ++i)
        sum += std::exp(-0.5 * i * i / (sigma_px * sigma_px));
    for (int i = -radius; i <= radius; ++i)
        kernel[static_cast<std::size_t>(i + radius)] =
            static_cast<float>(std::exp(-0.5 * i * i / (sigma_px * sigma_px)) / sum);

    Field across(n, n), result(n, n);
    parallel_for(0, n, 16, [&](int first, int last) {
        std::vector<float> padded(static_cast<std::size_t>(n + 2 * radius));
        for (int r = first; r < last; ++r) {
            for (int i = 0; i < n + 2 * radius; ++i)
                padded[static_cast<std::size_t>(i)] = field.at((i - radius + n) % n, r);
            const auto out = across.row(r);
            for (std::size_t k = 0; k < kernel.size(); ++k)
                for (std::size_t c = 0; c < out.size(); ++c)
                    out[c] += kernel[k] * padded[c + k];
        }
    });
    parallel_for(0, n, 16, [&](int first, int last) {
        for (int r = first; r < last; ++r) {
            const auto out = result.row(r);
            for (int k = -radius; k <= radius; ++k) {
                const auto in = across.row((r + k + n) % n);
                const float weight = kernel[static_cast<std::size_t>(k + radius)];
                for (std::size_t c = 0; c < out.size(); ++c)
                    out[c] += weight * in[c];
            }
        }
    });
    return result;
}

double flatten_gain(double cycles) {
    if (cycles == 0) return 1;
    const double x = std::clamp((cycles - 4) / 4, 0.0, 1.0);
    return x * x * (3 - 2 * x);
}

void flatten(Field& field) {
    const int n = field.width();
    const std::vector<Waves> table = waves(n);
    std::vector<RowWaves> rows(static_cast<std::size_t>(n));
    parallel_for(0, n, 16, [&](int first, int last) {
        for (int r = first; r < last; ++r) {
            std::array<float, kFlattened + 1> cosine{}, sine{};
            for (int c = 0; c < n; ++c)
                for (std::size_t k = 0; k <= kFlattened; ++k) {
                    cosine[k] += field.at(c, r) * table[static_cast<std::size_t>(c)].cosine[k];
                    sine[k] -= field.at(c, r) * table[static_cast<std::size_t>(c)].sine[k];
                }
            for (std::size_t k = 0; k <= kFlattened; ++k)
                rows[static_cast<std::size_t>(r)][k] = {cosine[k], sine[k]};
        }
    });
    // What is to be taken away, as waves: frequencies kx >= 0 only, as the field is real.
    Array2d<std::complex<double>> away(kFlattened + 1, 2 * kFlattened + 1);
    for (int ky = -kFlattened; ky <= kFlattened; ++ky)
        for (int kx = 0; kx <= kFlattened; ++kx) {
            std::complex<double> sum = 0;
            for (int r = 0; r < n; ++r)
                sum += rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(kx)] *
                       wave(table[static_cast<std::size_t>(r)], ky, false);
            const double twice = kx == 0 ? 1 : 2;
            away.at(kx, ky + kFlattened) =
                sum * twice * (1 - flatten_gain(std::hypot(kx, ky))) / (static_cast<double>(n) * n);
        }
    parallel_for(0, n, 16, [&](int first, int last) {
        for (int r = first; r < last; ++r) {
            std::array<float, kFlattened + 1> cosine{}, sine{};
            for (int kx = 0; kx <= kFlattened; ++kx) {
                std::complex<double> sum = 0;
                for (int ky = -kFlattened; ky <= kFlattened; ++ky)
                    sum += away.at(kx, ky + kFlattened) *
                           wave(table[static_cast<std::size_t>(r)], ky, true);
                cosine[static_cast<std::size_t>(kx)] = static_cast<float>(sum.real());
                sine[static_cast<std::size_t>(kx)] = static_cast<float>(sum.imag());
            }
            for (int c = 0; c < n; ++c)
                for (std::size_t k = 0; k <= kFlattened; ++k)
                    field.at(c, r) -= cosine[k] * table[static_cast<std::size_t>(c)].cosine[k] -
                                      sine[k] * table[static_cast<std::size_t>(c)].sine[k];
        }
    });
}

}  // namespace relevo::ground
