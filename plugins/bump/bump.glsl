//! provides  bumps: a normal map for each material, gullies where the DEM's posts are far apart in the picture, and
//!           near the eye relief between them
//! hook      normal, facing
//! reads     material, material_weight, texture_at, tangent frame, ground coordinates [m], slope
//! writes    normal; factor of direct light
//! source    Costa and Celes, Tecnicas simples para visualizacao foto-realista de terrenos em tempo real
//!           usando placas graficas programaveis (Tecgraf, PUC-Rio), section 3.2, figure 3; relief is not the
//!           paper's: noise after K. Perlin, Improving Noise, ACM Transactions on Graphics 21 (2002), 681

//@ include lib/ground.glsl
//@ include lib/repeats.glsl
#if HAS_houses
//@ include lib/houses.glsl
#endif

uniform sampler2DArray bump_normals;

uniform float bump_strength = 1.0; //@ range(0, 4) label("Strength") description("Factor on the slopes of the bumps")
uniform int bump_correction = 2; //@ enum(none, abrupt, smooth) static label("Correction") description("Bumps are lit only where the ground faces the sun too: off, as figure 3a of the paper, as figure 3b")
uniform float bump_softness = 0.12; //@ range(0.001, 1) label("Softness") description("For the smooth correction: cosine of the incidence angle above which ground is fully lit")
uniform float bump_relief = 1.0; //@ range(0, 4) label("Relief between posts") description("Synthetic detail between the DEM's posts, on ground near the camera: gullies and roughness; 0: none")

const float bump_coarsest_m = 25.0;  // cells of the relief's coarsest noise: what is wider passes for the DEM's own
const float bump_finest_m = 0.8;     // below it is what the materials' maps have
const int bump_octaves = 5;          // from the coarsest to the finest
const float bump_gully_posts = 3.0;      // side of the coarsest gullies' cells: as far as they keep their course
const float bump_gully_turns = 1.3;      // gullies across a cell
const float bump_gully_finest_m = 12.0;  // finer cells have none: a DEM that fine has its own
const float bump_gully_true_m = 60.0;    // posts as near as that show how steep the ground is
const int bump_gully_octaves = 4;        // each starts on the sides of the one before, and so they branch
const float bump_gully_depth = 0.42;     // slope of a middling gully's sides, for a slope of 1 of the hillside
const float bump_gully_fading = 0.62;    // of that, to the next octave: fine ones as steep would look combed
const float bump_gully_octave = 0.47;    // from a cell's side to the next ones'
const float bump_octave = 0.43;      // from a noise's cells to the next ones': no power of it is near that of a whole number

/// Slopes of a material's map: how far its normal leans along tangent and bitangent, and its z.
vec3 bump_read(in Surface s, in int material) {
    return 2.0 * textureGrad(bump_normals, vec3(s.texture_at, float(material)), s.texture_dx,
                             s.texture_dy).xyz - 1.0;
}

/// Two numbers of -1..1 for a node of a grid.
/// source: M. Jarzynski and M. Olano, Hash functions for GPU rendering, J. Computer Graphics Techniques 9(3),
/// 2020, pcg2d
/// @param v  column and row * 1664525 + 1013904223
vec2 bump_random(in uvec2 v) {
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    v ^= v >> 16u;
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    v ^= v >> 16u;
    return vec2(v >> 8u) * (2.0 / 16777216.0) - 1.0;
}

/// Slopes of gradient noise whose cells have sides of 1, of mean 0 and variance 1 along either axis.
/// source: Perlin 2002, with its quintic; the derivatives follow from it
/// @param node  the cell
/// @param f     place in it
vec2 bump_noise_slope(in ivec2 node, in vec2 f) {
    uvec2 low = uvec2(node) * 1664525u + 1013904223u, high = low + 1664525u;  // of the node and of the next ones
    vec2 a = bump_random(low), b = bump_random(uvec2(high.x, low.y)), c = bump_random(uvec2(low.x, high.y)),
         d = bump_random(high);
    vec2 u = f * f * f * (f * (f * 6.0 - 15.0) + 10.0), du = 30.0 * f * f * (f * (f - 2.0) + 1.0);
    float va = dot(a, f), vb = dot(b, f - vec2(1.0, 0.0)), vc = dot(c, f - vec2(0.0, 1.0)), vd = dot(d, f - 1.0);
    vec2 slope = a + u.x * (b - a) + u.y * (c - a) + u.x * u.y * (a - b - c + d) +
                 du * (u.yx * (va - vb - vc + vd) + vec2(vb, vc) - va);
    return slope / 0.51;  // the variance of its components, by a table of 400 000 of them
}

