//! provides  a colour over ground that the DEM does not have and that is drawn filled
//! hook      display
//! reads     water pages

//@ include lib/water.glsl

uniform vec4 infill_colour = vec4(0.92, 0.1, 0.55, 0.75); //@ range(0, 1) label("Colour") description("Colour of filled voids, and its opacity")

void infill_on_display(in Surface s, inout vec4 overlay) {
    float filled = infill_colour.a * smoothstep(0.15, 0.35, water_of(s).a);
    overlay = mix(overlay, vec4(infill_colour.rgb, 1.0), filled);
}
