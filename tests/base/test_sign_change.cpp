#include <cmath>

#include "base/sign_change.h"
#include "support/support.h"

namespace relevo {
namespace {

TEST(SignChange, IsWithinTheToleranceOfTheRoot) {
    const auto cubic = [](double x) { return x * x * x - 2; };
    EXPECT_NEAR(sign_change(cubic, 0, cubic(0), 5, cubic(5), 1e-9), std::cbrt(2.0), 1e-9);
    const auto falling = [](double x) { return std::cos(x); };
    EXPECT_NEAR(sign_change(falling, 0, 1, 3, falling(3), 1e-9), std::acos(0.0), 1e-9);
}

TEST(SignChange, OfAJumpIsWhereItJumpsHoweverUnevenItIs) {
    for (const double before : {-1.0, -1e-6})
        for (const double behind : {1.0, 1e4}) {
            const auto jump = [&](double x) { return x < 0.3 ? before : behind; };
            EXPECT_NEAR(sign_change(jump, 0, before, 1, behind, 1e-6), 0.3, 1e-6);
        }
}

TEST(SignChange, OfAFlatRootIsFoundInThreeStepsAHalving) {
    int calls = 0;
    const auto flat = [&](double x) {
        ++calls;
        return std::pow(x - 0.7, 9);
    };
    EXPECT_NEAR(sign_change(flat, 0, flat(0), 1, flat(1), 1e-6), 0.7, 1e-6);
    EXPECT_LE(calls, 2 + 3 * 20);
}

TEST(SignChange, OfASmoothFunctionTakesFewSteps) {
    int calls = 0;
    const auto rising = [&](double t_s) {
        ++calls;
        return std::sin(7.3e-5 * (t_s - 900));
    };
    EXPECT_NEAR(sign_change(rising, 0, rising(0), 1800, rising(1800), 1e-4), 900, 1e-4);
    EXPECT_LE(calls, 2 + 8);
}

}  // namespace
}  // namespace relevo
