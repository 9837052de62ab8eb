#pragma once

#include <glm/vec3.hpp>

/// Light of a night without moon: airglow and starlight. Linear sRGB; units as in atmosphere.h.
namespace relevo::sky {

/// Irradiance of level ground at sea level: 0.002 lux.
/// The true colour of the night sky is a dull white, which eyes do not see as one: rods have no
/// colours, and pictures of nights are blue by convention.
glm::dvec3 night_irradiance();

/// Radiance of air that lets nothing pass along a ray, over night_irradiance(): what it scatters
/// towards the eye.
/// @param sine  of the ray's elevation at the eye
double night_scattered(double sine);

/// Radiance in a direction, without the light of the ground. Airglow is a thin layer 100 km up:
/// from below it is overhead, from orbit it covers the Earth and stands on its limb.
/// @param height_m  of the eye above sea level  @param sine  of the elevation
/// @param through   share of light that passes along the ray, to space or to the ground: of green,
///                  because eyes that see no colours see no red horizon, either
/// Source: P. van Rhijn 1921, in F. E. Roach and J. L. Gordon, The Light of the Night Sky, 1973.
glm::dvec3 night_radiance(double height_m, double sine, double through);

}  // namespace relevo::sky
