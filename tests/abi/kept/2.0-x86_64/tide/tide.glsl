uniform float tide_range_m = 0.5;  //@ range(0, 10) unit(m) label("Range")
uniform float tide_level_m = 0.0;  //@ host

/// The level that the module writes as a shade of grey: 1 m is white.
void tide_on_display(in Surface s, inout vec4 overlay) {
    overlay = vec4(vec3(tide_level_m), 1.0);
}
