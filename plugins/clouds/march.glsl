//! provides  the decks along a ray: how bright, how opaque, how far
//! reads     depth of the ground; the sun's direction

//@ include lib/eye_light.glsl
//@ include lib/pixel.glsl
//@ include lib/screen.glsl

uniform int clouds_steps = 96; //@ range(8, 128) label("Steps") description("Samples along a ray through a deck")

uniform float clouds_rain = 0.0; //@ range(0, 1) label("Rain") description("Shafts of rain below the thick parts of the lowest deck: 1 is heavy rain")

uniform sampler2D clouds_below;
uniform sampler2D clouds_depths; //@ from(core.ground_depth)
uniform sampler2D clouds_near;

const float clouds_far_m = 500000.0;
const int clouds_rain_steps = 12;
const float clouds_rain_step_m = 1700.0;  // at most, and at most 0.6 of clouds_cell_m: shafts are wider
const float clouds_rain_extinction = 1e-3;  // of heavy rain [1/m]

/// Where a ray is inside of a deck, from x to y along it [m]; empty if y <= x.
/// @param height_m  of the eye
/// @param sine      of the ray's elevation
vec2 clouds_inside_deck(in clouds_Deck d, in float height_m, in float sine) {
    float bend = 0.5 * (1.0 - sine * sine) / clouds_earth_m;
    float at_base = sine * sine + 4.0 * bend * (d.base_m - height_m);
    float at_top = sine * sine + 4.0 * bend * (d.top_m - height_m);
    if (height_m < d.base_m)
        return vec2(clouds_way_up(d.base_m - height_m, sine), clouds_way_up(d.top_m - height_m, sine));
    bool reaches_base = sine < 0.0 && at_base >= 0.0;
    float base_way = 2.0 * (d.base_m - height_m) / min(sine - sqrt(max(at_base, 0.0)), -1e-6);
    if (height_m <= d.top_m) return vec2(0.0, reaches_base ? base_way : clouds_way_up(max(d.top_m - height_m, 0.1), sine));
    if (sine >= 0.0 || at_top < 0.0) return vec2(0.0);
    float in_way = 2.0 * (d.top_m - height_m) / min(sine - sqrt(at_top), -1e-6);
    float out_way = (sqrt(at_top) - sine) / max(2.0 * bend, 1e-12);
    return vec2(in_way, reaches_base ? base_way : out_way);
}

/// Optical depth from a point of a deck along a direction. Samples are the softer the farther they are apart, so that no
/// edge shows where one of them enters a cloud.
float clouds_towards(in clouds_Deck d, in int deck, in vec3 position_m, in float height_m, in vec3 way, in float sine) {
    float tau = 0.0, from_m = 0.0, step_m = 0.05 * (d.top_m - d.base_m);
    for (int i = 0; i < 5; ++i) {
        float at_m = from_m + 0.5 * step_m;
        tau += step_m * clouds_point(d, deck, position_m + at_m * way, height_m + at_m * sine, step_m).extinction;
        from_m += step_m;
        step_m *= 2.0;
    }
    return tau;
}

/// What the decks above one do to light, at a point: x share of the sun's that they let through, y of the sky's, z share
/// of the light from below that they reflect.
vec3 clouds_shade_above(in int deck, in vec3 position_m, in float height_m, in vec3 to_sun, in float sine) {
    float tau = 0.0;
    int count = clouds_count();
    for (int above = 1; above < 3; ++above) {
        if (above >= count) break;
        clouds_Deck d = clouds_deck(above);
        if (above <= deck || d.cover <= 0.0 || d.base_m <= height_m) continue;
        vec3 there = position_m + clouds_way_up(d.base_m - height_m, max(sine, 0.02)) * to_sun;
        vec4 columns = clouds_at(clouds_place(there, d.base_m));
        tau += clouds_tau(d, columns[above], columns.a);
    }
    float mu = max(sine, 0.1);
    float back = clouds_reflected_sky(tau);
    return vec3(exp(-tau / mu) + clouds_diffuse_of_sun(tau, mu), 1.0 - back, back);
}

/// Top of a sheet with its billows [m].
float clouds_sheet_m(in clouds_Deck d, in int deck, in vec2 place, in float height_m) {
    vec4 columns = clouds_at(place);
    float tall_m = clouds_column_top_m(d, columns[deck], columns.a) - d.base_m;
    return d.base_m + tall_m * (1.0 - clouds_billow(clouds_lumps_at(place, height_m, d.kind)));
}

