//! provides  wetness: less diffuse, more specular light, by material
//! hook      material, lit
//! reads     material, material_weight, height [m], the sky's radiance without the sun's disc
//! writes    diffuse, ambient, specular, shininess; radiance
//! source    Costa and Celes, Tecnicas simples para visualizacao foto-realista de terrenos em tempo real
//!           usando placas graficas programaveis (Tecgraf, PUC-Rio), section on wet ground; how dark: J.
//!           Lekner and M. C. Dorf, Why some things are darker when wet, Applied Optics 27 (1988), 1278

uniform float wet_wetness = 1.0; //@ range(0, 1) label("Wetness") description("0 dry, 1 soaked")
uniform int wet_where = 0; //@ enum(everywhere, shore) static label("Where") description("All ground, or only the shore")
uniform float wet_shore_m = 2.0; //@ range(-500, 9000) unit(m) label("Shore up to") description("For the shore: height below which the ground is wet")
uniform float wet_shore_fade_m = 2.0; //@ range(0.01, 1000) unit(m) label("Fade") description("Height above that over which the ground becomes dry")

// Of sand, grass, rock, snow.
uniform vec4 wet_diffuse = vec4(0.60, 0.75, 0.42, 0.92); //@ range(0, 1) label("Diffuse") description("Factor on the diffuse light of soaked ground")
uniform vec4 wet_specular = vec4(0.16, 0.08, 0.45, 0.12); //@ range(0, 2) label("Specular") description("Added to the highlight of soaked ground")
uniform float wet_shininess = 60.0; //@ range(1, 1000) label("Shininess") description("Exponent of the highlight of soaked ground")
uniform float wet_reflection = 0.6; //@ range(0, 1) label("Reflection") description("Reflection of a smooth film of water on the ground; 0 in the paper")

/// The value that a material has, blended as the two materials are.
float wet_of(in vec4 values, in ivec2 material, in vec2 weight) {
    return weight.x * values[material.x] + weight.y * values[material.y];
}

/// How wet ground at a height is, 0..1.
float wet_amount_at(in float height_m) {
    float shore = 1.0 - smoothstep(wet_shore_m, wet_shore_m + wet_shore_fade_m, height_m);
    return wet_wetness * (wet_where == 1 ? shore : 1.0);
}

/// Share of light that a level of water mirrors. source: C. Schlick, An inexpensive BRDF model,
/// Computer Graphics Forum 13 (1994), eq. 15; 0.02 at right angles, of a refractive index of 1.33
float wet_mirrored(in float cosine) {
    float grazing = 1.0 - clamp(cosine, 0.0, 1.0);
    float grazing2 = grazing * grazing;
    return 0.02 + 0.98 * grazing2 * grazing2 * grazing;
}

void wet_on_material(inout Surface s) {
    float amount = wet_amount_at(s.height_m);
    float kept = mix(1.0, wet_of(wet_diffuse, s.material, s.material_weight), amount);
    s.diffuse *= kept;
    s.ambient *= kept;
    s.specular += amount * wet_of(wet_specular, s.material, s.material_weight);
    s.shininess = mix(s.shininess, wet_shininess, amount);
}

void wet_on_lit(in Surface s, inout vec3 radiance) {
    vec3 view = s.position_m / s.distance_m;
    // Rock and sand carry a film of water; grass and snow hold it inside.
    float film = wet_amount_at(s.height_m) * wet_reflection *
                 (1.0 - wet_of(wet_diffuse, s.material, s.material_weight)) / (1.0 - 0.42);
    // Grain breaks the mirror: what is seen in it at a slant is less than the whole of it.
    float share = film * min(wet_mirrored(-dot(view, s.normal)), 0.35);
    vec3 mirrored = reflect(view, s.normal);
    mirrored = normalize(mirrored + max(-dot(mirrored, s.up), 0.0) * 1.02 * s.up);
    radiance = mix(radiance, background_radiance(mirrored, false), share);
}
