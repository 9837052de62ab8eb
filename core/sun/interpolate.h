#pragma once

namespace relevo::sun {

/// Lagrange's weights for equidistant nodes at -1, 0, 1, 2; exact for cubics. `p` in [0, 1] is
/// where the error is least.
struct CubicWeights {
    double w[4];
    explicit constexpr CubicWeights(double p)
        : w{-p * (p - 1) * (p - 2) / 6, (p + 1) * (p - 1) * (p - 2) / 2, -(p + 1) * p * (p - 2) / 2,
            (p + 1) * p * (p - 1) / 6} {}
};

/// Likewise for nodes at -2, -1, 0, 1, 2, 3; exact for quintics.
struct QuinticWeights {
    double w[6];
    explicit constexpr QuinticWeights(double p) : w{} {
        const double a = p + 2, b = p + 1, c = p - 1, d = p - 2, e = p - 3;
        w[0] = -b * p * c * d * e / 120;
        w[1] = a * p * c * d * e / 24;
        w[2] = -a * b * c * d * e / 12;
        w[3] = a * b * p * d * e / 12;
        w[4] = -a * b * p * c * e / 24;
        w[5] = a * b * p * c * d / 120;
    }
};

}  // namespace relevo::sun
