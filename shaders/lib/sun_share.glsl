//! provides  sun_share: how much of the sun's disc a point of the ground sees past the ground of the DEM
//! reads     light_margins, light_shares (core/render/ground_light.h)
//! source    core/light/raster/clearance.h finds the clearances

//@ include lib/moved.glsl

uniform sampler2D light_margins;  // rg: height above the edges of the upper and the lower limb's shadow [m]
uniform sampler2D light_shares;   // r: mean share of the disc, times coverage; g: coverage; of 2 x 2 posts and more

const float kMarginHole = 60001.0;  // what is greater stands for no ground
const float kAtPost = 0.06;  // so far from a post, in spacings, its own margin counts as it is ...
const float kSides = 4.0;    // ... and this much farther, as a caster's: 1 / spacings

/// How much of a disc is over a level line; within 0.002. @param height  of its diameter, 0 to 1
float sun_disc_share(in float height) {
    float x = min(height, 1.0 - height);
    float part = x * sqrt(x) * (1.6977 - 0.567 * x);
    return height < 0.5 ? part : 1.0 - part;
}

/// Between four posts, of which those that are holes do not count.
float between(in vec4 values, in vec4 weights) {
    return dot(values, weights) / max(dot(weights, vec4(1.0)), 1e-6);
}

/// The way to the sun over the margins' texels, unit.
vec2 sun_way(in vec3 to_sun, in vec3 up) {
    vec3 east = east_at(up);
    vec2 level = frame.light_map.x > 0.5 ? vec2(dot(to_sun, east), dot(to_sun, cross(up, east))) : to_sun.xy;
    vec2 way = level.x * frame.light_axes.xy + level.y * frame.light_axes.zw;
    return way * inversesqrt(max(dot(way, way), 1e-30));
}

/// Margins of the posts around as they count for ground between them. A post that is lit and stands
/// between the sun and ground in the shade casts the shadow itself: behind it the margin begins at 0,
/// and on the way to lit ground at no more than that has.
/// @param sunward  how far each post is on the sun's side, 0 to 1
vec4 counting(in vec4 margins, in vec4 weights, in vec4 sunward) {
    float behind = between(margins, weights * (1.0 - sunward) + 1e-6 * weights);
    return mix(margins, min(margins, max(behind, 0.0)), sunward);
}

/// From the margins at the posts around.
/// @param node   in texels of light_margins, the middle of the first at 0
/// @param way    to the sun
float sun_share_of_margins(in vec2 node, in vec2 way, in float pixel, in float moved_m) {
    vec2 quad = floor(node), t = node - quad;
    vec2 at = (quad + 1.0) / vec2(textureSize(light_margins, 0));
    vec4 upper = textureGather(light_margins, at, 0), lower = textureGather(light_margins, at, 1);
    vec4 weights = vec4((1.0 - t.x) * t.y, t.x * t.y, t.x * (1.0 - t.y), (1.0 - t.x) * (1.0 - t.y));
    bvec4 holes = greaterThan(upper, vec4(kMarginHole));
    weights *= vec4(not(holes));
    vec4 most = vec4(frame.light_grid.w);
    upper = clamp(upper + moved_m, -most, most);
    lower = clamp(lower + moved_m, -most, most);
    upper = mix(upper, vec4(between(upper, weights)), holes);
    lower = mix(lower, vec4(between(lower, weights)), holes);
    vec4 sunward = clamp(kSides * ((vec4(0.0, 1.0, 1.0, 0.0) - t.x) * way.x +
                                   (vec4(1.0, 1.0, 0.0, 0.0) - t.y) * way.y - kAtPost), 0.0, 1.0);
    upper = counting(upper, weights, sunward);
    lower = counting(lower, weights, sunward);
    float high = between(upper, weights), low = between(lower, weights);
    // What the pixel spans is as a penumbra, too: an edge is smooth over one pixel.
    vec4 middle = 0.5 * (upper + lower);
    vec2 slope = vec2(mix(middle.z - middle.w, middle.y - middle.x, t.y),
                      mix(middle.x - middle.w, middle.y - middle.z, t.x));
    float width = high - low + pixel * length(slope);
    float share = sun_disc_share(clamp(0.5 + 0.5 * (high + low) / max(width, 1e-3), 0.0, 1.0));
    bool lit = all(greaterThanEqual(lower, vec4(0.0))), shaded = all(lessThan(upper, vec4(0.0)));
    return lit ? 1.0 : shaded ? 0.0 : share;
}

/// @param to_sun  as the point sees it, unit
float sun_share(in Surface s, in vec3 to_sun) {
    vec2 node = (s.post + 0.5) * frame.light_grid.x - 0.5;
    float pixel = s.pixel_posts * frame.light_grid.x, moved_m = surface_moved_up_m(s);
    float near = sun_share_of_margins(node, sun_way(to_sun, s.up), min(pixel, 1.0), moved_m);
    // Pixels that hold several posts see the mean of what those see.
    float level = log2(max(pixel, 1.0));
    vec2 at = (node + 0.5) / (2.0 * vec2(textureSize(light_shares, 0)));
    vec2 share = textureLod(light_shares, at, max(level - 1.0, 0.0)).rg;
    float far = share.g > 0.0 ? share.r / share.g : near;
    return mix(near, far, moved_m == 0.0 ? min(level, 1.0) : 0.0);
}