/// Light on the waves of a sheet's top over that of a level one: slopes towards the sun have more.
float clouds_relief(in clouds_Deck d, in int deck, in vec3 position_m, in float height_m, in vec3 to_sun, in float mu) {
    const float step_m = 120.0;
    vec2 place = clouds_place(position_m, height_m);
    vec2 there = place + step_m * normalize(to_sun.xy + 1e-6);
    float rise = (clouds_sheet_m(d, deck, there, height_m) - clouds_sheet_m(d, deck, place, height_m)) / step_m;
    return clamp(1.0 - 0.9 * rise / max(mu, 0.25), 0.4, 1.5);
}

/// Light of a point in a deck: x by the sun's light, y by that of the sky.
/// @param p  the same point
vec2 clouds_lit(in clouds_Deck d, in int deck, in vec3 position_m, in float height_m, in clouds_Point p, in vec3 direction,
                in vec3 to_sun, in vec3 up) {
    float sun_sine = dot(to_sun, up), sine = dot(direction, up);
    float before = clouds_towards(d, deck, position_m, height_m, to_sun, sun_sine);
    float behind = clouds_towards(d, deck, position_m, height_m, -to_sun, -sun_sine);
    float cosine = dot(direction, to_sun);
    float mu = clamp(sun_sine, 0.0, 1.0);
    // As a layer, lit from above; as a heap, which stands in the light.
    float layer = max(mu, 0.03) * clouds_inside(p.above / max(mu, 0.15) * max(mu, 0.3), p.below, sine);
    float heap = clouds_inside(before, behind, cosine) * (d.kind == 0 ? 0.45 + 0.55 * mu : 1.5 * mu);
    float open = mix(d.kind == 0 ? 0.35 : 0.6, 1.0, clamp((height_m - d.base_m) / (d.top_m - d.base_m), 0.0, 1.0));
    float once = d.kind == 0 ? 0.6 : mu / (mu + abs(sine) + 0.05);
    if (d.kind == 1 && sine < 0.0) layer *= clouds_relief(d, deck, position_m, height_m, to_sun, mu);
    float stands = d.kind == 0 ? 0.75 : sine < 0.0 ? 0.25 : 0.1;
    // A thin part of a heap before the sun is smaller than a pixel, which must not shine as a whole.
    float shines = min(once * clouds_phase(cosine) * exp(-before), d.kind == 0 ? 1.0 : 10.0);
    float sun = 0.8 * mix(layer, heap, stands) * mix(1.0, open, 0.5) + shines;
    float sky = open * clouds_inside(p.above, p.below, sine);
    // Below, the ground's light; less of it the more is in shade.
    float bounced = 0.15 * clouds_inside(p.below, p.above, -sine);
    float overcast = smoothstep(0.6, 1.0, d.cover) * (1.0 - exp(-0.3 * (p.above + p.below))) * step(0.0, sine);
    float cie = mix(1.0, clouds_overcast(sine), overcast * step(frame.eye_m.w, d.base_m));
    return cie * vec2(sun + bounced * mu * (1.0 - 0.8 * d.cover), sky + bounced * (1.0 - 0.5 * d.cover));
}

/// Height of a point of the eye's ray on the round Earth [m].
float clouds_ray_height(in float sine, in float way_m) {
    return frame.eye_m.w + way_m * (sine + 0.5 * (1.0 - sine * sine) / clouds_earth_m * way_m);
}

/// Over how many metres edges are soft at a distance: the width of a pixel of clouds.view.
float clouds_soft_m(in clouds_Deck d, in float way_m) {
    return max(min(0.1 * (d.top_m - d.base_m), 250.0), 4.0 * length(frame.pixel_ray_dx.xyz) * way_m);
}

clouds_Point clouds_point_of_ray(in clouds_Deck d, in int deck, in vec3 direction, in float sine, in float way_m) {
    return clouds_point(d, deck, way_m * direction, clouds_ray_height(sine, way_m), clouds_soft_m(d, way_m));
}

/// Follows a ray through a cloud to its end. Steps grow with the way.
/// @returns x: opacity, y: mean distance of the visible part, z: end [m]
vec3 clouds_dig(in clouds_Deck d, in int deck, in vec3 direction, in float sine, in float from_m, in float first_m,
                in float limit_m) {
    float passes = 1.0, mean_m = 0.0, step_m = first_m;
    for (int i = 0; i < 10; ++i) {
        step_m = min(step_m, max(limit_m - from_m, 0.0));
        float at_m = from_m + 0.5 * step_m;
        float extinction = clouds_point_of_ray(d, deck, direction, sine, at_m).extinction;
        float opaque = 1.0 - exp(-step_m * extinction);
        mean_m += passes * opaque * at_m;
        passes *= 1.0 - opaque;
        from_m += step_m;
        step_m *= 1.4;
        if (extinction <= 0.0 || passes < 0.01) break;
    }
    return vec3(1.0 - passes, mean_m / max(1.0 - passes, 1e-6), from_m);
}

