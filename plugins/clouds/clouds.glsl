//! provides  clouds: their shadows, the light below them, and how they look from below, between and above
//! hook      visibility, ambient, atmosphere, sky
//! reads     position, height [m], the sun's light, the sky's radiance without the sun's disc
//! writes    factor, irradiance, radiance, transmittance
//! source    extinction along the sun's ray exp(-tau / sin el): Bouguer and Lambert; light below: light.glsl

//@ include lib/air_pixel.glsl
//@ include lib/ground.glsl
//@ include lib/pixel_half.glsl

uniform float clouds_visibility = 180.0; //@ range(0.1, 1000) unit(km) label("Visibility") description("How far the air before the clouds lets one see, at sea level: 3.912 / extinction")

uniform sampler2D clouds_view;
uniform sampler2D clouds_dome;

const float clouds_albedo = 0.15;  // of the ground, for the light between it and a deck

bool clouds_is_ground = false;  // set by the hooks of the ground: the sky is then asked for by haze and mirrors

/// Where the sun's ray to a point of the ground passes a height, relative to the eye.
/// @param height_m  of the point, as drawn; below deck_m
vec3 clouds_crossing(in vec3 position_m, in float height_m, in vec3 up, in vec3 to_sun, in float deck_m) {
    return position_m + clouds_way_up(deck_m - height_m, dot(to_sun, up)) * to_sun;
}

/// Optical depths over a place, of decks that are above a height.
float clouds_over(in vec2 place, in float height_m) {
    vec4 columns = clouds_at(place);
    float tau = 0.0;
    int count = clouds_count();
    for (int i = 0; i < 3; ++i) {
        clouds_Deck d = clouds_deck(i);
        float above = clamp((clouds_column_top_m(d, columns[i], columns.a) - height_m) / max(clouds_column_top_m(d, columns[i], columns.a) - d.base_m, 1.0), 0.0, 1.0);
        if (d.cover > 0.0) tau += above * clouds_tau(d, columns[i], columns.a);
        if (i + 1 >= count) break;
    }
    return tau;
}

/// Half of the width of the edges of a deck's shadow, as a share: some 30 m. Rasters have their own edges.
float clouds_blur(in int deck) {
    return clouds_depth_most(deck) > 0.0 ? 1e-5 : 0.06;
}

/// Share of the sun's light that passes all decks on its way to a point of the ground.
float clouds_sun_passed(in vec3 position_m, in float height_m, in vec3 up, in vec3 to_sun) {
    float passed = 1.0;
    int count = clouds_count();
    for (int i = 0; i < 3; ++i) {
        clouds_Deck d = clouds_deck(i);
        float deck_m = max(d.base_m, height_m + 0.1);
        vec3 there = clouds_crossing(position_m, height_m, up, to_sun, deck_m);
        vec4 columns = textureLod(clouds_columns, clouds_map_at(clouds_place(there, deck_m)), 0.0);
        float blur = clouds_blur(i), share = clamp(columns[i], blur, 1.0), vary = clamp(columns.a, 0.0, 1.0);
        float top_m = clouds_column_top_m(d, share, vary);
        float above = clamp((top_m - height_m) / max(top_m - d.base_m, 1.0), 0.0, 1.0);
        float dark = 1.0 - exp(-above * clouds_tau(d, share, vary) / max(dot(to_sun, up_at(there)), 0.02));
        passed *= 1.0 - dark * smoothstep(-blur, blur, columns[i]);
        if (i + 1 >= count) break;
    }
    return passed;
}

void clouds_on_visibility(in Surface s, in vec3 to_sun, inout float factor) {
    clouds_is_ground = true;
#if !HAS_outside
    if (factor > 0.0) factor *= clouds_sun_passed(s.position_m, s.height_m * frame.height_range.z, s.up, to_sun);
#endif
}

/// Light on level ground below all decks, by place on the map of columns: x of the sun's light that the
/// decks scatter, y of the sky's that they let through, over what meets their tops; z of the sun's that
/// passes unscattered.
vec4 clouds_pass_below(in Texel t) {
    vec2 place = clouds_of_map(t.at);
    float around_m = 0.7 * max(clouds_deck(0).base_m - frame.height_range.x, 500.0);
    float sine = frame.sun_apparent.z;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 9; ++i) {
        vec2 way = vec2(float(i % 3 - 1), float(i / 3 - 1));
        float tau = clouds_over(place + around_m * way, frame.height_range.w - 1000.0);
        float mirrored = clouds_reflected_sky(tau), direct = exp(-tau / max(sine, 0.02));
        float fro = 1.0 / (1.0 - clouds_albedo * mirrored);  // between ground and deck
        sum += vec3((clouds_diffuse_of_sun(tau, sine) + direct) * fro - direct, (1.0 - mirrored) * fro, direct) / 9.0;
    }
    return vec4(sum, 0.0);
}

