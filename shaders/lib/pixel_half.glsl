//! provides  pixel_of_half: what a texture of half the frame's width and height has at a pixel

/// A pixel's value, from those of its four neighbours that show ground as far away as it does.
/// @param seen   texel (x, y) is of pixel (2x, 2y)
/// @param nears  of the same size: the nearness of what a texel shows, 0 in the sky; not read if `own`: it is in seen.a
/// @param near   that of this pixel
vec4 pixel_of_half(in sampler2D seen, in sampler2D nears, in bool own, in float near) {
    vec2 at = 0.5 * (gl_FragCoord.xy - 0.5);
    ivec2 first = ivec2(floor(at)), most = textureSize(seen, 0) - 1;
    vec2 part = at - vec2(first);
    vec4 sum = vec4(0.0);
    float all = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 step_px = ivec2(i & 1, i >> 1);
        ivec2 texel = clamp(first + step_px, ivec2(0), most);
        vec4 value = texelFetch(seen, texel, 0);
        float apart = abs((own ? value.a : texelFetch(nears, texel, 0).r) - near) / max(near, 1e-9);
        float alike = 1.0 / (1.0 + 100.0 * min(apart * apart, 1e4));
        vec2 w = mix(1.0 - part, part, vec2(step_px));
        float weight = alike * (w.x * w.y + 1e-3);
        sum += weight * value;
        all += weight;
    }
    return sum / all;
}
