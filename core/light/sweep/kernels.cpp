// Compiled once for each kind of vector that the processor may have.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "light/sweep/kernels.cpp"
// Vectors without a fixed size cannot be kept in arrays, as those below are.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include "light/sweep/kernels.h"

#include <algorithm>
#include <type_traits>

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace relevo::light::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kVectorFloats>;
using V = hn::Vec<Floats>;

constexpr Floats kFloats;
constexpr int kWidth = static_cast<int>(hn::MaxLanes(Floats()));

/// a + weight * (b - a), each step rounded.
HWY_INLINE V lerp(V a, V b, V weight) {
    return hn::Add(a, hn::Mul(weight, hn::Sub(b, a)));
}
HWY_INLINE V ground_at(const float* ground_m, const Crossing& at) {
    return lerp(hn::LoadU(kFloats, ground_m + at.p), hn::LoadU(kFloats, ground_m + at.q),
                hn::Set(kFloats, at.weight));
}
/// first, first + 1, first + 2 ...
HWY_INLINE V count_from(int first) {
    return hn::Iota(kFloats, static_cast<float>(first));
}

/// Goes over `count` numbers: calls `some` with how many vectors it is to do at once, and from
/// where on. Four as long as there are so many, as they still fit into registers; then one.
template <typename Some>
HWY_INLINE void by_vectors(int count, const Some& some) {
    int i = 0;
    for (; i + 4 * kWidth <= count; i += 4 * kWidth)
        some(std::integral_constant<int, 4>(), i);
    for (; i < count; i += kWidth)
        some(std::integral_constant<int, 1>(), i);
}

/// Raises vectors to ground, from the i-th ray on.
template <int kVectors>
HWY_INLINE void raise(V (&height)[kVectors], const float* ground_m, const Crossing* crossings,
                      int crossing_count, int i) {
    for (const Crossing* at = crossings; at < crossings + crossing_count; ++at)
        for (int k = 0; k < kVectors; ++k)
            height[k] = hn::Max(ground_at(ground_m + i + k * kWidth, *at), height[k]);
}

void TiltRow(const RowTilt& row) {
    const V nothing = hn::Set(kFloats, kNothing_m), base = hn::Set(kFloats, row.height_offset_m),
            fall = hn::Set(kFloats, row.fall_m), ramp = hn::Set(kFloats, row.fall_per_line_m),
            on = hn::Set(kFloats, row.post_offset);
    const auto tilted = [&](V h, int i) {
        const V fallen = hn::Add(fall, hn::Mul(ramp, hn::Add(count_from(row.line + i), on)));
        return hn::IfThenElse(hn::IsNaN(h), nothing, hn::Add(hn::Add(h, base), fallen));
    };
    int i = 0;
    for (; i + kWidth <= row.count; i += kWidth) {
        hwy::Prefetch(row.from_m + i + row.stride);
        hn::StoreU(tilted(hn::LoadU(kFloats, row.from_m + i), i), kFloats, row.to_m + i);
    }
    if (i == row.count) return;
    float last[kWidth] = {};
    std::copy(row.from_m + i, row.from_m + row.count, last);
    hn::StoreU(tilted(hn::LoadU(kFloats, last), i), kFloats, last);
    std::copy(last, last + (row.count - i), row.to_m + i);
}

void RaiseLines(float* height_m, int count, const float* ground_m, const Crossing* crossings,
                int crossing_count) {
    by_vectors(count, [&](auto vectors, int i) {
        constexpr int kVectors = decltype(vectors)::value;
        V height[kVectors];
        for (int k = 0; k < kVectors; ++k)
            height[k] = hn::LoadU(kFloats, height_m + i + k * kWidth);
        raise(height, ground_m, crossings, crossing_count, i);
        for (int k = 0; k < kVectors; ++k)
            hn::StoreU(height[k], kFloats, height_m + i + k * kWidth);
    });
}

void LookForShadows(const ShadowLook& look) {
    const V nothing = hn::Set(kFloats, kNothing_m), fall = hn::Set(kFloats, look.fall_m),
            ramp = hn::Set(kFloats, look.fall_per_line_m), on = hn::Set(kFloats, look.post_offset),
            base = hn::Set(kFloats, look.height_offset_m), floor = hn::Set(kFloats, look.floor_m),
            weight = hn::Set(kFloats, look.weight), low = hn::Set(kFloats, -1e20F);  // no ground
    by_vectors(look.count, [&](auto vectors, int i) {
        constexpr int kVectors = decltype(vectors)::value;
        V fallen[kVectors], height[kVectors];
        for (int k = 0; k < kVectors; ++k) {
            const int at = i + k * kWidth;
            fallen[k] = hn::Add(fall, hn::Mul(ramp, hn::Add(count_from(look.line + at), on)));
            height[k] = nothing;
            if (!look.left_m) continue;
            const V least = hn::Add(hn::Sub(floor, base), fallen[k]);
            const V a = hn::LoadU(kFloats, look.left_m + at),
                    b = hn::LoadU(kFloats, look.right_m + at);
            height[k] = lerp(hn::IfThenElse(hn::Ge(a, least), a, nothing),
                             hn::IfThenElse(hn::Ge(b, least), b, nothing), weight);
        }
        raise(height, look.ground_m, look.crossings, look.crossing_count, i);
        for (int k = 0; k < kVectors; ++k) {
            const V shadow = hn::Add(hn::Sub(height[k], fallen[k]), base);
            hn::StoreU(hn::IfThenElse(hn::Lt(height[k], low), floor, hn::Max(shadow, floor)),
                       kFloats, look.shadow_m + i + k * kWidth);
        }
    });
}

