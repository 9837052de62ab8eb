#include "light/sweep_kernels.h"

#include <cassert>
#include <cstring>

namespace relevo::light::kernel {
namespace {

/// Loads that cross lines of the cache are what a sweep waits for: what is used twice is loaded
/// once, whatever the compiler thinks of it.
#if defined(__x86_64__)
#define RELEVO_IN_REGISTER(v) asm("" : "+x"(v))
#else
#define RELEVO_IN_REGISTER(v)
#endif

/// Vectors come and go by reference: how a wide one is returned hangs on the processor.
template <typename V>
[[gnu::always_inline]] inline void load(const float* from, V& v) {
    std::memcpy(&v, from, sizeof v);
}

template <typename V>
[[gnu::always_inline]] inline void store(const V& v, float* to) {
    std::memcpy(to, &v, sizeof v);
}

template <typename V>
constexpr int kWidthOf = static_cast<int>(sizeof(V) / sizeof(float));

/// 0, 1, 2 ...
template <typename V>
[[gnu::always_inline]] inline void count(V& lane) {
    for (int k = 0; k < kWidthOf<V>; ++k)
        lane[k] = static_cast<float>(k);
}

/// Vectors that are looked at together, so that they and what is between fit into registers.
template <int kLevels>
constexpr int kTogether = kLevels <= 3 ? 4 : 2;

/// kVectors vectors of lines, from the i-th on. Multiplications and additions are not contracted
/// (CMakeLists.txt), so that the bits are the same for every V.
/// @param over_m  as Lift has it
template <typename V, int kLevels, int kVectors>
[[gnu::always_inline]] inline void rise(const float* rows, const Ground* ground, int grounds,
                                        const float* over_m, int i,
                                        V (&height)[kLevels][kVectors]) {
    for (const Ground* g = ground; g < ground + grounds; ++g, over_m += kLevels - 1) {
        const float *const p = rows + g->p + i, *const q = rows + g->q + i;
#pragma GCC unroll 8
        for (int k = 0; k < kVectors; ++k) {
            V a, b;
            load(p + k * kWidthOf<V>, a);
            load(q + k * kWidthOf<V>, b);
            RELEVO_IN_REGISTER(a);
            const V first = a + g->part * (b - a);
            height[0][k] = first > height[0][k] ? first : height[0][k];
#pragma GCC unroll 8
            for (int level = 1; level < kLevels; ++level) {
                const V h = first + over_m[level - 1];
                height[level][k] = h > height[level][k] ? h : height[level][k];
            }
        }
    }
}

template <typename V, int kLevels, int kVectors>
[[gnu::always_inline]] inline void raise_some(const Lift& lift, int i) {
    V height[kLevels][kVectors];
#pragma GCC unroll 8
    for (int level = 0; level < kLevels; ++level)
#pragma GCC unroll 8
        for (int k = 0; k < kVectors; ++k)
            load(lift.height_m + level * lift.pitch + i + k * kWidthOf<V>, height[level][k]);
    rise(lift.rows, lift.ground, lift.grounds, lift.over_m, i, height);
#pragma GCC unroll 8
    for (int level = 0; level < kLevels; ++level)
#pragma GCC unroll 8
        for (int k = 0; k < kVectors; ++k)
            store(height[level][k], lift.height_m + level * lift.pitch + i + k * kWidthOf<V>);
}

template <typename V, int kLevels>
[[gnu::always_inline]] inline void raise_levels(const Lift& lift) {
    constexpr int kSome = kTogether<kLevels>;
    int i = 0;
    for (; i + kSome * kWidthOf<V> <= lift.lines; i += kSome * kWidthOf<V>)
        raise_some<V, kLevels, kSome>(lift, i);
    for (; i < lift.lines; i += kWidthOf<V>)
        raise_some<V, kLevels, 1>(lift, i);
}

template <typename V>
[[gnu::always_inline]] inline void raise_all(const Lift& lift) {
    static_assert(kMostLevels == 6);
    switch (lift.levels) {
        case 1:
            return raise_levels<V, 1>(lift);
        case 2:
            return raise_levels<V, 2>(lift);
        case 3:
            return raise_levels<V, 3>(lift);
        case 4:
            return raise_levels<V, 4>(lift);
        case 5:
            return raise_levels<V, 5>(lift);
        default:
            return raise_levels<V, 6>(lift);
    }
}

template <typename V>
[[gnu::always_inline]] inline void add_all_to_range(const float* height_m, int count,
                                                    HeightRange& range) {
    constexpr int kVectors = 4;
    V low[kVectors], high[kVectors];
    for (int k = 0; k < kVectors; ++k) {
        low[k] = V{} + range.lowest_m;
        high[k] = V{} + range.highest_m;
    }
    int i = 0;
    for (; i + kVectors * kWidthOf<V> <= count; i += kVectors * kWidthOf<V>)
#pragma GCC unroll 8
        for (int k = 0; k < kVectors; ++k) {
            V h;
            load(height_m + i + k * kWidthOf<V>, h);
            low[k] = h < low[k] ? h : low[k];
            high[k] = h > high[k] ? h : high[k];
        }
    const auto add = [&](float lowest_m, float highest_m) {
        range.lowest_m = lowest_m < range.lowest_m ? lowest_m : range.lowest_m;
        range.highest_m = highest_m > range.highest_m ? highest_m : range.highest_m;
    };
    for (int k = 0; k < kVectors; ++k)
        for (int lane = 0; lane < kWidthOf<V>; ++lane)
            add(low[k][lane], high[k][lane]);
    for (; i < count; ++i)
        add(height_m[i], height_m[i]);
}

template <typename V>
[[gnu::always_inline]] inline void tilt_all(const Tilted& row) {
    V lane;
    count(lane);
    int i = 0;
    for (; i + kWidthOf<V> <= row.lines; i += kWidthOf<V>) {
        const V line = (static_cast<float>(row.line + i) + lane) + row.between;
        V h;
        load(row.from + i, h);
        __builtin_prefetch(row.next + i);
        store((h + row.base_m) + (row.slope.fall + row.slope.ramp * line), row.to + i);
    }
    for (; i < row.lines; ++i)
        row.to[i] =
            (row.from[i] + row.base_m) +
            (row.slope.fall + row.slope.ramp * (static_cast<float>(row.line + i) + row.between));
}

template <typename V, int kLevels, int kVectors>
[[gnu::always_inline]] inline void look_for_some_edges(const EdgeSight& sight, const V& lane,
                                                       int i) {
    const V nothing = V{} + kNothing_m;
    const float floor_m = sight.floor_m - sight.base_m;
    V ramp[kVectors], height[kLevels][kVectors];
#pragma GCC unroll 8
    for (int k = 0; k < kVectors; ++k) {
        const int at = i + k * kWidthOf<V>;
        ramp[k] = sight.ramp * ((static_cast<float>(sight.line + at) + lane) + sight.between);
#pragma GCC unroll 8
        for (int level = 0; level < kLevels; ++level) {
            height[level][k] = nothing;
            if (!sight.before_m) continue;
            const V least = floor_m + (sight.falls[level] + ramp[k]);
            V a, b;
            load(sight.before_m + level * sight.line_pitch + at, a);
            load(sight.behind_m + level * sight.line_pitch + at, b);
            a = a >= least ? a : nothing;
            b = b >= least ? b : nothing;
            const V h = a + sight.part * (b - a);
            height[level][k] = h > nothing ? h : nothing;
        }
    }
    rise(sight.rows, sight.ground, sight.grounds, sight.over_m, i, height);
#pragma GCC unroll 8
    for (int level = 0; level < kLevels; ++level)
#pragma GCC unroll 8
        for (int k = 0; k < kVectors; ++k) {
            const V edge = (height[level][k] - (sight.falls[level] + ramp[k])) + sight.base_m;
            store(edge > sight.floor_m ? edge : V{} + sight.floor_m,
                  sight.edge_m + level * sight.edge_pitch + i + k * kWidthOf<V>);
        }
}

template <typename V, int kLevels>
[[gnu::always_inline]] inline void look_for_edges_of_levels(const EdgeSight& sight) {
    constexpr int kSome = kTogether<kLevels>;
    V lane;
    count(lane);
    int i = 0;
    for (; i + kSome * kWidthOf<V> <= sight.posts; i += kSome * kWidthOf<V>)
        look_for_some_edges<V, kLevels, kSome>(sight, lane, i);
    for (; i < sight.posts; i += kWidthOf<V>)
        look_for_some_edges<V, kLevels, 1>(sight, lane, i);
}

template <typename V>
[[gnu::always_inline]] inline void look_for_all_edges(const EdgeSight& sight) {
    static_assert(kMostLevels == 6);
    switch (sight.levels) {
        case 1:
            return look_for_edges_of_levels<V, 1>(sight);
        case 2:
            return look_for_edges_of_levels<V, 2>(sight);
        case 3:
            return look_for_edges_of_levels<V, 3>(sight);
        case 4:
            return look_for_edges_of_levels<V, 4>(sight);
        case 5:
            return look_for_edges_of_levels<V, 5>(sight);
        default:
            return look_for_edges_of_levels<V, 6>(sight);
    }
}

/// kVectors vectors of posts, from the i-th on.
template <typename V, int kVectors>
[[gnu::always_inline]] inline void look_some(const Sight& sight, int i) {
    V height[kVectors], tangent[kVectors];
#pragma GCC unroll 8
    for (int k = 0; k < kVectors; ++k) {
        load(sight.height_m + i + k * kWidthOf<V>, height[k]);
        load(sight.tangent + i + k * kWidthOf<V>, tangent[k]);
    }
    for (int j = 0; j < sight.grounds; ++j) {
        const Ground& g = sight.ground[j];
        const Slope& slope = sight.slopes[j];
#pragma GCC unroll 8
        for (int k = 0; k < kVectors; ++k) {
            V a, b;
            load(sight.rows + g.p + i + k * kWidthOf<V>, a);
            load(sight.rows + g.q + i + k * kWidthOf<V>, b);
            RELEVO_IN_REGISTER(a);
            const V t = ((a + g.part * (b - a)) - height[k]) * slope.fall - slope.ramp;
            tangent[k] = t > tangent[k] ? t : tangent[k];
        }
    }
#pragma GCC unroll 8
    for (int k = 0; k < kVectors; ++k)
        store(tangent[k], sight.tangent + i + k * kWidthOf<V>);
}

template <typename V>
[[gnu::always_inline]] inline void look_all(const Sight& sight) {
    int i = 0;
    for (; i + 4 * kWidthOf<V> <= sight.posts; i += 4 * kWidthOf<V>)
        look_some<V, 4>(sight, i);
    for (; i < sight.posts; i += kWidthOf<V>)
        look_some<V, 1>(sight, i);
}

template <typename V, int kPoints>
[[gnu::always_inline]] inline void raise_fans_over(const FanLift& lift) {
    const FanLift to = lift;  // nothing is written to it, as far as compilers know
    for (int i = 0; i < to.lines; i += kWidthOf<V>) {
        V over[kPoints], way[kPoints];
#pragma GCC unroll 8
        for (int j = 0; j < kPoints; ++j) {
            const FanPoint& point = to.points[j];
            V a, b;
            load(to.rows + point.ground.p + i, a);
            load(to.rows + point.ground.q + i, b);
            over[j] = (a + point.ground.part * (b - a)) - point.sunk_m;
            way[j] = V{} + point.distance_m;
        }
        float *height_m = to.height_m + i, *distance_m = to.distance_m + i;
        const float *tangent = to.tangents, *rises = to.rises;
        for (int k = 0; k < kRays; ++k) {
            V height, distance;
            load(height_m, height);
            load(distance_m, distance);
            V most = height + *tangent * distance;
#pragma GCC unroll 8
            for (int j = 0; j < kPoints; ++j) {
                const V here = over[j] + rises[j];
                const auto higher = here > most;
                height = higher ? over[j] : height;
                distance = higher ? way[j] : distance;
                if (j + 1 < kPoints) most = higher ? here : most;
            }
            store(height, height_m);
            store(distance, distance_m);
            height_m += to.pitch, distance_m += to.pitch;
            ++tangent, rises += kFanPoints;
        }
    }
}

template <typename V>
[[gnu::always_inline]] inline void raise_all_fans(const FanLift& lift, int points) {
    switch (points) {
        case 1:
            return raise_fans_over<V, 1>(lift);
        case 2:
            return raise_fans_over<V, 2>(lift);
        case 3:
            return raise_fans_over<V, 3>(lift);
        default:
            return raise_fans_over<V, 4>(lift);
    }
}

template <typename V>
[[gnu::always_inline]] inline void look_over_all_fans(const FanSight& sight) {
    for (int i = 0; i < sight.posts; i += kWidthOf<V>) {
        V eye;
        load(sight.ground_m + i, eye);
        eye -= sight.sunk_m;
        V rise = V{} + kNothing_m, way = V{} + 1, next_rise = rise, next_way = way;
        auto over_last = eye == eye;  // not of holes
        const float* height_m = sight.height_m + sight.first_ray * sight.pitch + i;
        const float* distance_m = sight.distance_m + sight.first_ray * sight.pitch + i;
        for (int k = sight.first_ray; k < kRays; ++k) {
            V up, along;
            load(height_m, up);
            load(distance_m, along);
            up -= eye;
            along = sight.from_m - along;
            const auto over = up > sight.tangents[k] * along;
            next_rise = over_last ? up : next_rise;
            next_way = over_last ? along : next_way;
            rise = over ? up : rise;
            way = over ? along : way;
            over_last = over;
            height_m += sight.pitch, distance_m += sight.pitch;
        }
        V tangent = rise / way;
        if (sight.both) {
            const V next = next_rise / next_way;
            tangent = next > tangent ? next : tangent;
        }
        store(tangent - sight.tilt, sight.tangent + i);
    }
}

#define RELEVO_SWEEP_KERNEL(lanes, ...)                                                           \
    using Vector##lanes [[gnu::vector_size(lanes * sizeof(float))]] = float;                      \
    __VA_ARGS__ void add_to_range_##lanes(const float* height_m, int count, HeightRange& range) { \
        add_all_to_range<Vector##lanes>(height_m, count, range);                                  \
    }                                                                                             \
    __VA_ARGS__ void raise_##lanes(const Lift& lift) {                                            \
        raise_all<Vector##lanes>(lift);                                                           \
    }                                                                                             \
    __VA_ARGS__ void tilt_##lanes(const Tilted& row) {                                            \
        tilt_all<Vector##lanes>(row);                                                             \
    }                                                                                             \
    __VA_ARGS__ void look_for_edges_##lanes(const EdgeSight& sight) {                             \
        look_for_all_edges<Vector##lanes>(sight);                                                 \
    }                                                                                             \
    __VA_ARGS__ void look_##lanes(const Sight& sight) {                                           \
        look_all<Vector##lanes>(sight);                                                           \
    }                                                                                             \
    __VA_ARGS__ void raise_fans_##lanes(const FanLift& lift, int points) {                        \
        raise_all_fans<Vector##lanes>(lift, points);                                              \
    }                                                                                             \
    __VA_ARGS__ void look_over_fans_##lanes(const FanSight& sight) {                              \
        look_over_all_fans<Vector##lanes>(sight);                                                 \
    }                                                                                             \
    constexpr SweepKernel kKernel##lanes {                                                        \
        add_to_range_##lanes, raise_##lanes, tilt_##lanes, look_for_edges_##lanes, look_##lanes,  \
            raise_fans_##lanes, look_over_fans_##lanes                                            \
    }

RELEVO_SWEEP_KERNEL(4);
#if defined(__x86_64__)
RELEVO_SWEEP_KERNEL(8, [[gnu::target("avx2")]]);
RELEVO_SWEEP_KERNEL(16, [[gnu::target("avx512f")]]);
#endif
#undef RELEVO_SWEEP_KERNEL

}  // namespace

const SweepKernel& widest_sweep_kernel(int lanes) {
#if defined(__x86_64__)
    if (lanes >= 16 && __builtin_cpu_supports("avx512f")) return kKernel16;
    if (lanes >= 8 && __builtin_cpu_supports("avx2")) return kKernel8;
#endif
    assert(lanes >= 4);
    return kKernel4;
}

}  // namespace relevo::light::kernel