/// Slopes across gullies of one size, of mean 0, variance 0.3 and at most 2: waves along a hillside that begin
/// anew, as high as chance has it, at each node of a grid.
/// source: the principle of R. Skovbo Johansen's noise of phases (phacelle, 2023), with a bilinear quintic kernel
/// @param across  level unit vector along the hillside, east and north
/// @param size_m  a side of the grid's cells
float bump_gully_wave(in vec2 anchored_m, in vec2 across, in float size_m) {
    vec2 f;
    uvec2 low = uvec2(ground_cell(anchored_m, mat2(1.0 / size_m), f)) * 1664525u + 1013904223u, high = low + 1664525u;
    vec2 a = bump_random(low), b = bump_random(uvec2(high.x, low.y)), c = bump_random(uvec2(low.x, high.y)),
         d = bump_random(high);
    vec2 u = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    vec4 weight = vec4(vec2(1.0 - u.x, u.x) * (1.0 - u.y), vec2(1.0 - u.x, u.x) * u.y);
    vec4 random = vec4(a.x, b.x, c.x, d.x), height = 1.0 + vec4(a.y, b.y, c.y, d.y), aside = 0.4 * height - 0.4;
    height *= 0.75 * height;  // here many, there none
    // Each node's run a little across the fall: all along it they would look combed.
    vec4 along = dot(across, f) - vec4(0.0, across.x, across.y, across.x + across.y);
    along += aside * (dot(vec2(across.y, -across.x), f) - vec4(0.0, across.y, -across.x, across.y - across.x));
    vec4 turns = bump_gully_turns * (0.6 + 0.8 * fract(256.0 * random));
    return dot(weight * height, sin(6.2831853 * turns * along + 3.1415927 * random));
}

/// Slopes of gullies that run down the DEM's hillsides, east and north: nothing on level ground.
/// @param fall     tangent of the DEM's slope, pointing downhill
/// @param pixel_m  the longer side of a pixel on the ground [m]
/// @param snow     share of the ground, 0..1
vec2 bump_gully_slope(in vec2 anchored_m, in vec2 fall, in float pixel_m, in float snow) {
    vec2 sum = vec2(0.0);
    float size_m = bump_gully_posts / frame.normal_texels_per_m, tangent = length(fall);
    // What posts far apart say is less steep than the ground, by a power of their distance. Walls would be organ pipes,
    // gentle slopes would be combed, and snow has gullies only on faces that avalanches sweep.
    float steeper = max(pow(bump_gully_true_m * frame.normal_texels_per_m, -0.3), 1.0);
    float steep = min(tangent * steeper, 1.0);
    steep *= smoothstep(0.2 * snow, 0.7 / (steeper * steeper) + 0.2 * snow, steep) * (1.0 - smoothstep(1.0, 2.5, tangent));
    float depth = bump_gully_depth;
    for (int i = 0; i < bump_gully_octaves; ++i) {
        float seen = 1.0 - smoothstep(0.15, 0.5, bump_gully_turns * pixel_m / size_m);
        if (seen == 0.0 || size_m < bump_gully_finest_m) break;
        vec2 across = vec2(-fall.y, fall.x) * inversesqrt(max(dot(fall, fall), 1e-9));
        vec2 slope = depth * steep * bump_gully_wave(anchored_m, across, size_m) * across;
        sum += seen * slope;
        fall += slope;
        depth *= bump_gully_fading;
        size_m *= bump_gully_octave;
    }
    return sum;
}

/// Turns by 37 degrees, so that the grids of two noises never lie along each other.
const mat2 bump_turn = mat2(0.7986, 0.6018, -0.6018, 0.7986);

