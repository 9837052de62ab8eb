#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "image/image.h"
#include "session/audit.h"
#include "session/scene_inputs.h"
#include "session/session.h"

/// What a picture says of itself.
namespace relevo::session {

/// Keywords of a picture's metadata: its scene as scene::scene_line() has it, the effects of a
/// comparison, separated by commas, and SceneInputs::record().
inline constexpr const char* kSceneKeyword = "relevo:scene";
inline constexpr const char* kComparedKeyword = "relevo:compared";
inline constexpr const char* kInputsKeyword = "relevo:inputs";
/// Where the picture's format has no room for its scene: the SHA-256 of scene::scene_line(), whose
/// text is in the sidecar.
inline constexpr const char* kSceneDigestKeyword = "relevo:scene-sha256";

/// The JSON file beside a picture.
std::filesystem::path sidecar_of(std::filesystem::path picture);

/// The same, to be written. @throws Error (BadInput) where it is a pipe or a device, which would
/// keep the program waiting though nobody has named it
std::filesystem::path sidecar_to_write(const std::filesystem::path& picture);

/// The scene of a session with its moment in UTC and with absolute paths: the same wherever it is
/// read, and whenever.
scene::Scene settled_scene(const Session& session);

/// Where the scene of a picture is.
enum class SceneIn { Picture, Sidecar };

/// The sidecar has it where the picture's format has no room, with some to spare for what a session
/// fills in.
/// @param scene  with absolute paths
SceneIn scene_in(const std::filesystem::path& picture, const scene::Scene& scene);

/// What is written into every picture: `Software`, `Description`, what it was made from, and the
/// scene or its digest.
image::Metadata metadata_of(const Session& session, SceneInputs& inputs, SceneIn where);

/// One line about a scene that does not fit, for people.
std::string says_where_scene_is(const std::filesystem::path& picture);

/// The JSON of a record, which anybody may have written, without what is nested deeper than records
/// are: to write that again would take a stack of its depth. Empty for what is not JSON.
std::string shallow_json(const std::string& text);

/// The metadata of a picture with its scene, also where that is in the sidecar.
/// @throws Error (BadInput) as image::read_metadata(), and where the picture's scene is in a
/// sidecar
///     that is missing, cannot be read or is another picture's
image::Metadata read_record(const std::filesystem::path& picture);

/// The JSON beside a picture: its scene, sun, camera, device, versions, DEM; docs/jobs.md.
/// @param picture  its file's name
/// @param audit    of the picture, where there is one
std::string sidecar_text(const Session& session, SceneInputs& inputs, const std::string& picture,
                         const std::optional<ShadowAudit>& audit = {});

}  // namespace relevo::session