/// Whatever number of points: at least one.
template <int kPoints>
HWY_INLINE void raise_fans_over(const Fans& fans, int count, const float* ground_m,
                                const FanPoint* points) {
    for (int i = 0; i < count; i += kWidth) {
        V over[kPoints], way[kPoints];
        for (int j = 0; j < kPoints; ++j) {
            over[j] = hn::Sub(ground_at(ground_m + i, points[j].crossing),
                              hn::Set(kFloats, points[j].sunk_m));
            way[j] = hn::Set(kFloats, points[j].distance_m);
        }
        float *height_m = fans.height_m + i, *distance_m = fans.distance_m + i;
        for (int ray = 0; ray < kFanRays; ++ray, height_m += fans.pitch, distance_m += fans.pitch) {
            const V tangent = hn::Set(kFloats, fans.tangents[ray]);
            V height = hn::LoadU(kFloats, height_m), distance = hn::LoadU(kFloats, distance_m);
            V most = hn::Add(height, hn::Mul(tangent, distance));
            for (int j = 0; j < kPoints; ++j) {
                const V here = hn::Add(over[j], hn::Mul(tangent, way[j]));
                const auto higher = hn::Gt(here, most);
                height = hn::IfThenElse(higher, over[j], height);
                distance = hn::IfThenElse(higher, way[j], distance);
                if (j + 1 < kPoints) most = hn::Max(here, most);
            }
            hn::StoreU(height, kFloats, height_m);
            hn::StoreU(distance, kFloats, distance_m);
        }
    }
}

void RaiseFans(const Fans& fans, int count, const float* ground_m, const FanPoint* points,
               int point_count) {
    static_assert(kFanPoints == 4);
    if (point_count == 1) return raise_fans_over<1>(fans, count, ground_m, points);
    if (point_count == 2) return raise_fans_over<2>(fans, count, ground_m, points);
    if (point_count == 3) return raise_fans_over<3>(fans, count, ground_m, points);
    raise_fans_over<4>(fans, count, ground_m, points);
}

void LookOverFans(const FanLook& look) {
    const V from = hn::Set(kFloats, look.from_m), slope = hn::Set(kFloats, look.plane_slope),
            nothing = hn::Set(kFloats, kNothing_m), one = hn::Set(kFloats, 1.0F);
    for (int i = 0; i < look.count; i += kWidth) {
        const V eye = hn::Sub(hn::LoadU(kFloats, look.ground_m + i), hn::Set(kFloats, look.sunk_m));
        V rise = nothing, way = one, next_rise = nothing, next_way = one;
        auto over_last = hn::Eq(eye, eye);
        for (int ray = look.first_ray; ray < kFanRays; ++ray) {
            const std::ptrdiff_t at = ray * look.fans.pitch + i;
            const V up = hn::Sub(hn::LoadU(kFloats, look.fans.height_m + at), eye),
                    along = hn::Sub(from, hn::LoadU(kFloats, look.fans.distance_m + at));
            const auto over = hn::Gt(up, hn::Mul(hn::Set(kFloats, look.fans.tangents[ray]), along));
            next_rise = hn::IfThenElse(over_last, up, next_rise);
            next_way = hn::IfThenElse(over_last, along, next_way);
            rise = hn::IfThenElse(over, up, rise);
            way = hn::IfThenElse(over, along, way);
            over_last = over;
        }
        V tangent = hn::Div(rise, way);
        if (look.also_next) tangent = hn::Max(hn::Div(next_rise, next_way), tangent);
        hn::StoreU(hn::Sub(tangent, slope), kFloats, look.tangent + i);
    }
}