/// Slopes of noise below the post spacing, of variance 1 along either axis from near; none where a post has
/// fewer than 6 pixels, and all from 32 on.
/// @param anchored_m   place, as of Surface [m]
/// @param pixel_m      the longer side of a pixel on the ground [m]
/// @param pixel_posts  a side of it in posts
vec2 bump_relief_slope(in vec2 anchored_m, in float pixel_m, in float pixel_posts) {
    float near = 1.0 - smoothstep(1.0 / 32.0, 1.0 / 6.0, pixel_posts);
    vec2 sum = vec2(0.0);
    float size_m = min(0.5 / frame.normal_texels_per_m, bump_coarsest_m);
    mat2 turn = bump_turn;
    for (int i = 0; i < bump_octaves; ++i) {
        if (near == 0.0 || size_m < max(bump_finest_m, 2.0 * pixel_m)) break;
        float seen = 1.0 - smoothstep(0.2, 0.5, pixel_m / size_m);
        // Slopes of a turned noise are turned back.
        vec2 within;
        ivec2 cell = ground_cell(anchored_m, turn * (1.0 / size_m), within);
        sum += seen * (bump_noise_slope(cell, within) * turn);
        size_m *= bump_octave;
        turn = bump_turn * turn;
    }
    return 0.5 * near * sum;
}

/// Invented slopes along the tangent and the bitangent: more on steep ground and on rock than on level ground and on
/// snow.
vec2 bump_invented_slope(in Surface s) {
    const vec4 rough = vec4(0.7, 0.8, 1.5, 0.6);  // sand, grass, rock, snow
    float kind = s.material_weight.x * rough[s.material.x] + s.material_weight.y * rough[s.material.y];
    float snow = dot(s.material_weight, vec2(s.material.x == 3, s.material.y == 3));
    vec3 east = east_at(s.up);
    vec2 fall = vec2(dot(s.ground_normal, east), dot(s.ground_normal, cross(s.up, east))) /
                clamp(dot(s.ground_normal, s.up), 0.1, 1.0);
    float pixel_m = max(length(s.ground_dx_m), length(s.ground_dy_m));
    vec2 slope = sqrt(kind) * bump_gully_slope(s.anchored_m, fall, pixel_m, snow);
#if HAS_near
    slope += kind * (0.05 + 0.13 * min(length(fall), 1.0)) *
             bump_relief_slope(s.anchored_m, pixel_m, s.pixel_posts);
#endif
    return bump_relief * frame.height_range.z * slope;
}

/// A normal of the map in the tangent frame of the ground.
vec3 bump_normal(in vec3 map, in vec3 tangent, in vec3 bitangent, in vec3 normal) {
    return normalize(bump_strength * (map.x * tangent + map.y * bitangent) + map.z * normal);
}

void bump_on_normal(inout Surface s) {
    vec3 map = vec3(0.0);
    int count = s.material_weight.y > 0.0 ? 2 : 1;  // a read less in most places
    for (int i = 0; i < count; ++i)
        map += s.material_weight[i] * bump_read(s, s.material[i]);
    vec3 ground = s.normal;
#if HAS_houses
    Houses houses = houses_at(s.post, s.pixel_posts);
    float open = 1.0 - min(houses.built + houses.street + 0.8 * houses.trees, 1.0);  // roofs and walls are plain
    map = vec3(open * map.xy, map.z);
#else
    const float open = 1.0;
#endif
#if !HAS_outside
    vec2 slope = open * bump_invented_slope(s);
    ground -= slope.x * s.tangent + slope.y * s.bitangent;
#endif
    s.normal = bump_normal(map, s.tangent, s.bitangent, ground);
}

/// Self-shadowing factor of one normal. @param cosine  of the angle between it and the sun
float bump_factor(in float cosine) {
    float smoothed = smoothstep(0.0, bump_softness, cosine);
    float abrupt = cosine > 0.0 ? 1.0 : 0.0;
    return bump_correction == 2 ? smoothed : bump_correction == 1 ? abrupt : 1.0;
}

void bump_on_facing(in Surface s, in vec3 to_sun, inout float factor) {
    factor *= bump_factor(dot(s.geometric_normal, to_sun)) * bump_factor(dot(s.normal, to_sun));
}
