// Compiled once for each kind of vector that the processor may have.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "light/raster/post_loops.cpp"
#include "light/raster/post_loops.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "light/raster/clearance.h"
#include "light/raster/quick_math.h"

HWY_BEFORE_NAMESPACE();
namespace relevo::light::HWY_NAMESPACE {

// Plain loops, which compilers make vectors of, as wide as the target's.

void FindClearances(const float* HWY_RESTRICT height_m, const float* HWY_RESTRICT shadow_m,
                    int count, float* HWY_RESTRICT clearance_m) {
    for (int i = 0; i < count; ++i)
        clearance_m[i] = height_m[i] - shadow_m[i];
}

void Straighten(const float* HWY_RESTRICT upper_m, const float* HWY_RESTRICT middle_m, int count,
                float* HWY_RESTRICT lower_m) {
    for (int i = 0; i < count; ++i) {
        const float u = upper_m[i], l = lower_m[i];
        const float straight = u - u / height_of_disc({u, middle_m[i], l});
        lower_m[i] = (u > 0) & (l < 0) ? straight : l;
    }
}

/// For some posts: their hours are touched only if light comes or goes at one of them.
HWY_INLINE void add_light_to_some(const Step& step, const float* HWY_RESTRICT height_m,
                                  const float* HWY_RESTRICT shadow_m, int count,
                                  float* HWY_RESTRICT clearance_m, float* HWY_RESTRICT lit_h) {
    int changes = 0;
    for (int i = 0; i < count; ++i) {
        const float now = height_m[i] - shadow_m[i];
        changes += (clearance_m[i] >= 0) != (now >= 0);
    }
    for (int i = 0; changes > 0 && i < count; ++i) {
        const float before = clearance_m[i], now = height_m[i] - shadow_m[i];
        const float when_h = step.from_h + step.hours * (before / (before - now));
        const float comes = (before < 0) & (now >= 0) ? when_h : 0.0F,
                    goes = (before >= 0) & (now < 0) ? when_h : 0.0F;
        lit_h[i] += goes - comes;
    }
    for (int i = 0; i < count; ++i)
        clearance_m[i] = height_m[i] - shadow_m[i];
}

void AddLight(const Step& step, const float* height_m, const float* shadow_m, int count,
              float* clearance_m, float* lit_h) {
    constexpr int kSome = 64;
    int i = 0;
    for (; i + kSome <= count; i += kSome)
        add_light_to_some(step, height_m + i, shadow_m + i, kSome, clearance_m + i, lit_h + i);
    add_light_to_some(step, height_m + i, shadow_m + i, count - i, clearance_m + i, lit_h + i);
}

void RaiseToEarth(const float* HWY_RESTRICT shadow_m, const float* HWY_RESTRICT edge_m,
                  const float* HWY_RESTRICT edge_at_m, int count, const SunOverRow& sun,
                  float* HWY_RESTRICT raised_m) {
    const float base = sun.base, a_post = sun.a_post, c = sun.curvature, lowest_m = sun.lowest_m;
    const int from = sun.from;
    for (int i = 0; i < count; ++i) {
        const float t = base + a_post * static_cast<float>(from + i);
        const float level_m = edge_m[i] > lowest_m ? edge_m[i] : lowest_m;
        // A ray has fallen by t * s + c * s * s / 2 since it was over ground s metres off; what it
        // met last is the edge, or where it was level. Suns over the horizon meet nothing: their
        // shadow lies as deep as those of suns as far under it are high.
        const float flat_m = -t / c;
        const float beyond_m = edge_at_m[i] > flat_m ? edge_at_m[i] : flat_m;
        const float s = beyond_m > 0 ? beyond_m : 0.0F;
        const float fallen_m = t * s + c * s * s / 2, deep_m = t * t / (2 * c);
        const float deepest_m = (t > 0) & (deep_m > fallen_m) ? deep_m : fallen_m;
        const float earth_m = level_m - deepest_m;
        raised_m[i] = earth_m > shadow_m[i] ? earth_m : shadow_m[i];
    }
}

void MixByHeight(const float* HWY_RESTRICT height_m, float lowest_m, float a_metre,
                 const float* HWY_RESTRICT low_m, int count, float* HWY_RESTRICT shadow_m) {
    for (int i = 0; i < count; ++i)
        shadow_m[i] = low_m[i] + (height_m[i] - lowest_m) * a_metre * (shadow_m[i] - low_m[i]);
}

void RaiseToDip(const float* HWY_RESTRICT tangent, const float* HWY_RESTRICT eye_m,
                const float* HWY_RESTRICT edge_m, const float* HWY_RESTRICT edge_at_m, int count,
                float curvature, float lowest_m, float* HWY_RESTRICT raised) {
    for (int i = 0; i < count; ++i) {
        const float over_edge_m = eye_m[i] - edge_m[i], over_m = eye_m[i] - lowest_m;
        const float dip = std::sqrt(2 * curvature * (over_edge_m > 0 ? over_edge_m : 0.0F)),
                    lowest = std::sqrt(2 * curvature * (over_m > 0 ? over_m : 0.0F)),
                    level = curvature * edge_at_m[i];
        const float beyond = dip > level ? dip : level;
        const float least = -(beyond < lowest ? beyond : lowest);
        raised[i] = tangent[i] > least ? tangent[i] : least;
    }
}

void FindElevations(const float* HWY_RESTRICT tangent, const float* HWY_RESTRICT height_m,
                    int count, float* HWY_RESTRICT elevation_rad) {
    for (int i = 0; i < count; ++i) {
        const float elevation = quick_atan(std::abs(tangent[i]));
        elevation_rad[i] = std::copysign(elevation, tangent[i]) + 0 * height_m[i];
    }
}

void AddSky(const float* HWY_RESTRICT tangent, const float* HWY_RESTRICT x,
            const float* HWY_RESTRICT y, const float* HWY_RESTRICT z, int count,
            const glm::vec3& direction, float* HWY_RESTRICT sum) {
    const float dx = direction.x, dy = direction.y, dz = direction.z;
    for (int i = 0; i < count; ++i) {
        // H of the source is the angle between zenith and horizon, t its cotangent.
        const float t = tangent[i] > 0 ? tangent[i] : 0.0F;
        const float sin2 = 1 / (1 + t * t);
        const float rise = x[i] * dx + y[i] * dy + z[i] * dz;
        const float width = kHalfPi - quick_atan(t) - t * sin2;
        const float slope = 1 / std::sqrt(1 + x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
        const float seen = slope * (sin2 - rise * width);
        sum[i] += seen > 0 ? seen : 0.0F;
    }
}

void FindEntries(const float* HWY_RESTRICT tangent, int count, float base_rad, float a_post_rad,
                 int from, float entry_rad, int entries, float* HWY_RESTRICT at) {
    const float scale = 1 / entry_rad, last = static_cast<float>(entries) - 1.001F;
    for (int i = 0; i < count; ++i) {
        const float elevation = std::copysign(quick_atan(std::abs(tangent[i])), tangent[i]);
        const float entry =
            (elevation - base_rad - a_post_rad * static_cast<float>(from + i)) * scale;
        const float least = entry > 0 ? entry : 0.0F;
        at[i] = least < last ? least : last;
    }
}

}  // namespace relevo::light::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace relevo::light {

HWY_EXPORT(FindClearances);
HWY_EXPORT(Straighten);
HWY_EXPORT(AddLight);
HWY_EXPORT(RaiseToEarth);
HWY_EXPORT(MixByHeight);
HWY_EXPORT(RaiseToDip);
HWY_EXPORT(FindElevations);
HWY_EXPORT(AddSky);
HWY_EXPORT(FindEntries);

void find_clearances(const float* height_m, const float* shadow_m, int count, float* clearance_m) {
    HWY_DYNAMIC_DISPATCH(FindClearances)(height_m, shadow_m, count, clearance_m);
}

void straighten(const float* upper_m, const float* middle_m, int count, float* lower_m) {
    HWY_DYNAMIC_DISPATCH(Straighten)(upper_m, middle_m, count, lower_m);
}

void add_light(const Step& step, const float* height_m, const float* shadow_m, int count,
               float* clearance_m, float* lit_h) {
    HWY_DYNAMIC_DISPATCH(AddLight)(step, height_m, shadow_m, count, clearance_m, lit_h);
}

void raise_to_earth(const float* shadow_m, const float* edge_m, const float* edge_at_m, int count,
                    const SunOverRow& sun, float* raised_m) {
    HWY_DYNAMIC_DISPATCH(RaiseToEarth)(shadow_m, edge_m, edge_at_m, count, sun, raised_m);
}

void mix_by_height(const float* height_m, float lowest_m, float a_metre, const float* low_m,
                   int count, float* shadow_m) {
    HWY_DYNAMIC_DISPATCH(MixByHeight)(height_m, lowest_m, a_metre, low_m, count, shadow_m);
}

void raise_to_dip(const float* tangent, const float* eye_m, const float* edge_m,
                  const float* edge_at_m, int count, float curvature, float lowest_m,
                  float* raised) {
    HWY_DYNAMIC_DISPATCH(RaiseToDip)
    (tangent, eye_m, edge_m, edge_at_m, count, curvature, lowest_m, raised);
}

void find_elevations(const float* tangent, const float* height_m, int count, float* elevation_rad) {
    HWY_DYNAMIC_DISPATCH(FindElevations)(tangent, height_m, count, elevation_rad);
}

void add_sky(const float* tangent, const float* x, const float* y, const float* z, int count,
             const glm::vec3& direction, float* sum) {
    HWY_DYNAMIC_DISPATCH(AddSky)(tangent, x, y, z, count, direction, sum);
}

void find_entries(const float* tangent, int count, float base_rad, float a_post_rad, int from,
                  float entry_rad, int entries, float* at) {
    HWY_DYNAMIC_DISPATCH(FindEntries)
    (tangent, count, base_rad, a_post_rad, from, entry_rad, entries, at);
}

}  // namespace relevo::light
#endif
