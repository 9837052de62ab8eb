//! provides  Crown: one model of a tree's crown, for trees and for rasters of canopies: what it hides and lets through
//! source    T. Nilson, A theoretical analysis of the frequency of gaps in plant stands, Agric. Meteorol. 8 (1971) 25:
//!           the positive binomial model, for stands that are more regular than chance

/// An upright ellipsoid that stands on the ground.
struct Crown {
    float height_m;
    float width_m;
    float light;  // share of the light that passes through it, 0..1
};

/// A crown as the sun sees it, at a height along the direction that is upright across the light.
struct CrownSeen {
    float half_width_m;  // negative above and below the crown
    float towards_m;     // from the foot towards the sun, of the middle of what its rays pass there
};

/// Lower and upper end of a crown as the sun sees it, from its foot, along the direction upwards across the light [m].
/// @param taper   0: an ellipsoid, 1: a cone
/// @param cosine  of the sun's zenith angle
vec2 crown_ends(in float half_width_m, in float height_m, in float taper, in float cosine) {
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0)), low = half_width_m * cosine, middle = 0.5 * height_m * sine;
    float reach = sqrt(low * low + middle * middle);
    vec2 cone = vec2(-low, max(height_m * sine, low)), ellipsoid = vec2(middle - reach, middle + reach);
    return taper <= 0.0 ? ellipsoid : taper >= 1.0 ? cone : vec2(min(cone.x, ellipsoid.x), max(cone.y, ellipsoid.y));
}

/// Of the ellipsoid (x / a)^2 + ((z - b) / b)^2 = 1: half its width, and the plane of the middles of the sun's rays.
CrownSeen crown_ellipsoid_seen(in float a, in float b, in float cosine, in float sine, in float at) {
    float reach2 = a * a * cosine * cosine + b * b * sine * sine, above = at - b * sine;
    float share = 1.0 - above * above / reach2;
    return CrownSeen(share > 0.0 ? a * sqrt(share) : -1.0, b * cosine + above * cosine * sine * (b * b - a * a) / reach2);
}

/// Of the cone of radius a and height h: the triangle of its outline, and the ellipse of its base.
CrownSeen crown_cone_seen(in float a, in float h, in float cosine, in float sine, in float at) {
    float c = a * cosine, tip = h * sine;
    float share = 1.0 - at * at / max(c * c, 1e-6);
    float base = share > 0.0 ? a * sqrt(share) : -1.0;
    float tangent = c * c / max(tip, 1e-6), wide = a * sqrt(max(1.0 - tangent * tangent / max(c * c, 1e-6), 0.0));
    bool in_triangle = tip > c && at >= tangent && at <= tip;
    float width = max(base, in_triangle ? wide * (tip - at) / max(tip - tangent, 1e-6) : -1.0);
    // The middles of rays through a cone lie in a plane through its tip, which leans away from the sun.
    float lean = a / h * min(a * cosine / max(h * sine, 1e-6), 1.0);
    float towards = h * cosine + (cosine + lean * sine) / max(sine - lean * cosine, 1e-3) * (at - tip);
    return CrownSeen(width, towards);
}

/// @param at  height as crown_ends() has it
CrownSeen crown_seen(in float half_width_m, in float height_m, in float taper, in float cosine, in float at) {
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    CrownSeen round = crown_ellipsoid_seen(half_width_m, 0.5 * height_m, cosine, sine, at);
    CrownSeen cone = crown_cone_seen(half_width_m, height_m, cosine, sine, at);
    CrownSeen seen = CrownSeen(mix(round.half_width_m, cone.half_width_m, taper), mix(round.towards_m, cone.towards_m, taper));
    // Level ground behind the foot is in the crown's shadow.
    float ground_m = -at * sine / max(cosine, 0.02);
    seen.towards_m = max(seen.towards_m, at > 0.0 ? ground_m + 0.02 * height_m : -1e6);
    return seen;
}

/// Area of a crown's shadow on level ground, or what it hides of that from a direction [m2].
/// @param cosine  of the direction's angle to the vertical
float crown_area_m2(in Crown crown, in float cosine) {
    float c = clamp(cosine, 0.05, 1.0);
    float stretch = crown.height_m / max(crown.width_m, 1e-3);
    return 0.785398 * crown.width_m * crown.width_m * sqrt(1.0 + stretch * stretch * (1.0 - c * c) / (c * c));
}

/// The same of a cone: its base, and the tangents to that from its tip's shadow.
float crown_cone_area_m2(in Crown crown, in float cosine) {
    float c = clamp(cosine, 0.05, 1.0), radius = 0.5 * crown.width_m;
    float reach = max(crown.height_m * sqrt(1.0 - c * c) / max(c * radius, 1e-3), 1.0);
    return radius * radius * (sqrt(reach * reach - 1.0) + 3.141593 - acos(1.0 / reach));
}

/// Share of the ground that no crown hides from a direction, 0..1. Crowns stand at random places of a grid's cells, one
/// in each at most: the farther a crown's shadow reaches over others' cells, the less even they are.
/// @param filled  area that crowns hide, crown_area_m2() of each, over the ground's area
/// @param cells   area that a crown hides over the area of a cell
/// @param apart   0..1, the exponent of the share: 1 of all ground, less of ground that is known to be seen from elsewhere
float crown_gap(in float filled, in float cells, in float apart) {
    float order = max(1.0 + 1.35 * cells, filled);  // fitted to ellipsoids and cones of 8 to 20 m in cells of 10 m
    return pow(max(1.0 - filled / order, 1e-6), order * apart);
}
float crown_gap(in float filled, in float cells) {
    return crown_gap(filled, cells, 1.0);
}

/// Share of the sun's light on the sunny side of crowns that other crowns do not keep off, in the mean, 0..1. Fitted to
/// such ellipsoids and cones under suns above 12 degrees.
/// @param slant  area that crowns hide from the sun less what they hide from above, over the ground's area
/// @param taper  0: ellipsoids, 1: cones
float crown_sunlight(in float slant, in float taper) {
    return 1.0 / (1.0 + mix(0.15, 0.45, taper) * max(slant, 0.0));
}
