//! provides  the moon in the sky: its disc with its phase, and what it hides of the sun; the corona
//! reads     frame.eye_moon and what follows it; with NO_MOON none of it, in parts of the picture without it
//! frame     directions in the local frame, unit; radiance as frame.glsl
//! source    law of Lommel and Seeliger; corona: S. Baumbach (1937) in C. W. Allen, Astrophysical
//!           Quantities, 1976, 176; maria: IAU Gazetteer of Planetary Nomenclature

/// Of a direction, how far outside of the moon's limb it is, in pixels there; below 0: inside.
float moon_outside_px(in vec3 direction) {
    vec3 apart = direction - frame.eye_moon.xyz;
    // Pixels are smaller towards the edges of a picture.
    vec3 ahead = cross(frame.pixel_ray_dy.xyz, frame.pixel_ray_dx.xyz);
    float solid = length(ahead);
    float cosine = max(dot(ahead, direction) / solid, 1e-3);
    return (length(apart) - frame.eye_moon.w) / (sqrt(solid) * cosine * sqrt(cosine));
}

/// Share of a pixel that the moon does not cover, 0 to 1.
float moon_uncovered(in vec3 direction) {
#ifdef NO_MOON
    return 1.0;
#else
    if (frame.eye_moon.w == 0.0) return 1.0;
    return clamp(0.5 + moon_outside_px(direction), 0.0, 1.0);
#endif
}

/// Darkness of a large mare at a point, 0 outside of it. Without a table: software renderers would store that again for
/// every block of pixels.
/// @param longitude_deg, latitude_deg  selenographic, of its middle
float moon_mare(in vec3 normal, in float longitude_deg, in float latitude_deg, in float radius_deg, in float darkness) {
    vec2 at = radians(vec2(longitude_deg, latitude_deg));
    vec3 centre = vec3(cos(at.y) * cos(at.x), cos(at.y) * sin(at.x), sin(at.y));
    float radius = 2.0 * sin(radians(0.5 * radius_deg)), apart2 = 2.0 - 2.0 * dot(normal, centre);  // chords
    return darkness * (1.0 - smoothstep(0.4, 1.2, apart2 / (radius * radius)));
}

/// Reflectance of the surface, 1 on the average of highlands.
/// @param normal  of the moon at a point, in axes whose z is its own axis and whose x is towards us
float moon_albedo(in vec3 normal) {
    float dark = 0.0;
    dark = max(dark, moon_mare(normal, -15.6, 32.8, 18.9, 0.9));
    dark = max(dark, moon_mare(normal, 17.5, 28.0, 11.1, 0.9));
    dark = max(dark, moon_mare(normal, 31.4, 8.5, 14.4, 1.0));
    dark = max(dark, moon_mare(normal, 59.1, 17.0, 9.2, 1.0));
    dark = max(dark, moon_mare(normal, 51.3, -7.8, 13.8, 0.9));
    dark = max(dark, moon_mare(normal, 35.5, -15.2, 5.6, 0.8));
    dark = max(dark, moon_mare(normal, -16.6, -21.3, 11.8, 0.8));
    dark = max(dark, moon_mare(normal, -38.6, -24.4, 6.4, 0.9));
    dark = max(dark, moon_mare(normal, -50.0, 22.0, 17.0, 0.9));
    dark = max(dark, moon_mare(normal, -56.0, 4.0, 14.0, 0.9));
    dark = max(dark, moon_mare(normal, -31.0, 7.5, 8.5, 0.7));
    dark = max(dark, moon_mare(normal, -23.0, -10.0, 5.8, 0.8));
    dark = max(dark, moon_mare(normal, 3.6, 13.3, 4.0, 0.7));
    dark = max(dark, moon_mare(normal, 1.4, 56.0, 7.0, 0.5));
    return 1.12 - 0.5 * dark;
}

/// Radiance of the disc. Libration is not modelled: the Earth stands in the middle of the near side.
vec3 moon_disc(in vec3 direction) {
    vec3 to_moon = frame.eye_moon.xyz;
    vec3 across = (direction - to_moon) / frame.eye_moon.w;
    across -= dot(across, to_moon) * to_moon;
    float towards = sqrt(max(1.0 - dot(across, across), 0.0));
    vec3 normal = across - towards * to_moon;
    float sun = dot(normal, frame.moon_to_sun.xyz);
    // The terminator is soft: the sun has a width, and the ground is rough.
    float lit = smoothstep(-0.01, 0.02, sun) * max(sun, 0.0) / max(max(sun, 0.0) + towards, 1e-3) * 2.0;
    vec3 north = frame.moon_axis.xyz;
    vec3 east = normalize(cross(to_moon, north));  // selenographic: the right of an eye that has north up
    vec3 own = vec3(dot(normal, -to_moon), dot(normal, east), 0.0);
    vec3 upright = cross(east, to_moon);
    own.z = dot(normal, upright);
    return frame.moon_radiance.rgb * moon_albedo(own) * (lit + frame.moon_radiance.a);
}

/// The corona, which the light of the sky hides but for a total eclipse.
vec3 moon_corona(in vec3 direction, in vec3 to_sun) {
    const float sun_rad = 0.004652;
    float near = min(sun_rad / length(direction - to_sun), 1.0);
    float near2 = near * near, near4 = near2 * near2, near8 = near4 * near4;
    // Baumbach's powers 17, 7 and 2.5.
    float of_sun = 1e-6 * (2.565 * near8 * near8 * near + 1.425 * near4 * near2 * near + 0.0532 * near2 * sqrt(near));
    // The sun's disc has the radiance of its irradiance times pi over its solid angle.
    return frame.corona.rgb * of_sun / (sun_rad * sun_rad);
}

/// What the moon adds to the sky in a direction: its disc, through the air before the eye; and in
/// totality the corona.
/// @param uncovered  moon_uncovered() there
vec3 moon_on_sky(in vec3 direction, in vec3 to_sun, in float uncovered) {
    vec3 radiance = vec3(0.0);
#ifndef NO_MOON
    if (uncovered < 1.0) radiance = (1.0 - uncovered) * moon_disc(direction);
    if (frame.corona.g > 0.0) radiance += uncovered * moon_corona(direction, to_sun);
#endif
    return radiance;
}
