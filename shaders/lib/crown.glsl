//! provides  Crown: one model of a tree's crown, for trees and for rasters of canopies: what it hides and lets through
//! source    T. Nilson, A theoretical analysis of the frequency of gaps in plant stands, Agric. Meteorol. 8 (1971) 25:
//!           the positive binomial model, for stands that are more regular than chance

/// An upright ellipsoid that stands on the ground.
struct Crown {
    float height_m;
    float width_m;
    float light;  // share of the light that passes through it, 0..1
};

const float kCrownOrder = 3.0;  // of the binomial: infinite for stands by chance, 1 for one that fills its cells

/// Level ground that a crown hides from a direction [m2]. @param cosine  of the direction's angle to the vertical
float crown_area_m2(in Crown crown, in float cosine) {
    float c = clamp(cosine, 0.05, 1.0);
    float stretch = crown.height_m / max(crown.width_m, 1e-3);
    return 0.785398 * crown.width_m * crown.width_m * sqrt(1.0 + stretch * stretch * (1.0 - c * c) / (c * c));
}

/// Share of the ground that no crown hides from a direction, 0..1. @param per_m2  crowns on a square metre
float crown_gap(in Crown crown, in float per_m2, in float cosine) {
    float filled = min(per_m2 * crown_area_m2(crown, cosine), kCrownOrder);
    return pow(1.0 - filled / kCrownOrder, kCrownOrder);
}

/// Share of a direction's light that reaches the ground, through gaps and through crowns.
float crown_light(in Crown crown, in float per_m2, in float cosine) {
    return mix(crown.light, 1.0, crown_gap(crown, per_m2, cosine));
}
