// Compiled once for each vector instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/shadow_texels.cpp"
#include "render/shadow_texels.h"

#include <algorithm>

#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace relevo::render::HWY_NAMESPACE {

constexpr std::uint32_t kVoidPair = 0x7bff7bffU;  // GroundLight::kVoidClearance twice

// A plain loop, which compilers vectorise for the target.
void EncodeShadows(const light::ClearanceRun& run, std::uint32_t* HWY_RESTRICT clearances,
                   std::uint16_t* HWY_RESTRICT fractions) {
    const float *const uppers = run.upper_m, *const lowers = run.lower_m;
    const int count = run.count;
    for (int i = 0; i < count; ++i) {
        const float u = uppers[i], l = lowers[i];
        const bool is_void = !(u == u);
        const float upper = std::min(kMaxClearance_m, std::max(-kMaxClearance_m, u)),
                    lower = std::min(kMaxClearance_m, std::max(-kMaxClearance_m, l));
        const std::uint32_t pair = to_half(upper) | to_half(lower) << 16;
        clearances[i] = is_void ? kVoidPair : pair;
        const float height = std::min(1.0F, std::max(0.0F, upper / std::max(upper - lower, 1e-3F)));
        const float fraction = lower >= 0 ? 1.0F : light::quick_share_of_disc(height);
        const auto wis_void = static_cast<std::uint32_t>(static_cast<int>(255 * fraction + 0.5F));
        fractions[i] = static_cast<std::uint16_t>(is_void ? 0 : wis_void | 0xff00U);
    }
}

}  // namespace relevo::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace relevo::render {

HWY_EXPORT(EncodeShadows);

void encode_shadows(const light::ClearanceRun& run, std::uint32_t* clearances,
                    std::uint16_t* fractions) {
    HWY_DYNAMIC_DISPATCH(EncodeShadows)(run, clearances, fractions);
}

}  // namespace relevo::render
#endif
