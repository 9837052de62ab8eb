//! provides  the look of wide voids in the DEM that ground encloses: a plain cover, where nothing is known
//! hook      material, display
//! reads     water pages
//! writes    diffuse, ambient, specular, normal; where a map is unlit the picture itself

//@ include lib/water.glsl

uniform vec3 blank_colour = vec3(0.20, 0.195, 0.19); //@ colour label("Colour") description("Reflectance of the cover")

/// Share of a point that is covered. Beside a cover filled holes are half of it, and not meant.
float blank_share(in Surface s) {
    return smoothstep(0.65, 0.85, water_of(s).a);
}

void blank_on_material(inout Surface s) {
    float share = blank_share(s);
    s.diffuse = mix(s.diffuse, blank_colour, share);
    s.ambient = mix(s.ambient, blank_colour, share);
    s.specular = mix(s.specular, vec3(0.0), share);
    s.normal = normalize(mix(s.normal, s.ground_normal, share));
}

/// Over colours of an unlit map alone.
void blank_on_display(in Surface s, inout vec4 overlay) {
    vec3 seen = pow(blank_colour, vec3(1.0 / 2.2));
    overlay.rgb = mix(overlay.rgb, overlay.a * seen, blank_share(s));
}
