//! provides  sky_far_clouds: fair-weather clouds over the country that is made up around a DEM seen from the air
//! reads     direction of the view, height of the eye [m], light of sun and sky
//! frame     cells of a field that repeats, along the DEM's east and north

//@ include lib/air.glsl
//@ include lib/beyond.glsl
//@ include lib/noise.glsl
//@ include lib/pixel.glsl

uniform sampler2D sky_heaps;
uniform sampler2D sky_clouds_seen;
uniform sampler2D sky_ground_depth; //@ from(core.ground_depth)

uniform float sky_clouds = 0.5; //@ range(0, 1) label("Clouds far away") description("Fair-weather clouds over the country that is made up around a DEM seen from the air; 0: none")

const float sky_heaps_texels = 512.0, sky_heaps_cells = 16.0;  // of a side of the field
const int sky_slices = 10;                                     // through the clouds, from their tops down
const float sky_base_m = 1500.0;                               // of the clouds, above the country
const float sky_cells_a_year = 44000.0;                        // that the wind moves them: 7 m/s for cells of 5 km

/// An octave of value noise that repeats after `period` cells.
float sky_octave(in vec2 at, in float period, in uint stream) {
    vec2 whole = floor(at), w = smoothstep(0.0, 1.0, at - whole);
    ivec2 low = ivec2(mod(whole, period)), high = ivec2(mod(whole + 1.0, period));
    return mix(mix(noise_random(low, stream), noise_random(ivec2(high.x, low.y), stream), w.x),
               mix(noise_random(ivec2(low.x, high.y), stream), noise_random(high, stream), w.x), w.y);
}

/// The field, 0..1: heaps, the smaller ones on groups of them. Its last texels repeat the first, so that filters see no
/// seam.
vec4 sky_pass_heaps(in Texel t) {
    vec2 at = sky_heaps_cells * fract((t.at * sky_heaps_texels - 0.5) / (sky_heaps_texels - 1.0));
    vec4 finer = vec4(0.25, 1.0, 2.0, 4.0), heights = vec4(0.34, 0.30, 0.22, 0.14);
    float sum = 0.0;
    for (int i = 0; i < 4; ++i)
        sum += heights[i] * sky_octave(finer[i] * at, finer[i] * sky_heaps_cells, 71u + uint(i));
    return vec4(sum);
}

float sky_heap(in vec2 cells) {
    vec2 texel = fract(cells / sky_heaps_cells) * (sky_heaps_texels - 1.0) + 0.5;
    return textureLod(sky_heaps, texel / sky_heaps_texels, 0.0).r;
}

/// Width of a cell [m], by that of the DEM.
float sky_cell_m(in float width_m) {
    return clamp(0.08 * width_m, 2500.0, 60000.0);
}

/// Share of the sky that clouds cover above a place, which begins at some way from the DEM: they are not over its ground.
float sky_cover_at(in vec2 place_m, in vec2 sides_m, in float width_m) {
    vec2 off = abs((place_m - frame.ground_extent.xy) * frame.ground_extent.zw - 0.5) - 0.5;
    return sky_clouds * smoothstep(0.15, 0.4, length(max(off, 0.0) * sides_m) / width_m);
}

/// Light of a cloud. @param level  0 at its base, 1 at its top  @param facing  how much it faces the sun
vec3 sky_cloud_light(in float level, in float facing) {
    float lit = clamp(0.4 + 0.6 * level + 3.0 * facing, 0.15, 1.0);
    vec3 sun = max(frame.sun_apparent.z, 0.25) * frame.sun_light[0].rgb;
    return 0.8 * (lit * sun + (0.5 + 0.5 * lit) * frame.sky_irradiance.rgb);
}

/// Radiance of the clouds through the air before them, times the share of the pixel that they cover; and that share.
/// They are made up as the country is, from latitude, date and the DEM's sides: every picture of them is the same.
/// @param slices  sky_slices; 0: none are seen
vec4 sky_far_clouds(in vec3 direction, in int slices) {
    float sine = dot(direction, frame.eye_up.xyz);
    vec2 sides_m = 1.0 / frame.ground_extent.zw;
    float width_m = sqrt(sides_m.x * sides_m.y), cell_m = sky_cell_m(width_m);
    // Flatter towards the horizon, where slices of tall ones would stand apart.
    float tall_m = clamp(-1.6 * sine, 0.0, 0.2) * cell_m;
    float first_m = beyond_distance_above(direction, sky_base_m + tall_m);
    float last_m = beyond_distance_above(direction, sky_base_m);
    vec2 from = frame.eye_m.xy / cell_m + vec2(5000.0 * frame.polar_axis.z, sky_cells_a_year * frame.time_of_year);
    float edge = mix(0.82, 0.34, sky_cover_at(frame.eye_m.xy + last_m * direction.xy, sides_m, width_m));
    float soft = 0.07 + 0.3 * min(last_m * length(frame.pixel_ray_dx.xyz) / (cell_m * max(-sine, 0.02)), 1.0);
    float share = 0.0, high = 0.0;
    for (int i = 0; i < slices; ++i) {
        float level = 1.0 - float(i) / float(sky_slices - 1);
        float heap = sky_heap(mix(last_m, first_m, level) / cell_m * direction.xy + from);
        float part = (1.0 - share) * smoothstep(0.0, soft, heap - edge - 0.18 * level * level);
        share += part;
        high += part * level;
    }
    if (first_m <= 0.0 || share <= 0.0) return vec4(0.0);
    float level = high / share, distance_m = mix(last_m, first_m, level);
    vec2 at = distance_m / cell_m * direction.xy + from;
    float facing = sky_heap(at) - sky_heap(at + 0.12 * normalize(frame.sun_apparent.xy + 1e-6));
    AirBetween air = air_between_eye_and(direction, distance_m);
    vec3 through = exp(-air_scale_beyond(distance_m) * air.depth);
    return share * vec4(mix(air.radiance, sky_cloud_light(level, facing), through), 1.0);
}

/// Whether a pixel that is drawn from a texel of two by two shows no ground.
bool sky_shows_no_ground(in vec2 at) {
    vec2 aside = 1.5 * frame.viewport.zw;
    float nearest = 1.0;
    for (int i = 0; i < 4; ++i)
        nearest = min(nearest, textureLod(sky_ground_depth, at + (vec2(2 * (i % 2), i & 2) - 1.0) * aside, 0.0).r);
    return nearest == 0.0;
}

/// For two by two pixels, exposed: halves do not hold the light of a night.
vec4 sky_pass_clouds_seen(in Texel t) {
    vec3 direction = normalize(pixel_ray_at(t.at_px * frame.viewport.xy / t.size_px));
    bool may_be_seen = frame.beyond > 0.0 && sky_clouds > 0.0 && dot(direction, frame.eye_up.xyz) < 0.0;
    vec4 seen = sky_far_clouds(direction, may_be_seen && sky_shows_no_ground(t.at) ? sky_slices : 0);
    return vec4(frame.exposure * seen.rgb, seen.a);
}

#if defined(BEYOND) && !HAS_clouds

/// A radiance with the clouds of this pixel before it.
vec3 sky_behind_clouds(in vec3 radiance) {
    vec4 seen = textureLod(sky_clouds_seen, gl_FragCoord.xy * frame.viewport.zw, 0.0);
    return (1.0 - seen.a) * radiance + seen.rgb / frame.exposure;
}

#else

vec3 sky_behind_clouds(in vec3 radiance) { return radiance; }

#endif