/// The edge of a cloud between a point outside and one inside of it [m].
float clouds_entry(in clouds_Deck d, in int deck, in vec3 direction, in float sine, in float out_m, in float in_m) {
    for (int i = 0; i < 4; ++i) {
        float middle_m = 0.5 * (out_m + in_m);
        bool inside = clouds_point_of_ray(d, deck, direction, sine, middle_m).extinction > 0.0;
        out_m = inside ? out_m : middle_m;
        in_m = inside ? middle_m : in_m;
    }
    return in_m;
}

/// What a ray meets of a deck, added to what is before it: x, y light by sun and sky, z transmittance,
/// w distance [km], weighted with the opacity.
vec4 clouds_through(in int deck, in vec3 direction, in float limit_m, in float jitter, in vec4 seen) {
    clouds_Deck d = clouds_deck(deck);
    float sine = dot(direction, frame.eye_up.xyz);
    vec2 ends = clouds_inside_deck(d, frame.eye_m.w, sine);
    ends.y = min(ends.y, min(limit_m, clouds_far_m));
    if (d.cover <= 0.0 || ends.y <= ends.x || seen.z < 0.02) return seen;
    vec3 to_sun = light_at_eye_direction();
    vec3 shade = clouds_shade_above(deck, ends.x * direction, clouds_ray_height(sine, ends.x), to_sun,
                                    dot(to_sun, up_at(ends.x * direction)));
    float at_m = ends.x, last_m = ends.x;
    int samples = 0;
    // Each turn finds the next cloud, follows the ray into it and lights it once: light is dear, and a
    // device computes it for all pixels of a group.
    for (int turn = 0; turn < 6; ++turn) {
        bool found = false;
        for (int k = 0; k < clouds_steps; ++k) {
            if (found || at_m >= ends.y || samples >= clouds_steps) break;
            clouds_Point p = clouds_point_of_ray(d, deck, direction, sine, at_m);
            found = p.extinction > 0.0;
            if (!found) {
                last_m = at_m;
                float rest_m = (ends.y - at_m) / float(clouds_steps - samples);
                float least_m = max(0.5 * clouds_soft_m(d, at_m), samples > clouds_steps / 2 ? rest_m : min(0.5 * rest_m, min(0.1 * clouds_cell_m, 400.0) + 0.015 * at_m));
                at_m += max(p.gap_m, samples == 0 ? jitter * least_m : least_m);
            }
            ++samples;
        }
        if (!found || seen.z < 0.02) break;
        float from_m = at_m > last_m ? clouds_entry(d, deck, direction, sine, last_m, at_m) : at_m;
        vec3 dug = clouds_dig(d, deck, direction, sine, from_m, 0.5 * clouds_soft_m(d, from_m), ends.y);
        // The visible part is lit at its mean distance. If that is a gap, it is lit where the ray enters.
        float lit_m = dug.y;
        clouds_Point p;
        for (int k = 0; k < 2; ++k) {
            p = clouds_point_of_ray(d, deck, direction, sine, lit_m);
            if (p.extinction > 0.0) break;
            lit_m = from_m + 0.25 * clouds_soft_m(d, from_m);
        }
        vec3 position_m = lit_m * direction;
        float here_m = clouds_ray_height(sine, lit_m);
        vec2 lit = clouds_lit(d, deck, position_m, here_m, p, direction, to_sun, up_at(position_m)) * shade.xy;
        lit /= 1.0 - shade.z * d.cover * clouds_reflected_sky(p.above + p.below);  // light goes to and fro between decks
        seen.xy += seen.z * dug.x * lit;
        seen.w += seen.z * dug.x * 0.001 * dug.y;
        seen.z *= 1.0 - dug.x;
        last_m = at_m = dug.z;
    }
    return seen;
}

/// Where a ray is below a deck, from x to y along it [m].
vec2 clouds_below_deck(in clouds_Deck d, in float sine, in float limit_m) {
    float down_m = (frame.eye_m.w - d.base_m) / max(-sine, 1e-4);
    if (frame.eye_m.w >= d.base_m) return vec2(sine < 0.0 ? down_m : limit_m, limit_m);
    return vec2(0.0, min(limit_m, clouds_way_up(d.base_m - frame.eye_m.w, sine)));
}

