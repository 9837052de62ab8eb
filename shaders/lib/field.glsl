//! provides  field_value: values around the DEM by place
//! reads     a texture of its own (render/fields.h)

/// A value, and the part of the place that has one.
/// @param texels   products of value and part, and the parts; 0 along the edges
/// @param place    of the first texel [m], and texels per metre
/// @param shape    number of columns and rows
/// @param place_m  east and north of the DEM's centre
vec2 field_value(in sampler2D texels, in vec4 place, in vec4 shape, in vec2 place_m) {
    vec2 found = textureLod(texels, ((place_m - place.xy) * place.zw + 0.5) / shape.xy, 0.0).rg;
    return vec2(found.r / max(found.g, 1e-6), found.g);
}
