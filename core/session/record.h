#pragma once

#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "session/audit.h"
#include "session/session.h"

/// What a picture says of itself.
namespace relevo::session {

/// Keywords of a picture's metadata: its scene as scene::scene_line() has it, and the effects of a
/// comparison, parted by commas.
inline constexpr const char* kSceneKeyword = "relevo:scene";
inline constexpr const char* kComparedKeyword = "relevo:compared";

/// The scene of a session with its moment in UTC and with absolute paths: the same wherever it is
/// read, and whenever.
scene::Scene settled_scene(const Session& session);

/// What is written into every picture: `Software`, `Description`, the scene.
/// @param version   of the program
/// @param compared  Options::compared
image::Metadata metadata_of(const Session& session, const std::string& version,
                            const std::vector<std::string>& compared = {});

/// A file that a DEM was read from.
struct HashedFile {
    std::string path, sha256;
};

/// Of each of dem::files_of(). @throws Error (BadInput) where one cannot be read
std::vector<HashedFile> hashed_files(const std::vector<std::string>& dems);

/// The JSON beside a picture: its scene, sun, camera, device, versions, DEM; docs/jobs.md.
/// @param audit  of the picture, where there is one
std::string sidecar_text(const Session& session, const std::string& version,
                         const std::string& picture, const std::vector<HashedFile>& dem_files,
                         const std::optional<ShadowAudit>& audit = {});

}  // namespace relevo::session
