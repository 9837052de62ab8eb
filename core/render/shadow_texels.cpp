// Compiled once for each kind of vector that the processor may have.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/shadow_texels.cpp"
#include "render/shadow_texels.h"

#include <algorithm>

#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace relevo::render::HWY_NAMESPACE {

constexpr std::uint32_t kHoles = 0x7bff7bffU;  // GroundLight::kHole twice

// A plain loop, which compilers make vectors of, as wide as the target's.
void EncodeShadows(const light::ClearanceRun& run, std::uint32_t* HWY_RESTRICT halves,
                   std::uint16_t* HWY_RESTRICT shares) {
    const float *const uppers = run.upper_m, *const lowers = run.lower_m;
    const int count = run.count;
    for (int i = 0; i < count; ++i) {
        const float u = uppers[i], l = lowers[i];
        const bool hole = !(u == u);
        const float upper = std::min(kMostMargin, std::max(-kMostMargin, u)),
                    lower = std::min(kMostMargin, std::max(-kMostMargin, l));
        const std::uint32_t pair = half_of(upper) | half_of(lower) << 16;
        halves[i] = hole ? kHoles : pair;
        const float height = std::min(1.0F, std::max(0.0F, upper / std::max(upper - lower, 1e-3F)));
        const float seen = lower >= 0 ? 1.0F : light::quick_share_of_disc(height);
        const auto whole = static_cast<std::uint32_t>(static_cast<int>(255 * seen + 0.5F));
        shares[i] = static_cast<std::uint16_t>(hole ? 0 : whole | 0xff00U);
    }
}

}  // namespace relevo::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace relevo::render {

HWY_EXPORT(EncodeShadows);

void encode_shadows(const light::ClearanceRun& run, std::uint32_t* halves, std::uint16_t* shares) {
    HWY_DYNAMIC_DISPATCH(EncodeShadows)(run, halves, shares);
}

}  // namespace relevo::render
#endif
