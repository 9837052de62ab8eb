#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "image/image.h"
#include "session/audit.h"
#include "session/record_reader.h"
#include "session/scene_inputs.h"
#include "session/session.h"

/// What a picture says of itself.
namespace relevo::session {

/// Keywords of a picture's metadata: the compared effects separated by commas, and
/// SceneInputs::record().
inline constexpr const char* kComparedKeyword = "relevo:compared";
inline constexpr const char* kInputsKeyword = "relevo:inputs";
/// Of layers: the origin of the local frame, `{"lat_deg":46.5,"lon_deg":8,"height_m":0}`,
/// ellipsoidal on WGS 84; x east, y north, z up there.
inline constexpr const char* kOriginKeyword = "relevo:origin";

/// As sidecar_of(), for writing. @throws Error (BadInput) if it is a pipe or device: writing could
/// block
std::filesystem::path sidecar_to_write(const std::filesystem::path& picture);

/// The scene of a session with its time in UTC and absolute paths, which makes it independent of
/// when and where it is read.
scene::Scene settled_scene(const Session& session);

/// Where a picture's scene is stored.
enum class SceneIn { Picture, Sidecar };

/// Sidecar if the picture's format cannot hold the scene and some reserve.
/// @param scene  with absolute paths
SceneIn scene_in(const std::filesystem::path& picture, const scene::Scene& scene);

/// Keyword of format_text(), of pictures that are not written as by default.
inline constexpr const char* kFormatKeyword = "relevo:format";
/// What a picture's file is besides what its name says: "16 bits, quality 80, layers depth
/// position"; empty: as by default. By it --resume tells such files from others.
std::string format_text(const image::Encoding& encoding, const PictureFormat& format);

/// Metadata of every picture: `Software`, `Description`, the inputs, and the scene or its digest.
/// @param format  as format_text()
image::Metadata metadata_of(const Session& session, SceneInputs& inputs, SceneIn where,
                            const std::string& format);

/// Message that a picture's scene is in its sidecar.
std::string says_where_scene_is(const std::filesystem::path& picture);

/// The JSON sidecar of a picture: scene, sun, camera, device, versions, DEM; see docs/jobs.md.
/// @param picture  name of its file
/// @param audit    of the picture, if any
std::string sidecar_text(const Session& session, SceneInputs& inputs, const std::string& picture,
                         const std::optional<ShadowAudit>& audit = {});

}  // namespace relevo::session