void LookNear(float* tangent, int count, const float* height_m, const float* ground_m,
              const NearGround* near, int near_count) {
    by_vectors(count, [&](auto vectors, int i) {
        constexpr int kVectors = decltype(vectors)::value;
        V height[kVectors], most[kVectors];
        for (int k = 0; k < kVectors; ++k) {
            height[k] = hn::LoadU(kFloats, height_m + i + k * kWidth);
            most[k] = hn::LoadU(kFloats, tangent + i + k * kWidth);
        }
        for (const NearGround* at = near; at < near + near_count; ++at)
            for (int k = 0; k < kVectors; ++k) {
                const V up = hn::Sub(ground_at(ground_m + i + k * kWidth, at->crossing), height[k]);
                const V t = hn::Sub(hn::Mul(up, hn::Set(kFloats, at->per_metre)),
                                    hn::Set(kFloats, at->sunk));
                most[k] = hn::Max(t, most[k]);
            }
        for (int k = 0; k < kVectors; ++k)
            hn::StoreU(most[k], kFloats, tangent + i + k * kWidth);
    });
}

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE void transpose_block(const float* from, std::ptrdiff_t from_stride, float* to,
                                std::ptrdiff_t to_stride) {
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c)
            to[c * to_stride + r] = from[r * from_stride + c];
}
#else
/// Four rows of four numbers.
HWY_INLINE void transpose_block(const float* from, std::ptrdiff_t from_stride, float* to,
                                std::ptrdiff_t to_stride) {
    constexpr hn::FixedTag<float, 4> kFour;
    const auto a = hn::LoadU(kFour, from), b = hn::LoadU(kFour, from + from_stride),
               c = hn::LoadU(kFour, from + 2 * from_stride),
               d = hn::LoadU(kFour, from + 3 * from_stride);
    const auto ab = hn::InterleaveLower(kFour, a, b), cd = hn::InterleaveLower(kFour, c, d),
               ab_upper = hn::InterleaveUpper(kFour, a, b),
               cd_upper = hn::InterleaveUpper(kFour, c, d);
    hn::StoreU(hn::ConcatLowerLower(kFour, cd, ab), kFour, to);
    hn::StoreU(hn::ConcatUpperUpper(kFour, cd, ab), kFour, to + to_stride);
    hn::StoreU(hn::ConcatLowerLower(kFour, cd_upper, ab_upper), kFour, to + 2 * to_stride);
    hn::StoreU(hn::ConcatUpperUpper(kFour, cd_upper, ab_upper), kFour, to + 3 * to_stride);
}
#endif

/// Numbers of rows and of columns that are multiples of four.
void TransposeBlocks(const float* from, std::ptrdiff_t from_stride, int rows, int columns,
                     float* to, std::ptrdiff_t to_stride) {
    for (int c = 0; c < columns; c += 4)
        for (int r = 0; r < rows; r += 4)
            transpose_block(from + r * from_stride + c, from_stride, to + c * to_stride + r,
                            to_stride);
}

}  // namespace relevo::light::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace relevo::light {

HWY_EXPORT(TiltRow);
HWY_EXPORT(RaiseLines);
HWY_EXPORT(LookForShadows);
HWY_EXPORT(RaiseFans);
HWY_EXPORT(LookOverFans);
HWY_EXPORT(LookNear);
HWY_EXPORT(TransposeBlocks);

void tilt_row(const RowTilt& row) {
    HWY_DYNAMIC_DISPATCH(TiltRow)(row);
}

void raise_lines(float* height_m, int count, const float* ground_m, const Crossing* crossings,
                 int crossing_count) {
    HWY_DYNAMIC_DISPATCH(RaiseLines)(height_m, count, ground_m, crossings, crossing_count);
}

void look_for_shadows(const ShadowLook& look) {
    HWY_DYNAMIC_DISPATCH(LookForShadows)(look);
}

void raise_fans(const Fans& fans, int count, const float* ground_m, const FanPoint* points,
                int point_count) {
    HWY_DYNAMIC_DISPATCH(RaiseFans)(fans, count, ground_m, points, point_count);
}

void look_over_fans(const FanLook& look) {
    HWY_DYNAMIC_DISPATCH(LookOverFans)(look);
}

void look_near(float* tangent, int count, const float* height_m, const float* ground_m,
               const NearGround* near, int near_count) {
    HWY_DYNAMIC_DISPATCH(LookNear)(tangent, count, height_m, ground_m, near, near_count);
}

void transpose(const float* from, std::ptrdiff_t from_stride, int rows, int columns, float* to,
               std::ptrdiff_t to_stride) {
    // In bands of rows whose columns come to lie next to each other: whole lines of the cache.
    constexpr int kBand = 64;
    const int block_columns = columns / 4 * 4;
    for (int row = 0; row < rows; row += kBand) {
        const int count = std::min(kBand, rows - row), block_rows = count / 4 * 4;
        const float* const band = from + row * from_stride;
        HWY_DYNAMIC_DISPATCH(TransposeBlocks)
        (band, from_stride, block_rows, block_columns, to + row, to_stride);
        for (int r = 0; r < count; ++r)
            for (int c = r < block_rows ? block_columns : 0; c < columns; ++c)
                to[c * to_stride + row + r] = band[r * from_stride + c];
    }
}

void set_widest_vector(int floats) {
    // On x86-64 targets are numbered from the best one on.
    std::int64_t off = 0;
    if (floats < 16) off |= HWY_AVX2 - 1;
    if (floats < 8) off |= HWY_AVX2;
    if (floats < 4) off = ~(HWY_SCALAR | HWY_EMU128);
    hwy::SetSupportedTargetsForTest(0);
    if (off != 0) hwy::SetSupportedTargetsForTest(hwy::SupportedTargets() & ~off);
}

}  // namespace relevo::light
#endif
