//! provides  lines of a vector file on the ground, of constant width in the picture or in metres
//! hook      display
//! reads     lines of tracks.file; of tracks.colours=light, shadow clearances of all posts
//! writes    overlay, premultiplied sRGB

//@ include lib/lines.glsl
//@ include lib/sun_share.glsl

uniform sampler2D tracks_way;

uniform float tracks_width_px = 3.0; //@ range(0.3, 50) unit(px) label("Least width") description("In the picture, where the width on the ground is less")
uniform float tracks_width_m = 0.0; //@ range(0, 500) unit(m) label("Width on the ground")
uniform float tracks_casing_px = 1.0; //@ range(0, 10) unit(px) label("Casing") description("Width of the edge on either side")
uniform vec3 tracks_colour = vec3(0.90, 0.16, 0.10); //@ colour(srgb) label("Colour")
uniform vec3 tracks_casing_colour = vec3(1.0, 1.0, 1.0); //@ colour(srgb) label("Colour of the casing")
uniform float tracks_opacity = 1.0; //@ range(0, 1) label("Opacity")
uniform float tracks_dash_m = 0.0; //@ range(0, 10000) unit(m) label("Dash") description("Length of dashes and of the gaps between; 0: no dashes")
uniform int tracks_colours = 0; //@ enum(one, attribute, light) label("Colours") description("One colour, by the numbers of tracks.by, or by direct light")
uniform vec3 tracks_shade_colour = vec3(0.10, 0.14, 0.38); //@ colour(srgb) label("Colour in shade") description("Of parts without direct light, with tracks.colours")
uniform float tracks_from = 0.0; //@ range(-1e6, 1e6) label("Lowest number")
uniform float tracks_to = 100.0; //@ range(-1e6, 1e6) label("Highest number")

const vec3 tracks_ramp[5] = vec3[](
    vec3(0.27, 0.00, 0.33), vec3(0.23, 0.32, 0.55), vec3(0.13, 0.57, 0.55), vec3(0.37, 0.79, 0.38),
    vec3(0.99, 0.91, 0.14)); //@ ramp(from, to) label("Tracks") where(colours, attribute)

const float tracks_smooth_px = 0.5;  // on either side of an edge

vec3 tracks_by_value(in float value) {
    float at = clamp((value - tracks_from) / max(tracks_to - tracks_from, 1e-9), 0.0, 1.0) * 4.0;
    int i = min(int(at), 3);
    return mix(tracks_ramp[i], tracks_ramp[i + 1], at - float(i));
}

/// Colour of ground that has so much of the direct light, of the sun or at night of the moon.
vec3 tracks_by_light(in float share) { return mix(tracks_shade_colour, tracks_colour, share); }

/// Visible part of the sun, or of the moon that lights a night, over the terrain.
float tracks_light(in Surface s) {
    vec3 to_sun;
    sun_light(s.up, to_sun);
    return sun_share(s, to_sun);
}

/// How much of a pixel is within a line, 0..1. @param edge_px  more on either side
float tracks_cover(in LineHit hit, in float edge_px) {
    float half_px = 0.5 * tracks_width_px + edge_px;
    float in_picture = half_px + tracks_smooth_px - hit.pixels;
    float on_ground = (0.5 * tracks_width_m - hit.metres) / hit.step_m + edge_px + tracks_smooth_px;
    return clamp(max(in_picture, on_ground), 0.0, min(2.0 * half_px, 1.0));
}

/// 1 on dashes, 0 between, smoothed over a pixel.
float tracks_dash(in LineHit hit) {
    if (tracks_dash_m <= 0.0) return 1.0;
    float at_m = mod(hit.along_m, 2.0 * tracks_dash_m);
    float inside_m = min(at_m, tracks_dash_m - at_m);
    inside_m = max(inside_m, at_m - 2.0 * tracks_dash_m);
    // Dashes shorter than pixels become their mean.
    float sharp = tracks_dash_m / hit.along_step_m;
    return mix(0.5, clamp(0.5 + inside_m / hit.along_step_m, 0.0, 1.0), clamp(sharp - 1.0, 0.0, 1.0));
}

void tracks_on_display(in Surface s, inout vec4 overlay) {
    float reach_px = 0.5 * tracks_width_px + tracks_casing_px + tracks_smooth_px;
    LineHit hit = lines_near(tracks_way, s, reach_px, 0.5 * tracks_width_m);
    if (hit.line < 0) return;
    bool has_value = tracks_colours == 1 && hit.value > lines_no_value;
    vec3 colour = has_value ? tracks_by_value(hit.value) : tracks_colour;
    if (tracks_colours == 2) colour = tracks_by_light(tracks_light(s));
    float shown = tracks_opacity * tracks_dash(hit);
    float cased = shown * tracks_cover(hit, tracks_casing_px), line = shown * tracks_cover(hit, 0.0);
    vec4 drawn = vec4(tracks_casing_colour * (cased - min(line, cased)) + colour * line, cased);
    overlay = drawn + overlay * (1.0 - drawn.a);
}
