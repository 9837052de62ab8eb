//! provides  patches of ground, and forests from above: crowns of single trees, clumps of them from afar
//! reads     ground coordinates [m], the way to the eye, a texture of patches

//@ include lib/ground.glsl
//@ include lib/noise.glsl
//@ include lib/repeats.glsl

uniform sampler2D cover_patches;

const float cover_near_m = 24.0;  // HAS_near: wider pixels have neither crowns nor grain

/// Turns by 37 degrees: patterns read both ways do not line up.
const mat2 cover_turn = mat2(0.7986, 0.6018, -0.6018, 0.7986);

vec4 cover_patch(in vec2 at, in vec2 dx, in vec2 dy) {
    return textureGrad(cover_patches, at, dx, dy) - vec4(0.5, 0.5, 0.0, 0.5);
}

/// @param per_m  from metres east and north to repeats
vec4 cover_turned_patch(in Surface s, in mat2 per_m) {
    return cover_patch(ground_repeats(s.anchored_m, per_m), per_m * s.ground_dx_m.xy, per_m * s.ground_dy_m.xy);
}

/// A forest from above or from afar.
struct cover_Canopy {
    vec2 slope;   // of the crowns, east and north
    vec3 light;   // factor on the forest's colour: it is dark between crowns
};
/// The crown that a point of the canopy is on.
struct cover_Crown {
    vec2 slope;   // of its surface
    float height;  // above the mean of their middles, in cells; below -1 between crowns
    float random;  // of the tree, 0..1
};

/// One tree stands in a cell: a conifer is a cone, a broadleaf tree an ellipsoid.
/// @param cell, within  of a grid of trees
cover_Crown cover_crown_at(in ivec2 cell, in vec2 within, in float conifers) {
    ivec2 corner = cell + ivec2(floor(within - 0.5));
    cover_Crown highest = cover_Crown(vec2(0.0), -2.0, 0.5);
    for (int i = 0; i < 4; ++i) {
        ivec2 near = corner + ivec2(i & 1, i >> 1);
        vec3 random = vec3(noise_random(near, 0u), noise_random(near, 1u), noise_random(near, 2u));
        float size = fract(random.z * 7.0);
        bool cone = random.z < conifers;
        float radius = (cone ? 0.38 : 0.46) + 0.3 * size;
        vec2 from = (within - vec2(near - cell) - 0.16 - 0.68 * random.xy) / radius;
        float off2 = dot(from, from);
        float rise = cone ? 1.9 * (1.0 - sqrt(off2)) : sqrt(max(1.0 - off2, 0.0));
        float height = off2 < 1.0 ? radius * rise + size - 0.9 : -2.0;
        if (height > highest.height) {
            vec2 slope = cone ? 1.9 * from * inversesqrt(max(off2, 0.04)) : from * inversesqrt(max(1.0 - off2, 0.1));
            highest = cover_Crown(slope, height, random.z);
        }
    }
    return highest;
}

/// Towards the eye over the ground, for a metre of height above it [m]. No more than for 6 degrees.
vec2 cover_slant(in Surface s) {
    vec3 east = east_at(s.up), to_eye = -s.position_m;
    vec3 north = cross(s.up, east), ground = s.ground_normal / max(dot(s.ground_normal, s.up), 0.2);
    vec2 level = vec2(dot(to_eye, east), dot(to_eye, north));
    float rise = dot(to_eye, s.up) + dot(level, vec2(dot(ground, east), dot(ground, north)));
    return level / max(rise, 0.1 * s.distance_m);
}

const int cover_down_steps = 4, cover_all_steps = 7;  // along a ray, until it is in a crown and to its surface

/// The crown that a point of the ground is seen through: the first one that the ray to the eye leaves, from above.
cover_Crown cover_crown_seen(in Surface s, in float size_m, in vec2 wander, in float conifers) {
    const float top = 0.8, down = 0.4;  // in cells: crowns are from -0.9 to 0.9
    vec2 slant_m = size_m * cover_slant(s);
    cover_Crown crown = cover_Crown(vec2(0.0), -2.0, 0.5), found = crown;
    float height = top, next = down;
    for (int i = 0; i < cover_all_steps; ++i) {
        vec2 within;
        ivec2 cell = ground_cell(s.anchored_m + height * slant_m, cover_turn * (1.0 / size_m), within);
        crown = cover_crown_at(cell, within + wander, conifers);
        bool inside = crown.height >= height;
        if (inside) found = crown;
        if (!inside && next == down && i + 1 >= cover_down_steps) break;  // through to the ground
        // Down until inside, then half of the step before, up or down.
        if (inside || next < down) next *= 0.5;
        height += inside ? next : -next;
    }
    return found;
}

/// @param shown  how far crowns are
/// Near the eye, where one stands between the trees, and from so far that they are smaller than pixels, none.
cover_Canopy cover_canopy_at(in Surface s, in float pixel_m, in float across_m, in float conifers, in float shown) {
    const float size_m = 7.5, stand_m = 96.0;
    cover_Canopy canopy = cover_Canopy(vec2(0.0), vec3(1.0));
    float crowns = shown * (1.0 - smoothstep(0.0, 0.8 * size_m, across_m)) *
                   (1.0 - smoothstep(0.3 * size_m, 2.0 * size_m, pixel_m)) * smoothstep(25.0, 90.0, s.distance_m) *
                   smoothstep(0.03, 0.12, -dot(s.position_m, s.geometric_normal) / s.distance_m);
    float stands = 1.0 - smoothstep(0.4 * cover_near_m, cover_near_m, across_m);
    if (stands == 0.0) return canopy;
    // Clumps of trees, and where they are smaller than pixels groups of clumps.
    float larger = max(log2(across_m / 1.5), 0.0), by = fract(larger);
    mat2 per_m = mat2(cover_turn[1], cover_turn[0]) * (exp2(by - larger) / stand_m);  // east and north change places
    vec4 stand = mix(cover_turned_patch(s, per_m), cover_turned_patch(s, 0.5 * per_m), by);
    canopy.light += stands * (1.4 * stand.a + 0.5 * stand.r + 0.4 * stand.g * vec3(1.0, 0.3, -0.4));
    if (crowns == 0.0) return canopy;
    cover_Crown crown = cover_crown_seen(s, size_m, 0.5 * stand.ar, conifers);
    bool between = crown.height < -1.0;
    canopy.slope = between ? vec2(0.0) : 0.5 * crowns * crowns * (crown.slope * cover_turn);
    float depth = between ? 0.42 : mix(0.6, 1.2, smoothstep(-0.9, 0.7, crown.height));
    vec3 tree = 1.0 + (crown.random - 0.5) * vec3(0.42, 0.3, 0.2);
    // Clumps of leaves on a crown, of a metre, shade each other.
    const float clump_m = 9.0;
    vec4 clump = cover_turned_patch(s, cover_turn / clump_m);
    float leaves = between ? 0.0 : 1.6 * clump.a + 1.2 * clump.r;
    canopy.light *= mix(vec3(1.0), 1.25 * depth * tree * (1.0 + leaves), crowns);  // 1.25: as bright in the mean
    return canopy;
}
