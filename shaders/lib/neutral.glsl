//! provides  neutral_tones: tone mapping that leaves colours as they are up to one half

/// Keeps colours as they are up to one half and bends brighter ones softly below 1, towards white.
/// source: Khronos PBR Neutral Tone Mapper specification 1.0 (2024), without its toe; it starts at 0.5
/// instead of 0.76 and takes less colour away, because skies at dusk and snow at noon are brighter
/// than the lit studio that it was made for
/// @param colour  linear, exposed
vec3 neutral_tones(in vec3 colour) {
    const float start = 0.5;
    const float desaturation = 0.07;
    float peak = max(colour.r, max(colour.g, colour.b));
    if (!(peak > start)) return colour;
    const float room = 1.0 - start;
    float bent = 1.0 - room * room / (peak + room - start);
    float white = 1.0 - 1.0 / (desaturation * (peak - bent) + 1.0);
    return mix(colour * (bent / peak), vec3(bent), white);
}
