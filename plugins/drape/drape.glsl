//! provides  drape: a photograph or a map on the ground
//! hook      material, display
//! reads     the raster `image`
//! writes    diffuse, ambient, specular, emissive, normal; overlay

//@ include lib/srgb.glsl

uniform int drape_light = 0;          //@ enum(lit, flat) static label("Light") description("lit: as the ground's reflectance, in the light of the scene; flat: in the file's own colours")
uniform float drape_opacity = 1.0;    //@ range(0, 1) label("Opacity")
uniform float drape_brightness = 1.0; //@ range(0.1, 4) label("Brightness") description("Factor on the reflectance, for images that have been darkened or stretched")

/// The image takes the place of the ground's materials, and of their bumps.
void drape_on_material(inout Surface s) {
    if (drape_light != 0) return;
    vec4 image = drape_image(s);
    float cover = image.a * drape_opacity;
    vec3 reflectance = min(image.rgb * drape_brightness, 1.0);
    s.diffuse = mix(s.diffuse, reflectance, cover);
    s.ambient = mix(s.ambient, reflectance, cover);
    s.specular *= 1.0 - cover;
    s.emissive *= 1.0 - cover;
    s.normal = normalize(mix(s.normal, s.geometric_normal, cover));
}

void drape_on_display(in Surface s, inout vec4 overlay) {
    if (drape_light != 1) return;
    vec4 image = drape_image(s);
    float cover = image.a * drape_opacity;
    overlay = vec4(srgb_encoded(image.rgb) * cover, cover) + overlay * (1.0 - cover);
}
