#pragma once

namespace relevo {

/// Where a function that rises to one highest point and falls after it has that point, by golden
/// section (J. Kiefer, Proc. Amer. Math. Soc. 4 (1953) 502).
/// @param a, c       a < c
/// @param tolerance  of the place, above the spacing of doubles there
template <typename F>
double highest_place(F&& f, double a, double c, double tolerance) {
    constexpr double kGolden = 0.6180339887498949;
    double x1 = c - kGolden * (c - a), x2 = a + kGolden * (c - a);
    double f1 = f(x1), f2 = f(x2);
    while (c - a > tolerance) {
        if (f1 > f2) {
            c = x2;
            x2 = x1;
            f2 = f1;
            x1 = c - kGolden * (c - a);
            f1 = f(x1);
        } else {
            a = x1;
            x1 = x2;
            f1 = f2;
            x2 = a + kGolden * (c - a);
            f2 = f(x2);
        }
    }
    return (a + c) / 2;
}

}  // namespace relevo
