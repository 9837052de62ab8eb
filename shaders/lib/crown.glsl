//! provides  Crown: one model of a tree's crown, for trees and for rasters of canopies: what it hides and lets through
//! source    T. Nilson, A theoretical analysis of the frequency of gaps in plant stands, Agric. Meteorol. 8 (1971) 25:
//!           the positive binomial model, for stands that are more regular than chance

/// An upright ellipsoid that stands on the ground.
struct Crown {
    float height_m;
    float width_m;
    float light;  // share of the light that passes through it, 0..1
};

const float kCrownOrder = 1.2;  // of the binomial: infinite for stands by chance, 1 for one that fills its cells

/// Level ground that a crown hides from a direction [m2]. @param cosine  of the direction's angle to the vertical
float crown_area_m2(in Crown crown, in float cosine) {
    float c = clamp(cosine, 0.05, 1.0);
    float stretch = crown.height_m / max(crown.width_m, 1e-3);
    return 0.785398 * crown.width_m * crown.width_m * sqrt(1.0 + stretch * stretch * (1.0 - c * c) / (c * c));
}

/// Share of the ground that no crown hides from a direction, 0..1.
/// @param filled  area that crowns hide, crown_area_m2() of each, over the ground's area
float crown_gap(in float filled) {
    return pow(max(1.0 - filled / kCrownOrder, 0.0), kCrownOrder);
}
