//! provides  air_sun_way_m, air_sun_shares: where terrain keeps the sun off the air before this pixel, as `shafts` finds it;
//!           air_sun_at, air_sun_lit: how much of the sun is left, at a distance and over a way
//! source    heights over which the air thins: core/sky/air.h; air mass: F. Kasten and A. T. Young, Applied Optics 28
//!           (1989) 4735

//@ include lib/air.glsl

vec2 air_sun_way_m = vec2(0.0);   // before x and behind y there is all of the sun [m]
vec3 air_sun_shares = vec3(1.0);  // of the sun, in three equal parts of the way from x to y

const vec2 air_sun_thins_m = vec2(8500.0, 1200.0);  // molecules, aerosol: over which there is 1/e of them

/// Distance at which a part of that way begins. @param part  0 to 3
float air_sun_part_m(in int part) { return mix(air_sun_way_m.x, air_sun_way_m.y, float(part) / 3.0); }

/// Share of the sun in the air at a distance.
float air_sun_at(in float way_m) {
    float part = 3.0 * (way_m - air_sun_way_m.x) / max(air_sun_way_m.y - air_sun_way_m.x, 1.0);
    return part < 0.0 || part >= 3.0 ? 1.0 : air_sun_shares[int(part)];
}

/// Height of a point of a ray, on the round Earth [m]. @param sine  of the ray's elevation
float air_sun_height_m(in float sine, in float way_m) {
    return frame.eye_m.w + way_m * (sine + 0.5 * (1.0 - sine * sine) / 6371000.0 * way_m);
}

/// Extinction of green light by molecules and by the aerosol at height 0 [1/m].
vec2 air_sun_extinction() { return vec2(1.2e-5, max(frame.air_mapping.w - 1.2e-5, 0.0)); }

/// How bright the sunlight is that air at a height scatters towards the eye, relative.
/// @param phases  of molecules and aerosol  @param air_mass  towards the sun
float air_sun_radiance(in vec2 phases, in float height_m, in float air_mass) {
    vec2 here = air_sun_extinction() * exp(-max(height_m, 0.0) / air_sun_thins_m);
    return dot(here, phases) / (here.x + here.y) * exp(-air_mass * dot(here, air_sun_thins_m));
}

/// Optical depth in green up to a distance, beyond the clear foreground of aerial views, relative.
float air_sun_depth(in float sine, in float way_m) {
    float to_m = air_sun_height_m(sine, way_m);
    vec2 mean = vec2(air_mean_density(frame.eye_m.w / air_sun_thins_m.x, to_m / air_sun_thins_m.x),
                     air_mean_density(frame.eye_m.w / air_sun_thins_m.y, to_m / air_sun_thins_m.y));
    return max(way_m - frame.air_near_m, 0.0) * dot(air_sun_extinction(), mean);
}

/// Share of the sunlight scattered once on the way to a point that is left where terrain keeps the sun off.
/// @param depth  optical depth of the air up to there
/// @param more   that of haze on top, and in `parts` its shares up to the beginnings of the parts and the last one's end
vec3 air_sun_lit(in vec3 view, in float distance_m, in vec3 depth, in vec3 more, in vec4 parts) {
    vec3 up = frame.eye_up.xyz;
    float sine = dot(view, up), cosine = dot(view, frame.eye_sun.xyz);
    vec2 phases = vec2(0.0596831 * (1.0 + cosine * cosine), air_aerosol_phase(cosine));
    float elevation_deg = max(degrees(frame.eye_sun.w), -1.0);
    float air_mass = 1.0 / (max(sin(frame.eye_sun.w), 0.0) + 0.50572 * pow(elevation_deg + 6.07995, -1.6364));
    float all = max(air_sun_depth(sine, distance_m), 1e-12), before_m = 0.0;
    vec3 lit = vec3(0.0), sum = vec3(0.0), passed = vec3(1.0);
    // Most rays are all lit: a software device follows both branches of an `if`, but leaves a loop.
    bool shaded = min(air_sun_shares.x, min(air_sun_shares.y, air_sun_shares.z)) < 0.999;
    for (int i = shaded ? 0 : 5; i < 5; ++i) {
        float to_m = i < 4 ? air_sun_part_m(i) : distance_m;
        vec3 here = exp(-(air_sun_depth(sine, to_m) / all * depth + (i < 4 ? parts[i] : 1.0) * more));
        float middle_m = air_sun_height_m(sine, 0.5 * (before_m + to_m));
        vec3 light = air_sun_radiance(phases, middle_m, air_mass) * (passed - here);
        lit += (i == 0 || i == 4 ? 1.0 : air_sun_shares[i - 1]) * light;
        sum += light;
        passed = here;
        before_m = to_m;
    }
    return shaded ? lit / max(sum, 1e-12) : vec3(1.0);
}
