//! provides  classes of slopes on which avalanches start
//! hook      display
//! reads     the DEM's own normal
//! writes    overlay, premultiplied sRGB
//! source    swiss: edges of the slope classes on Swiss maps for ski tours, 30, 35, 40 and 45 degrees;
//!           american: edges of slope shading on North American maps for ski tours

uniform int avalanche_classes = 0; //@ enum(swiss, american) label("Classes") description("Edges of the classes: 30, 35, 40, 45 degrees, or 27, 30, 32, 35, 46, 51, 60 degrees")
uniform float avalanche_opacity = 0.6; //@ range(0, 1) label("Opacity")

const vec3 avalanche_swiss[4] = vec3[](
    vec3(0.976, 0.898, 0.278), vec3(0.945, 0.584, 0.184), vec3(0.824, 0.184, 0.220),
    vec3(0.541, 0.294, 0.604)); //@ steps(30, 35, 40, 45, 90) unit(°) label("Slope") where(classes, swiss)
const vec3 avalanche_american[7] = vec3[](
    vec3(0.976, 0.918, 0.420), vec3(0.969, 0.788, 0.290), vec3(0.937, 0.573, 0.188), vec3(0.827, 0.192, 0.208),
    vec3(0.541, 0.294, 0.604), vec3(0.220, 0.329, 0.659),
    vec3(0.129, 0.133, 0.153)); //@ steps(27, 30, 32, 35, 46, 51, 60, 90) unit(°) label("Slope") where(classes, american)

/// Colour of a slope [degrees]: sRGB and 1, or 0 below the first class.
vec4 avalanche_of(in float slope_deg) {
    if (avalanche_classes == 0) {
        if (slope_deg < 30.0) return vec4(0.0);
        return vec4(avalanche_swiss[int(slope_deg >= 35.0) + int(slope_deg >= 40.0) + int(slope_deg >= 45.0)], 1.0);
    }
    if (slope_deg < 27.0) return vec4(0.0);
    int kind = int(slope_deg >= 30.0) + int(slope_deg >= 32.0) + int(slope_deg >= 35.0) + int(slope_deg >= 46.0) +
               int(slope_deg >= 51.0) + int(slope_deg >= 60.0);
    return vec4(avalanche_american[kind], 1.0);
}

void avalanche_on_display(in Surface s, inout vec4 overlay) {
    vec4 colour = avalanche_of(degrees(acos(clamp(dot(s.ground_normal, s.up), -1.0, 1.0)))) * avalanche_opacity;
    overlay = colour + overlay * (1.0 - colour.a);
}
