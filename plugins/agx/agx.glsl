//! provides  tone mapping by AgX under a low sun: the brighter a colour is, the paler, as on film; by day neutral, with
//!           the contrast and the saturation of a print
//! hook      tonemap
//! writes    colour, linear, 0 to 1
//! source    T. Sobotka, AgX (2022): matrix, range of stops and the curve's slope and powers

uniform float agx_exposure = 0.5; //@ range(-10, 10) unit(EV) label("Exposure") description("In stops. 0.5 leaves middle tones as bright as they are without AgX")
uniform float agx_day = 0.5; //@ range(-10, 10) unit(EV) label("Exposure by day") description("In stops, while the sun is high and tones are neutral")
uniform float agx_day_contrast = 0.22; //@ range(0, 1) label("Contrast by day") description("Darkens shade and brightens what is in light; 0: none")
uniform float agx_day_saturation = 0.55; //@ range(0, 2) label("Saturation by day") description("More colour for tones that are neither pale nor saturated; 0: none")
uniform float agx_contrast = 1.2; //@ range(0.2, 4) label("Contrast") description("Exponent of the tones; 1 is AgX's base, 1.35 its punchy look")
uniform float agx_saturation = 1.3; //@ range(0, 4) label("Saturation") description("1 is AgX's base, 1.4 its punchy look")

// Each primary with some of the others, so that a bright one takes them along to white.
const mat3 agx_mixed = mat3(0.842479, 0.0423282, 0.0423756,
                            0.0784336, 0.878469, 0.0784336,
                            0.0792237, 0.0791661, 0.879143);
const float agx_grey = 0.18;          // the curve's middle
const float agx_stops_below = 10.0;   // it, and
const float agx_stops_above = 6.5;    // above it
const float agx_slope = 2.0;
const float agx_toe = 3.0, agx_shoulder = 3.25;  // powers: higher ones bend more sharply
const float agx_day_middle = 0.1726;  // luminance that contrast by day leaves as it is: L* 48
const float agx_low_sun = 0.17, agx_high_sun = 0.31;  // apparent elevations; in between tones go over [rad]
const float agx_display = 2.2;        // the curve's values are for a display of this exponent

/// How far a side of the curve would reach if it went on without an end: it begins with the slope and ends at the edge.
/// @param width  from the middle to the edge
float agx_reach(in float width, in float power) {
    return pow(pow(agx_slope * width, -power) * (pow(2.0 * agx_slope * width, power) - 1.0), -1.0 / power);
}

/// A sigmoid of two sides. Which one it is decides numbers, not code: pow() is what it costs.
/// @param light  linear, exposed
/// @returns 0 to 1, for a display
float agx_tone(in float light) {
    const float range = agx_stops_below + agx_stops_above;
    float stops = log2(max(light, 1e-10) / agx_grey);
    bool below = stops < 0.0;
    float power = below ? agx_toe : agx_shoulder;
    float reach = below ? agx_reach(agx_stops_below / range, agx_toe) : agx_reach(agx_stops_above / range, agx_shoulder);
    float t = agx_slope * min(abs(stops), below ? agx_stops_below : agx_stops_above) / range / reach;
    float side = reach * t * pow(1.0 + pow(t, power), below ? -1.0 / agx_toe : -1.0 / agx_shoulder);
    return below ? 0.5 - side : 0.5 + side;
}

/// @param colour  linear, exposed
vec3 agx_tones(in vec3 colour) {
    vec3 mixed = agx_mixed * (exp2(agx_exposure) * max(colour, 0.0));
    vec3 tone = vec3(agx_tone(mixed.r), agx_tone(mixed.g), agx_tone(mixed.b));
    tone = pow(max(tone, 0.0), vec3(agx_contrast));
    tone = mix(vec3(dot(tone, vec3(0.2126, 0.7152, 0.0722))), tone, agx_saturation);
    tone = inverse(agx_mixed) * tone;
    return pow(clamp(tone, 0.0, 1.0), vec3(agx_display));
}

/// Darkens shade by a power of its luminance and brightens middle tones; snow and white stay. Then saturates tones that are
/// neither pale nor saturated already. Blue ones stay, because air would turn violet.
/// @param colour  linear, 0 to 1
vec3 agx_print(in vec3 colour) {
    const vec3 luminance = vec3(0.2126, 0.7152, 0.0722);
    float before = max(dot(colour, luminance), 1e-6), above = max(before / agx_day_middle - 1.0, 0.0);
    float left = max(1.0 - before, 0.0) / (1.0 - agx_day_middle);
    float light = 1.0 + agx_day_contrast * above * left * left / (1.0 + 0.3 * above);  // as steep as shade where they meet
    float shade = pow(clamp(before / agx_day_middle, 0.3, 1.0), agx_day_contrast);
    colour *= light * shade;
    float after = before * light * shade;
    // Air before ground of any colour, soils and roofs in its light would turn lilac: by day nothing has so little green.
    float most = max(colour.r, max(colour.g, colour.b)), least = min(colour.r, colour.b);
    float p = least / max(most, 1e-6), green = min(mix(0.24, 0.5, p), 4.0 * p);  // least place between red and blue
    float more = colour.g - least - green * abs(colour.r - colour.b), bend = 0.25 * green * (most - least);
    colour.g += 0.5 * (sqrt(more * more + bend * bend) - abs(more)) + max(-more, 0.0);
    colour *= after / max(dot(colour, luminance), 1e-6);
    // An eye takes snow and clouds in sunlight for white, but for that of a low sun.
    float white = 0.8 * smoothstep(0.6, 0.9, least / max(most, 1e-6)) * smoothstep(0.25, 0.5, after);
    colour = mix(colour, after * vec3(0.965, 1.0, 1.075), white * smoothstep(agx_high_sun, 0.42, frame.eye_sun.w));
    float pale = min(colour.r, min(colour.g, colour.b)) / max(most, 1e-6);
    float blue = clamp((colour.b - max(colour.r, colour.g)) / max(0.3 * most, 1e-6), 0.0, 1.0);
    return clamp(after + (colour - after) * (1.0 + agx_day_saturation * pale * (1.0 - pale) * (1.0 - blue)), 0.0, 1.0);
}

void agx_on_tonemap(inout vec3 colour) {
    // Models and maps have colours that are compared with legends and photographs.
#if HAS_outside || HAS_tint || HAS_drape
    core_on_tonemap(colour);
#else
    vec3 neutral = exp2(agx_day) * colour;
    core_on_tonemap(neutral);
    colour = mix(agx_tones(colour), agx_print(neutral), smoothstep(agx_low_sun, agx_high_sun, frame.eye_sun.w));
#endif
}
