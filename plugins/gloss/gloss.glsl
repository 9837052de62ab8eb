//! provides  gloss: a grey map for each material
//! hook      material
//! reads     gloss
//! writes    specular
//! source    Costa and Celes, Tecnicas simples para visualizacao foto-realista de terrenos em tempo real
//!           usando placas graficas programaveis (Tecgraf, PUC-Rio), section 3.2

uniform float gloss_amount = 1.0; //@ range(0, 1) label("Amount") description("0: highlights unchanged")

/// What is left of a highlight. @param gloss  of the map, 0..1
float gloss_factor(in float gloss) {
    return mix(1.0, gloss, gloss_amount);
}

void gloss_on_material(inout Surface s) {
    s.specular *= gloss_factor(s.gloss);
}
