//! provides  a direction as two numbers of -1 to 1, and back
//! source    Cigolle et al., Survey of Efficient Representations for Independent Unit Vectors, JCGT 3(2),
//!           2014: oct

vec2 normal_folded(in vec2 p) {
    return (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
}

/// @param direction  unit
vec2 normal_octahedral(in vec3 direction) {
    vec3 d = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    return d.z < 0.0 ? normal_folded(d.xy) : d.xy;
}

vec3 normal_from_octahedral(in vec2 p) {
    float z = 1.0 - abs(p.x) - abs(p.y);
    return normalize(vec3(z < 0.0 ? normal_folded(p) : p, z));
}
