//! provides  bumps: a normal map for each material
//! hook      normal, facing
//! reads     material, material_weight, texture_at, tangent frame
//! writes    normal; factor of direct light
//! source    Costa and Celes, Tecnicas simples para visualizacao foto-realista de terrenos em tempo real
//!           usando placas graficas programaveis (Tecgraf, PUC-Rio), section 3.2, figure 3

uniform sampler2DArray bump_normals;

uniform float bump_strength = 1.0; //@ range(0, 4) label("Strength") description("Factor on the slopes of the bumps")
uniform int bump_correction = 2; //@ enum(none, abrupt, smooth) static label("Correction") description("Light only where ground and bump both face the sun: not at all, the paper's figure 3a, and 3b")
uniform float bump_softness = 0.12; //@ range(0.001, 1) label("Softness") description("Cosine of the sun's angle of incidence from which on ground is fully lit; of the smooth correction")

/// Slopes of a material's map: how far its normal leans along tangent and bitangent, and its z.
vec3 bump_read(in Surface s, in int material) {
    return 2.0 * textureGrad(bump_normals, vec3(s.texture_at, float(material)), s.texture_dx,
                             s.texture_dy).xyz - 1.0;
}

/// A normal of the map in the tangent frame of the ground.
vec3 bump_normal(in vec3 map, in vec3 tangent, in vec3 bitangent, in vec3 normal) {
    return normalize(bump_strength * (map.x * tangent + map.y * bitangent) + map.z * normal);
}

void bump_on_normal(inout Surface s) {
    vec3 map = vec3(0.0);
    int count = s.material_weight.y > 0.0 ? 2 : 1;  // a read less in most places
    for (int i = 0; i < count; ++i)
        map += s.material_weight[i] * bump_read(s, s.material[i]);
    s.normal = bump_normal(map, s.tangent, s.bitangent, s.geometric_normal);
}

/// Self-shadowing factor of one normal. @param cosine  of the angle between it and the sun
float bump_factor(in float cosine) {
    float smoothed = smoothstep(0.0, bump_softness, cosine);
    float abrupt = cosine > 0.0 ? 1.0 : 0.0;
    return bump_correction == 2 ? smoothed : bump_correction == 1 ? abrupt : 1.0;
}

void bump_on_facing(in Surface s, in vec3 to_sun, inout float factor) {
    factor *= bump_factor(dot(s.geometric_normal, to_sun)) * bump_factor(dot(s.normal, to_sun));
}
