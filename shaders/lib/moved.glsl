//! provides  surface_moved_up_m: by how much effects have moved a point of the ground

/// By how much effects have moved the point up [m]; 0 on ground that is where the DEM has it.
float surface_moved_up_m(in Surface s) {
#ifdef DISPLACED
    // Above the ellipsoid: |c + p| - |c| without the loss of a difference of two large numbers.
    float from_eye_m = dot(s.position_m, frame.eye_up.xyz);
    vec3 level_m = s.position_m - from_eye_m * frame.eye_up.xyz;
    const float earth_m = 6371000.0;
    float to_level_m = earth_m + frame.eye_m.w + from_eye_m;  // from the Earth's centre, along the eye's vertical
    float above_m = frame.eye_m.w + from_eye_m +
                    dot(level_m, level_m) / (to_level_m + length(vec2(to_level_m, length(level_m))));
    float moved_m = above_m - s.height_m * frame.height_range.z;
    return abs(moved_m) > 0.02 + 3e-4 * s.distance_m ? moved_m : 0.0;
#else
    return 0.0;
#endif
}
