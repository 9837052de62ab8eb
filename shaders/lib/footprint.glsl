//! provides  footprint: where the next pixel is on the plane of a point; footprint_on_dem

/// Where the ray of the neighbouring pixel meets the plane of this point, from this point.
vec3 footprint(in vec3 position, in vec3 normal, in vec3 ray, in vec3 ray_step) {
    vec3 beside = ray + ray_step;
    // A ray never meets its plane at less than about one degree: textures would fade for nothing.
    float slant = min(dot(beside, normal), -0.02 * length(ray));
    return beside * (min(dot(position, normal), -0.02 * length(position)) / slant) - position;
}

/// A step over the drawn ground as one over the DEM's own.
vec3 footprint_on_dem(in vec3 step_m, in vec3 up) {
    return step_m - (1.0 - 1.0 / frame.height_range.z) * dot(step_m, up) * up;
}