void clouds_on_ambient(in Surface s, inout vec3 irradiance) {
#if !HAS_outside
    float height_m = s.height_m * frame.height_range.z;
    vec2 below = textureLod(clouds_below, clouds_map_at(clouds_place(s.position_m, height_m)), 0.0).rg;
    vec3 to_sun, sun = sun_light_at(s.height_m, s.up, to_sun);
    vec3 level = max(dot(to_sun, s.up), 0.0) * sun;
    vec3 factor = below.y + below.x * level / max(light_of_sky_at(s.height_m, s.up), vec3(1e-9));
    clouds_Deck last = clouds_deck(clouds_count() - 1);
    float above = smoothstep(last.base_m, last.top_m, height_m);
    irradiance *= mix(factor, vec3(1.0), above);
#endif
}

/// Share of the air's light before a cloud.
float clouds_hazed(in float sine, in float distance_m) {
    float a = max(frame.eye_m.w, 0.0) / 2500.0;
    float b = max(a + distance_m * (sine + 0.5 * distance_m / clouds_earth_m) / 2500.0, 0.0);
    float mean = abs(b - a) < 0.1 ? exp(-0.5 * (a + b)) : (exp(-a) - exp(-b)) / (b - a);
    return 1.0 - exp(-3.912e-3 / clouds_visibility * distance_m * mean);
}

/// Lays clouds over what is behind them. @param air  light of the air before them
vec3 clouds_laid(in vec4 seen, in vec3 direction, in vec3 air, in vec3 behind) {
    if (seen.z >= 1.0) return behind;
    float sine = dot(direction, frame.eye_up.xyz), distance_m = 1000.0 * seen.w;
    float height_m = frame.eye_m.w + distance_m * (sine + 0.5 * distance_m / clouds_earth_m);
    vec3 light = seen.x * sun_light_aloft(height_m, frame.eye_up.xyz) + seen.y * frame.sky_irradiance.rgb;
    return seen.z * behind + mix(light, (1.0 - seen.z) * air, clouds_hazed(sine, distance_m));
}

vec4 clouds_around(in vec3 direction) {
    vec3 up = frame.eye_up.xyz, east = east_at(up);
    float azimuth = atan(dot(direction, east), dot(direction, cross(up, east)));
    float sine = max(dot(direction, up), 0.01);
    return textureLod(clouds_dome, vec2(fract(azimuth / clouds_turns + 1.0), sqrt((sine - 0.01) / 0.99)), 0.0);
}

/// Light of the air below the decks, of what it is in a clear sky: dimmer, and grey where no sun shines.
vec3 clouds_air(in vec3 clear) {
    const vec3 luminance = vec3(0.2126, 0.7152, 0.0722);
    vec3 below = textureLod(clouds_below, vec2(0.5), 0.0).rgb;
    vec2 light = vec2(max(frame.sun_apparent.z, 0.0) * dot(frame.sun_light[0].rgb, luminance),
                      dot(frame.sky_irradiance.rgb, luminance));
    float share = ((below.x + below.z) * light.x + below.y * light.y) / max(light.x + light.y, 1e-12);
    vec3 dimmed = share * mix(vec3(dot(clear, luminance)), clear, 0.15 + 0.85 * below.z);
    clouds_Deck last = clouds_deck(clouds_count() - 1);
    float above = smoothstep(last.base_m, last.top_m, frame.eye_m.w);
    air_lit = mix(share, 1.0, above);
    return mix(dimmed, clear, above);
}

void clouds_on_sky(in vec3 direction, inout vec3 radiance, inout vec3 transmittance) {
#if !HAS_outside
    vec4 seen = clouds_is_ground ? clouds_around(direction) : pixel_of_half(clouds_view, clouds_near, false, 0.0);
    vec3 air = clouds_air(radiance);
    // The sky beyond the decks keeps its light. Below the horizon is plain ground, which is lit as the air is.
    float sine = dot(direction, frame.eye_up.xyz);
    bool below = sine < frame.eye_up.w;
    vec3 behind = clouds_is_ground || below ? air : radiance;
    if (below) {
        float distance_m = max(frame.eye_m.w, 0.0) / max(-sine, 1e-3);
        transmittance *= clouds_air(vec3(1.0)) * (1.0 - clouds_hazed(sine, distance_m));
    }
    radiance = clouds_laid(seen, direction, air, behind);
    transmittance *= seen.z;
#endif
}

void clouds_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {
#if !HAS_outside
    // Haze has put the light of a clear sky before the ground: below the decks there is less.
    radiance += clouds_air(air_scattered) - air_scattered;
    vec4 seen = pixel_of_half(clouds_view, clouds_near, false, 1.0 / s.distance_m);
    if (seen.z < 1.0) radiance = clouds_laid(seen, view, background_radiance(view, false), radiance);
#endif
}
