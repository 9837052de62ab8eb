#include <algorithm>
#include <cmath>
#include <complex>
#include <random>
#include <vector>

#include "base/fft.h"
#include "base/units.h"
#include "support/support.h"

namespace relevo::test_fft {
namespace {

std::complex<float> normal(std::mt19937& random) {
    std::normal_distribution<float> value;
    const float real = value(random);
    return {real, value(random)};
}

TEST(Fft, AgreesWithTheSumThatDefinesIt) {
    constexpr int n = 16;
    std::mt19937 random(1);
    ComplexField field(n, n);
    for (int r = 0; r < n; ++r)
        for (int c = 0; c < n; ++c)
            field.at(c, r) = normal(random);
    ComplexField transformed = field;
    fft(transformed, false);
    for (int ky = 0; ky < n; ++ky)
        for (int kx = 0; kx < n; ++kx) {
            std::complex<double> sum = 0;
            for (int r = 0; r < n; ++r)
                for (int c = 0; c < n; ++c)
                    sum += std::complex<double>(field.at(c, r)) *
                           std::polar(1.0, -2 * kPi * (kx * c + ky * r) / n);
            EXPECT_NEAR(std::abs(sum - std::complex<double>(transformed.at(kx, ky))), 0, 2e-5);
        }
}

TEST(Fft, ThereAndBackIsTheSame) {
    constexpr int n = 1024;
    std::mt19937 random(1);
    ComplexField field(n, n);
    for (int r = 0; r < n; ++r)
        for (int c = 0; c < n; ++c)
            field.at(c, r) = normal(random);
    ComplexField back = field;
    fft(back, false);
    fft(back, true);
    std::vector<double> errors;
    for (int r = 0; r < n; ++r)
        for (int c = 0; c < n; ++c)
            errors.push_back(std::abs(back.at(c, r) - field.at(c, r)));
    test::print_accuracy("fft there and back, of numbers up to 3.5", errors, "", 7e-6);
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 7e-6);
}

}  // namespace
}  // namespace relevo::test_fft
