#pragma once

#include <string>
#include <vector>

#include "film/film.h"
#include "json/object_reader.h"
#include "scene/job.h"
#include "scene/scene_reader.h"

/// Reads what a job says of its film and of cameras that move.
namespace relevo::scene {

/// The object `film`.
film::Settings read_film(const json::ObjectReader& job, const json::Value& value);

/// The number of frames that a motion has, by `frames` or by `duration_s` of a film.
/// @param otherwise_s  where neither is there
int read_frames(json::ObjectReader& object, double fps, double otherwise_s);

/// The object of an axis `orbit`. @param path  in the file, "sweep[0].orbit"
OrbitMotion read_orbit(const SceneReader& reader, const json::Value& value, const std::string& path,
                       double fps);

/// The object of an axis `flight`.
/// @param scene  gives its views the members that they do not have
/// @param files  receives the file of the line
FlightMotion read_flight(const SceneReader& reader, const json::Value& value,
                         const std::string& path, double fps, const Scene& scene,
                         std::vector<JobFile>& files);

}  // namespace relevo::scene
