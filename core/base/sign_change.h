#pragma once

#include <algorithm>

namespace relevo {

/// The place where a function changes its sign: a root, or a jump through zero. False position with
/// the Illinois rule (Dowell and Jarratt, BIT 11, 1971); every third step halves the bracket, which
/// jumps and flat roots need.
/// @param a, b       a < b
/// @param fa, fb     f(a) and f(b), of different signs
/// @param tolerance  of the place, above the spacing of doubles there
template <typename F>
double sign_change(F&& f, double a, double fa, double b, double fb, double tolerance) {
    int side = 0;
    for (int step = 1; b - a > tolerance; ++step) {
        double c = step % 3 == 0 ? (a + b) / 2 : (a * fb - b * fa) / (fb - fa);
        // Beside an end that has come near the root, a look across it closes the bracket.
        c = std::clamp(c, a + tolerance / 2, b - tolerance / 2);
        const double fc = f(c);
        if (fc == 0) return c;
        if ((fc > 0) == (fb > 0)) {
            b = c;
            fb = fc;
            if (side == -1) fa /= 2;
            side = -1;
        } else {
            a = c;
            fa = fc;
            if (side == 1) fb /= 2;
            side = 1;
        }
    }
    return (a + b) / 2;
}

}  // namespace relevo
