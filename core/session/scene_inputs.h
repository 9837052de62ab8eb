#pragma once

#include <compare>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "base/files_in_use.h"
#include "scene/scene.h"
#include "session/active_effects.h"

namespace relevo::session {

/// A file and what its bytes are.
struct HashedFile {
    std::string path, sha256;
};

/// The files that scenes are drawn from: DEM, overlay and its colours, presets, plugins, files that
/// parameters name. Each is found and hashed once, however many scenes share it. No device is
/// needed. Used on one thread.
class SceneInputs {
  public:
    /// @param version  of the program
    explicit SceneInputs(std::string version);
    ~SceneInputs();
    SceneInputs(const SceneInputs&) = delete;
    SceneInputs& operator=(const SceneInputs&) = delete;

    const std::string& version() const { return version_; }

    /// Effects whose switches and settings are checked, with absolute names of files.
    /// @throws Error (BadInput) for effects and parameters that do not exist
    const scene::Effects& settled(const scene::Effects& effects);

    /// Adds every file that the scene's picture is made from. @throws Error as
    /// FilesInUse::add_input and settled()
    void add_to(FilesInUse& files, const scene::Scene& scene);

    /// What the scene's picture is made from, as one line of JSON: the program's version, and a
    /// digest of the content of the files of each kind ("dem", "overlay", "colours", "presets",
    /// "plugins", "files"). Names and times of files are not in it, so that copies are the same and
    /// clocks do not matter; but the files of a raster of more than 1 GiB are known by their sizes
    /// and times. Remote files are not read for it.
    /// @throws Error as settled()
    std::string record(const scene::Scene& scene);

    /// The files of the scene's DEM. @throws Error (BadInput) where one cannot be read
    std::vector<HashedFile> hashed_dem(const scene::Scene& scene);

    /// Names of the scene's DEM and overlay that are no files of this machine: changes go
    /// unnoticed.
    std::vector<std::string> remote_names(const scene::Scene& scene);

  private:
    struct OfEffects;
    const OfEffects& of(const scene::Effects& effects);
    const std::vector<std::filesystem::path>& raster_files(const std::vector<std::string>& names);
    const std::string& sha256(const std::filesystem::path& path);
    std::string digest(const std::vector<std::filesystem::path>& files);
    std::string digest_of_rasters(const std::vector<std::string>& names);
    /// What a scene's files are known by: lists that are kept, and the name of the colours.
    struct Key {
        const void* dems = nullptr;
        const void* overlay = nullptr;
        const void* effects = nullptr;
        std::string colours;

        auto operator<=>(const Key&) const = default;
    };
    Key key_of(const scene::Scene& scene);
    std::string record_of(const scene::Scene& scene);

    std::string version_;
    std::map<std::string, std::unique_ptr<InstalledEffects>> installed_;
    std::map<std::string, std::unique_ptr<OfEffects>> effects_;
    std::map<std::vector<std::string>, std::vector<std::filesystem::path>> rasters_;
    std::map<std::filesystem::path, std::string> hashes_;
    std::map<Key, std::string> records_;
    std::set<Key> added_;
};

/// Effects as a text; equal ones are drawn by the same programs and values.
std::string effects_key(const scene::Effects& effects);

}  // namespace relevo::session
