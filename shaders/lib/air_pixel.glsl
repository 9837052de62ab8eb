//! provides  what effects of the air tell those that come after them, of the pixel that is drawn

vec3 air_scattered = vec3(0.0);  // radiance of a clear sky's air that stands before the ground
bool air_in_sky = false;          // the sky that is drawn is that of lib/air.glsl
float air_lit = 1.0;             // light that the air around has, over what a clear sky gives it
