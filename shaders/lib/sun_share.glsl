//! provides  sun_share: visible fraction of the solar disc at a point of the ground, after occlusion by terrain;
//!           sun_shadow_clearance: how far ground is above or in the shadow of terrain
//! reads     light_clearance, light_fraction (core/render/ground_light.h)
//! source    core/light/raster/clearance.h computes the clearances

//@ include lib/moved.glsl

uniform sampler2D light_clearance;  // rg: shadow clearances of the upper and the lower limb [m]
uniform sampler2D light_fraction;   // r: visible fraction times coverage, g: coverage; means of 2 x 2 posts and more

const float kVoidClearance = 60001.0;  // greater clearances are voids
const float kAtPost = 0.06;  // up to this many spacings from a post, its own clearance is used unchanged ...
const float kSides = 4.0;    // ... and this much farther, as a caster's: 1 / spacings

/// Fraction of a disc above a level line, within 0.002. @param height  fraction of its diameter above it
float sun_disc_share(in float height) {
    float x = min(height, 1.0 - height);
    float part = x * sqrt(x) * (1.6977 - 0.567 * x);
    return height < 0.5 ? part : 1.0 - part;
}

/// Weighted mean of four posts.
float between(in vec4 values, in vec4 weights) {
    return dot(values, weights) / max(dot(weights, vec4(1.0)), 1e-6);
}

/// Unit direction to the sun in texels of light_clearance.
vec2 sun_way(in vec3 to_sun, in vec3 up) {
    vec3 east = east_at(up);
    vec2 level = frame.light_map.x > 0.5 ? vec2(dot(to_sun, east), dot(to_sun, cross(up, east))) : to_sun.xy;
    vec2 way = level.x * frame.light_axes.xy + level.y * frame.light_axes.zw;
    return way * inversesqrt(max(dot(way, way), 1e-30));
}

/// Clearances of four posts for ground between them. A lit post between the sun and shaded ground casts
/// that shadow itself: behind it the clearance begins at 0. Towards lit ground it is at most the clearance
/// of that ground.
/// @param sunward  1 for posts on the sun's side, 0 for the others
vec4 limited(in vec4 clearances, in vec4 weights, in vec4 sunward) {
    float behind = between(clearances, weights * (1.0 - sunward) + 1e-6 * weights);
    return mix(clearances, min(clearances, max(behind, 0.0)), sunward);
}

/// Visible fraction from the clearances of the four posts around.
/// @param node   in texels of light_clearance; 0 is the centre of the first
/// @param way    sun_way()
/// @param pixel  side of the pixel in texels
float sun_share_of_clearance(in vec2 node, in vec2 way, in float pixel, in float moved_m) {
    vec2 quad = floor(node), t = node - quad;
    vec2 at = (quad + 1.0) / vec2(textureSize(light_clearance, 0));
    vec4 upper = textureGather(light_clearance, at, 0), lower = textureGather(light_clearance, at, 1);
    vec4 weights = vec4((1.0 - t.x) * t.y, t.x * t.y, t.x * (1.0 - t.y), (1.0 - t.x) * (1.0 - t.y));
    bvec4 voids = greaterThan(upper, vec4(kVoidClearance));
    weights *= vec4(not(voids));
    vec4 most = vec4(frame.light_grid.w);
    upper = clamp(upper + moved_m, -most, most);
    lower = clamp(lower + moved_m, -most, most);
    upper = mix(upper, vec4(between(upper, weights)), voids);
    lower = mix(lower, vec4(between(lower, weights)), voids);
    vec4 sunward = clamp(kSides * ((vec4(0.0, 1.0, 1.0, 0.0) - t.x) * way.x +
                                   (vec4(1.0, 1.0, 0.0, 0.0) - t.y) * way.y - kAtPost), 0.0, 1.0);
    upper = limited(upper, weights, sunward);
    lower = limited(lower, weights, sunward);
    float high = between(upper, weights), low = between(lower, weights);
    // The pixel widens the penumbra, so that edges are smooth over one pixel.
    vec4 middle = 0.5 * (upper + lower);
    vec2 slope = vec2(mix(middle.z - middle.w, middle.y - middle.x, t.y),
                      mix(middle.x - middle.w, middle.y - middle.z, t.x));
    float width = high - low + pixel * length(slope);
    float share = sun_disc_share(clamp(0.5 + 0.5 * (high + low) / max(width, 1e-3), 0.0, 1.0));
    bool lit = all(greaterThanEqual(lower, vec4(0.0))), shaded = all(lessThan(upper, vec4(0.0)));
    return lit ? 1.0 : shaded ? 0.0 : share;
}

/// @param to_sun  unit vector at the point
float sun_share(in Surface s, in vec3 to_sun) {
    vec2 node = (s.post + 0.5) * frame.light_grid.x - 0.5;
    float pixel = s.pixel_posts * frame.light_grid.x, moved_m = surface_moved_up_m(s);
    float near = sun_share_of_clearance(node, sun_way(to_sun, s.up), min(pixel, 1.0), moved_m);
    // Pixels that cover several posts have their mean.
    float level = log2(max(pixel, 1.0));
    vec2 at = (node + 0.5) / (2.0 * vec2(textureSize(light_fraction, 0)));
    vec2 share = textureLod(light_fraction, at, max(level - 1.0, 0.0)).rg;
    float far = share.g > 0.0 ? share.r / share.g : near;
    return mix(near, far, moved_m == 0.0 ? min(level, 1.0) : 0.0);
}

/// Height of the ground at a post above the shadow of the terrain, of the sun's centre [m]; below 0 in the shadow, and 1e9
/// where nothing is known.
float sun_shadow_clearance(in vec2 post) {
    vec2 node = (post + 0.5) * frame.light_grid.x - 0.5;
    vec2 quad = floor(node), t = node - quad, size = vec2(textureSize(light_clearance, 0));
    if (any(lessThan(node, vec2(-0.5))) || any(greaterThan(node, size - 0.5))) return 1e9;
    vec2 at = (quad + 1.0) / size;
    vec4 upper = textureGather(light_clearance, at, 0), lower = textureGather(light_clearance, at, 1);
    vec4 weights = vec4((1.0 - t.x) * t.y, t.x * t.y, t.x * (1.0 - t.y), (1.0 - t.x) * (1.0 - t.y));
    weights *= vec4(lessThan(upper, vec4(kVoidClearance)));
    return dot(weights, vec4(1.0)) > 0.0 ? 0.5 * between(upper + lower, weights) : 1e9;
}
