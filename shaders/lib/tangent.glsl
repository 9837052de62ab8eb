//! provides  tangent_of: the direction in a surface along which its textures run east

/// With cross(normal, tangent), which runs north, an orthonormal frame. Made of the interpolated
/// normal for each pixel: a frame interpolated between vertices is not orthonormal between them.
vec3 tangent_of(in vec3 normal) {
    return normalize(vec3(1.0, 0.0, 0.0) - normal.x * normal);
}
