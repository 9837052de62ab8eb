#include "base/fft.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/parallel_for.h"

namespace relevo {
namespace {

using Complex = std::complex<float>;

/// Radix-2, decimation in time, with the twiddle factors of the whole length.
void transform(Complex* values, int n, const std::vector<Complex>& twiddle) {
    for (int i = 1, j = 0; i < n; ++i) {
        int bit = n >> 1;
        for (; j & bit; bit >>= 1)
            j ^= bit;
        j ^= bit;
        if (i < j) std::swap(values[i], values[j]);
    }
    for (int half = 1; half < n; half *= 2) {
        const int stride = n / (2 * half);
        for (int start = 0; start < n; start += 2 * half)
            for (int k = 0; k < half; ++k) {
                const Complex w = twiddle[static_cast<std::size_t>(k * stride)];
                const Complex b = values[start + k + half];
                // Written out: std::complex's own product checks for infinities.
                const Complex wb{w.real() * b.real() - w.imag() * b.imag(),
                                 w.real() * b.imag() + w.imag() * b.real()};
                values[start + k + half] = values[start + k] - wb;
                values[start + k] += wb;
            }
    }
}

}  // namespace

void fft(ComplexField& field, bool inverse) {
    const int n = field.width();
    assert(field.height() == n && std::has_single_bit(static_cast<unsigned>(n)));
    std::vector<Complex> twiddle(static_cast<std::size_t>(n / 2 + 1));
    for (int k = 0; k <= n / 2; ++k) {
        const double angle = (inverse ? 2 : -2) * std::numbers::pi * k / n;
        twiddle[static_cast<std::size_t>(k)] = {static_cast<float>(std::cos(angle)),
                                                static_cast<float>(std::sin(angle))};
    }
    parallel_for(0, n, 16, [&](int first, int last) {
        for (int r = first; r < last; ++r)
            transform(field.row(r).data(), n, twiddle);
    });
    const float scale = inverse ? 1.0f / (static_cast<float>(n) * static_cast<float>(n)) : 1.0f;
    // Columns in groups of a cache line.
    constexpr int kGroup = 8;
    parallel_for(0, (n + kGroup - 1) / kGroup, 2, [&](int first, int last) {
        std::vector<Complex> columns(static_cast<std::size_t>(kGroup * n));
        for (int g = first; g < last; ++g) {
            const int begin = g * kGroup, count = std::min(kGroup, n - begin);
            for (int r = 0; r < n; ++r)
                for (int c = 0; c < count; ++c)
                    columns[static_cast<std::size_t>(c * n + r)] = field.at(begin + c, r);
            for (int c = 0; c < count; ++c)
                transform(&columns[static_cast<std::size_t>(c * n)], n, twiddle);
            for (int r = 0; r < n; ++r)
                for (int c = 0; c < count; ++c)
                    field.at(begin + c, r) = columns[static_cast<std::size_t>(c * n + r)] * scale;
        }
    });
}

}  // namespace relevo