/// Rain of the lowest deck along a ray, added to what is before it as clouds_through() does.
vec4 clouds_rained(in vec3 direction, in float limit_m, in float jitter, in vec4 seen) {
    clouds_Deck d = clouds_deck(0);
    float sine = dot(direction, frame.eye_up.xyz);
    vec2 ends = clouds_below_deck(d, sine, limit_m);
    float step_m = min((ends.y - ends.x) / float(clouds_rain_steps), min(clouds_rain_step_m, 0.6 * clouds_cell_m));
    vec2 below = textureLod(clouds_below, vec2(0.5), 0.0).rg * vec2(max(frame.sun_apparent.z, 0.0), 1.0);
    int i = clouds_rain > 0.0 && step_m > 0.0 ? 0 : clouds_rain_steps;
    for (; i < clouds_rain_steps; ++i) {
        float at_m = ends.x + (float(i) + jitter) * step_m;
        vec4 columns = textureLod(clouds_columns, clouds_map_at(clouds_place(at_m * direction, clouds_ray_height(sine, at_m))), 0.0);
        float fades = 1.0 - float(i) / float(clouds_rain_steps);
        float shaft = fades * smoothstep(0.3, 1.2, columns.x) * smoothstep(0.5, 0.95, columns.a);
        float opaque = 1.0 - exp(-clouds_rain * clouds_rain_extinction * shaft * step_m);
        seen.xy += 0.35 * seen.z * opaque * below;
        seen.w += seen.z * opaque * 0.001 * at_m;
        seen.z *= 1.0 - opaque;
    }
    return seen;
}

/// All decks along a ray, the nearest first. @param jitter  0..1, where in a step samples are
vec4 clouds_seen(in vec3 direction, in float limit_m, in float jitter) {
    vec4 seen = vec4(0.0, 0.0, 1.0, 0.0);
    bool upwards = frame.eye_m.w < clouds_deck(0).top_m || dot(direction, frame.eye_up.xyz) > 0.0;
    bool beneath = frame.eye_m.w < clouds_deck(0).base_m;
    int count = clouds_count();
    if (beneath) seen = clouds_rained(direction, limit_m, jitter, seen);
    for (int i = 0; i < 3; ++i) {
        seen = clouds_through(upwards ? i : count - 1 - i, direction, limit_m, jitter, seen);
        if (i + 1 >= count) break;
    }
    if (!beneath) seen = clouds_rained(direction, limit_m, jitter, seen);
    seen.w /= max(1.0 - seen.z, 1e-4);
    return seen;
}

/// Where in a step a pixel samples, 0..1, even over its neighbours.
float clouds_jitter(in vec2 at_px) {
    return 0.25 + 0.5 * pixel_noise(floor(at_px));
}

/// Nearness of the ground that every second pixel shows [1/m]; 0 in the sky.
vec4 clouds_pass_near(in Texel t) {
    ivec2 pixel = min(2 * ivec2(t.at_px), textureSize(clouds_depths, 0) - 1);
    float depth_m = screen_depth(clouds_depths, pixel);
    return vec4(depth_m == kSky_m ? 0.0 : 1.0 / (depth_m * length(pixel_ray_at(vec2(pixel) + 0.5))));
}

/// The clouds before what every second pixel shows.
vec4 clouds_pass_view(in Texel t) {
    vec3 direction = normalize(pixel_ray_at(2.0 * floor(t.at_px) + 0.5));
    float near = texelFetch(clouds_near, ivec2(t.at_px), 0).r;
    return clouds_seen(direction, near > 0.0 ? 1.0 / near : 2.0 * clouds_far_m,
                       clouds_jitter(t.at_px + 0.5 * vec2(frame.part_left, frame.part_below)));
}

const float clouds_turns = 6.2831853;

/// The same all around, coarsely, for what mirrors the sky and for the light in the air: azimuth by
/// sine of the elevation, from the horizon up.
vec4 clouds_pass_dome(in Texel t) {
    vec3 up = frame.eye_up.xyz, east = east_at(up);
    float sine = 0.01 + 0.99 * t.at.y * t.at.y;
    float azimuth = clouds_turns * t.at.x;
    vec3 level = sin(azimuth) * east + cos(azimuth) * cross(up, east);
    return clouds_seen(sine * up + sqrt(1.0 - sine * sine) * level, 2.0 * clouds_far_m, 0.5);
}
