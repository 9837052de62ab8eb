//! provides  contour lines of constant width in the picture
//! hook      display
//! reads     height of the DEM and how it changes from pixel to pixel [m]
//! writes    overlay, premultiplied sRGB; the module and core place the heights on index lines

uniform float contours_interval_m = 0.0; //@ range(0, 2000) unit(m) label("Interval") description("Height between two lines; 0: by the DEM's relief, about 25 lines")
uniform int contours_index = 5; //@ range(1, 20) label("Index lines") description("Every so many lines one is bolder")
uniform float contours_width_px = 1.2; //@ range(0.5, 10) unit(px) label("Width")
uniform vec3 contours_colour = vec3(0.35, 0.20, 0.08); //@ colour(srgb) label("Colour")
uniform float contours_opacity = 0.75; //@ range(0, 1) label("Opacity")
uniform bool contours_labels = true; //@ label("Heights") description("Heights on the index lines")
uniform float contours_label_px = 12.0; //@ range(6, 100) unit(px) label("Letters")
uniform float contours_label_apart_px = 300.0; //@ range(50, 5000) unit(px) label("Apart") description("Least distance between two heights on lines of one height")

const float contours_lines = 25.0;     // over the DEM's relief, about
const float contours_bold = 1.8;       // width of index lines, in those of the others
const float contours_closest_px = 3.0;  // lines are gone where they are so close ...
const float contours_close_px = 7.0;    // ... and begin to fade

/// 1, 2 or 5 times a power of ten.
float contours_round(in float wanted_m) {
    float power = pow(10.0, floor(log2(wanted_m) / 3.3219281));
    float first = wanted_m / power;
    return power * (first < 1.414 ? 1.0 : first < 3.162 ? 2.0 : first < 7.071 ? 5.0 : 10.0);
}

float contours_interval() {
    if (contours_interval_m > 0.0) return contours_interval_m;
    return contours_round(max(1.0 / (contours_lines * frame.height_range.y), 0.1));
}

/// How much of a pixel the nearest line covers, 0..1.
/// @param step_m  how the height changes over a pixel
float contours_line(in float height_m, in float step_m, in float interval_m, in float width_px) {
    // Level ground at the height of a line is no line. Floats of heights have steps of 1e-7 of them.
    if (step_m <= max(1e-6 * interval_m, 2.5e-7 * abs(height_m))) return 0.0;
    float away_m = abs(height_m - interval_m * round(height_m / interval_m));
    float fade = smoothstep(contours_closest_px, contours_close_px, interval_m / step_m);
    return fade * clamp(0.5 * width_px + 0.5 - away_m / step_m, 0.0, min(width_px, 1.0));
}

void contours_on_display(in Surface s, inout vec4 overlay) {
    float interval_m = contours_interval();
    float line = contours_line(s.dem_height_m, s.dem_step_m, interval_m, contours_width_px);
    float bold = contours_line(s.dem_height_m, s.dem_step_m, interval_m * float(contours_index),
                               contours_bold * contours_width_px);
    float alpha = contours_opacity * max(line, bold);
    overlay = overlay * (1.0 - alpha) + vec4(contours_colour, 1.0) * alpha;
}
