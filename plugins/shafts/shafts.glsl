//! provides  shafts: shares of the sun in the air before each pixel, after occlusion by terrain
//! hook      visibility, atmosphere, sky
//! reads     shadow clearances of all posts, heights of the DEM, depth of the ground
//! writes    air_sun_shares (lib/air_sun.glsl), from which haze and fog take their light; the sky's radiance
//! source    heights of shadows: core/light/sweep; the air: core/sky/eye_tables.h

//@ include lib/air.glsl
//@ include lib/air_pixel.glsl
//@ include lib/air_sun.glsl
//@ include lib/beyond.glsl
//@ include lib/ground.glsl
//@ include lib/height_means.glsl
//@ include lib/pixel.glsl
//@ include lib/pixel_half.glsl
//@ include lib/screen.glsl
//@ include lib/sun_share.glsl

uniform sampler2D shafts_edge;
uniform sampler2D shafts_view;
uniform sampler2D shafts_depths; //@ from(core.ground_depth)

const int shafts_steps = 8;  // in each of the three parts of a ray
const float shafts_far_m = 1e6;
const float shafts_earth_m = 6371000.0;

/// Height of the upper edge of the shadow over a place, as drawn [m].
vec4 shafts_pass_edge(in Texel t) {
    vec2 post = round(t.at * frame.posts.xy - 0.5);  // between posts the two may be of other reductions
    float clearance_m = sun_shadow_clearance(post);
    float height_m = frame.height_range.z * (clearance_m > 1e8 ? frame.height_range.x : height_of_texel(post));
    return vec4(height_m - min(clearance_m, 6e4));
}

/// Where a ray is below a level, from x to y along it [m]; x = y where it is not.
/// @param above_m  the level's height, from that of the eye
vec2 shafts_below(in float above_m, in float sine) {
    float bend = 0.5 * (1.0 - sine * sine) / shafts_earth_m;
    float root2 = sine * sine + 4.0 * bend * above_m;
    if (root2 <= 0.0) return vec2(0.0);  // passes over it
    float root = sqrt(root2), out_m = above_m > 0.0 ? 2.0 * above_m / max(sine + root, 1e-9)
                                                    : (root - sine) / max(2.0 * bend, 1e-12);
    if (above_m > 0.0) return vec2(0.0, out_m);
    return sine < 0.0 ? vec2(-2.0 * above_m / (root - sine), out_m) : vec2(0.0);
}

/// Where a ray is over the DEM, along it [m]. @param step  columns and rows to a metre
vec2 shafts_over_dem(in vec2 step) {
    vec2 eye = frame.eye_post.xy + frame.eye_post.zw, margin = 0.02 * frame.posts.xy;
    vec2 pace = mix(vec2(1e-12), step, greaterThan(abs(step), vec2(1e-12)));
    vec2 a = (-margin - eye) / pace, b = (frame.posts.xy - 1.0 + margin - eye) / pace;
    vec2 first = min(a, b), last = max(a, b);
    return vec2(max(first.x, first.y), min(last.x, last.y));
}

/// A ray's columns and rows to a metre east, x, and north, y, of its way.
vec2 shafts_level(in vec3 direction) {
    vec3 up = frame.eye_up.xyz, east = east_at(up);
    return vec2(dot(direction, east), dot(direction, cross(up, east)));
}

/// The part of a ray that may be in the shade of terrain, from x to y along it [m].
/// @param limit_m  where it ends; kSky_m: nowhere, or on the country beyond the DEM
vec2 shafts_way(in vec3 direction, in float limit_m) {
    float country_m = beyond_distance_m(direction);
    if (limit_m == kSky_m && country_m > 0.0) limit_m = country_m;
    vec2 level = shafts_level(direction);
    float top_m = frame.height_range.z * (frame.height_range.x + 1.0 / frame.height_range.y);
    vec2 below = shafts_below(top_m - frame.eye_m.w, dot(direction, frame.eye_up.xyz));
    vec2 over = shafts_over_dem(level.x * frame.eye_axes.xy + level.y * frame.eye_axes.zw);
    vec2 way = vec2(max(below.x, max(over.x, 0.0)), min(min(below.y, over.y), min(limit_m, shafts_far_m)));
    return way.y > way.x && frame.eye_axes != vec4(0.0) ? way : vec2(0.0);
}

