//! provides  noise of places, from integers alone: the same on every device

/// A number of a cell of a grid, 0..1. @param stream  other numbers of the same cell
float noise_random(in ivec2 cell, in uint stream) {
    uint h = uint(cell.x) * 0x8da6b343u ^ uint(cell.y) * 0xd8163841u ^ stream * 0xcb1ab31fu;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return float((h ^ (h >> 15)) >> 8) / 16777216.0;
}

/// Value noise: smooth between random numbers at whole places, 0..1.
float noise_smooth(in vec2 at, in uint stream) {
    vec2 whole = floor(at), part = at - whole;
    ivec2 cell = ivec2(whole);
    vec2 w = part * part * part * (part * (part * 6.0 - 15.0) + 10.0);
    float below = mix(noise_random(cell, stream), noise_random(cell + ivec2(1, 0), stream), w.x);
    float above = mix(noise_random(cell + ivec2(0, 1), stream), noise_random(cell + ivec2(1, 1), stream), w.x);
    return mix(below, above, w.y);
}
