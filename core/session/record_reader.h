#pragma once

#include <filesystem>
#include <string>

#include "image/image.h"

/// Reads what record.h writes. Records are untrusted.
namespace relevo::session {

/// Keyword of a picture's metadata: its scene as scene::scene_line().
inline constexpr const char* kSceneKeyword = "relevo:scene";
/// SHA-256 of scene::scene_line(), for formats whose metadata cannot hold the scene. The scene is
/// then in the sidecar.
inline constexpr const char* kSceneDigestKeyword = "relevo:scene-sha256";

/// Path of a picture's JSON sidecar.
std::filesystem::path sidecar_of(std::filesystem::path picture);

/// The JSON of a record without anything nested deeper than 32 levels; empty if it is not JSON.
/// Records are untrusted, and serialising deep ones would exhaust the stack.
std::string shallow_json(const std::string& text);

/// The metadata of a picture including its scene, even if that is in the sidecar.
/// @throws Error (BadInput) as image::read_metadata(), and if the sidecar with the scene is
///     missing, unreadable or belongs to another picture
image::Metadata read_record(const std::filesystem::path& picture);

}  // namespace relevo::session
