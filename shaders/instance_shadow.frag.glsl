//! provides  shadow maps of instances: the crown nearest to the sun, as instance_shadow.glsl reads it
//! reads     the outline and the depth of a crown as the sun sees it
//! writes    depth: 16 bits of the distance towards the sun, 8 bits of the light that the crown lets through

//@ include lib/crown.glsl
//@ include lib/instances.glsl

flat in vec4 instance_crown;  // half width, height [m]; taper; cosine of the sun's zenith angle
flat in vec4 instance_place;  // of its point, upwards: middle and half side [m]; z: towards the sun, of the foot [m];
                              // w: number of the map

const float kInstanceDepths = 65536.0;  // steps

void main() {
    float side = frame.instance_shadow_px;
    // Points reach over the edge of their map.
    float row = gl_FragCoord.y - side * instance_place.w;
    if (row < 0.0 || row > side) discard;
    vec2 at = (2.0 * gl_PointCoord - 1.0) * vec2(1.0, -1.0) * instance_place.y + vec2(0.0, instance_place.x);
    CrownSeen seen = crown_seen(instance_crown.x, instance_crown.y, instance_crown.z, instance_crown.w, at.y);
    if (abs(at.x) > seen.half_width_m) discard;
    vec3 crown = vec3(0.0, 0.0, instance_place.z + seen.towards_m);
    float depth = instances_shadow_place(crown, frame.instance_shadow_maps[int(instance_place.w)]).z;
    float steps = floor(clamp(depth * kInstanceDepths, 1.0, kInstanceDepths - 1.0));
    gl_FragDepth = (steps + floor(255.0 * INSTANCE_LIGHT + 0.5) / 256.0) / kInstanceDepths;
}