/// How far a point of a ray is above the shadow [m].
/// @param level  shafts_level()
float shafts_clear_m(in vec2 level, in float sine, in float way_m) {
    float height_m = air_sun_height_m(sine, way_m);
    vec2 level_m = level * (way_m * shafts_earth_m / (shafts_earth_m + height_m));
    vec3 squares = vec3(level_m.x * level_m.x, level_m.x * level_m.y, level_m.y * level_m.y);
    vec2 post = frame.eye_post.xy + frame.eye_post.zw + level_m.x * frame.eye_axes.xy + level_m.y * frame.eye_axes.zw +
                vec2(dot(frame.eye_bends[0].xyz, squares), dot(frame.eye_bends[1].xyz, squares));
    vec2 at = (post + 0.5) * frame.posts.zw;
    bool known = all(greaterThan(at, vec2(0.0))) && all(lessThan(at, vec2(1.0)));
    return known ? height_m - textureLod(shafts_edge, at, 0.0).r : 1e6;
}

/// Shares of the sun in the three parts of a way. Between samples the height over the shadow is linear.
/// @param jitter  -0.5 to 0.5: moves the samples within
vec3 shafts_shares(in vec3 direction, in vec2 way, in float jitter) {
    vec2 level = shafts_level(direction);
    float sine = dot(direction, frame.eye_up.xyz), step_m = (way.y - way.x) / float(3 * shafts_steps);
    vec3 shares = vec3(0.0);
    float before = shafts_clear_m(level, sine, way.x), moved_before = 0.0;
    for (int i = 1; i <= 3 * shafts_steps; ++i) {
        // The ends of the parts stay where they are.
        float moved = i % shafts_steps == 0 ? 0.0 : jitter, length = 1.0 + moved - moved_before;
        float here = shafts_clear_m(level, sine, way.x + (float(i) + moved) * step_m);
        float lit = (max(before, 0.0) + max(here, 0.0)) / max(abs(before) + abs(here), 1e-3);
        shares[(i - 1) / shafts_steps] += lit * length / float(shafts_steps);
        before = here;
        moved_before = moved;
    }
    return shares;
}

/// The shares before what every second pixel shows, and how near that is [1/km]; 0 in the sky.
vec4 shafts_pass_view(in Texel t) {
    ivec2 pixel = min(2 * ivec2(t.at_px), textureSize(shafts_depths, 0) - 1);
    vec3 ray = pixel_ray_at(vec2(pixel) + 0.5);
    float depth_m = screen_depth(shafts_depths, pixel), far_m = depth_m == kSky_m ? kSky_m : depth_m * length(ray);
    vec2 way = shafts_way(normalize(ray), far_m);
    float jitter = pixel_noise(floor(t.at_px) + floor(0.5 * vec2(frame.part_left, frame.part_below))) - 0.5;
    vec3 shares = way.y > way.x ? shafts_shares(normalize(ray), way, jitter) : vec3(1.0);
    return vec4(shares, far_m == kSky_m ? 0.0 : 1000.0 / far_m);
}

/// Finds the light in the air before what a pixel shows. At the horizon the shadow is the Earth's, which the air has.
/// @param far_m  to it, or kSky_m
void shafts_find(in vec3 direction, in float far_m) {
    air_sun_way_m = shafts_way(direction, far_m);
    vec3 shares = pixel_of_half(shafts_view, shafts_view, true, far_m == kSky_m ? 0.0 : 1000.0 / far_m).xyz;
    air_sun_shares = mix(vec3(1.0), shares, smoothstep(-0.005, 0.01, frame.sun_apparent.w));
}

bool shafts_is_ground = false;  // set by the hooks of the ground: mirrors then ask for the sky

void shafts_on_visibility(in Surface s, in vec3 to_sun, inout float factor) {
    shafts_is_ground = true;
}

void shafts_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {
#if !HAS_outside
    shafts_find(view, s.distance_m);
#endif
}

/// What the shade of terrain takes from the light of the air in a direction without ground.
vec3 shafts_shade(in vec3 direction) {
    float way_m = air_sun_way_m.y;
    AirBetween air = air_between_eye_and(direction, way_m);
    vec3 depth = air_scale_beyond(way_m) * air.depth;
    return air.once * (1.0 - exp(-depth)) * (1.0 - air_sun_lit(direction, way_m, depth, vec3(0.0), vec4(0.0)));
}

void shafts_on_sky(in vec3 direction, inout vec3 radiance, inout vec3 transmittance) {
#if !HAS_outside
    if (shafts_is_ground || !air_in_sky) return;
    shafts_find(direction, kSky_m);
    radiance = max(radiance - shafts_shade(direction), 0.0);
#endif
}
