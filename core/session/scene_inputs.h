#pragma once

#include <compare>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "base/files_in_use.h"
#include "scene/scene.h"
#include "session/active_effects.h"

namespace relevo::session {

/// A file with the SHA-256 of its content, in hexadecimal.
struct HashedFile {
    std::string path, sha256;
};

/// The files that scenes are drawn from: DEM, overlay, weather, colour file, presets, plugins, and
/// files named by parameters. Finds and hashes each once, however many scenes share it. Needs no
/// device. Not thread-safe.
class SceneInputs {
  public:
    /// @param version  of Relevo
    explicit SceneInputs(std::string version);
    ~SceneInputs();
    SceneInputs(const SceneInputs&) = delete;
    SceneInputs& operator=(const SceneInputs&) = delete;

    const std::string& version() const { return version_; }

    /// The effects with absolute file names, after checking switches and settings.
    /// @throws Error (BadInput) for unknown effects and parameters
    const scene::Effects& settled(const scene::Effects& effects);

    /// Adds all files of a scene to the inputs of a run.
    /// @throws Error as FilesInUse::add_input and settled()
    void add_to(FilesInUse& files, const scene::Scene& scene);

    /// The inputs of a scene's picture as one line of JSON: Relevo's version, and a digest of the
    /// file contents of each kind ("dem", "overlay", "colours", "weather", "presets", "plugins",
    /// "files").
    /// File names and times are excluded, so that copies are equal. Exceptions: rasters of more
    /// than 1 GiB are identified by file sizes and times, an index of tiles by its content and by
    /// sizes and times of its tiles on this machine, and remote files are not read.
    /// @throws Error as settled()
    std::string record(const scene::Scene& scene);

    /// The files of the scene's DEM with their digests; of an index itself alone.
    /// @throws Error (BadInput) if one cannot be read
    std::vector<HashedFile> hashed_dem(const scene::Scene& scene);

    /// Names of the scene's DEM and overlay that are not local files. Their changes go unnoticed.
    std::vector<std::string> remote_names(const scene::Scene& scene);

  private:
    struct OfEffects;
    const OfEffects& of(const scene::Effects& effects);
    const std::vector<std::filesystem::path>& raster_files(const std::vector<std::string>& names);
    bool is_index(const std::string& name);
    const std::string& sha256(const std::filesystem::path& path);
    std::string digest(const std::vector<std::filesystem::path>& files);
    std::string digest_of_rasters(const std::vector<std::string>& names);
    /// Identifies a scene's files: addresses of cached lists, and the names of tables.
    struct Key {
        const void* dems = nullptr;
        const void* forecast = nullptr;
        const void* effects = nullptr;
        std::vector<std::tuple<std::string, const void*, std::string>> layers;  // role, table

        auto operator<=>(const Key&) const = default;
    };
    Key key_of(const scene::Scene& scene);
    std::string record_of(const scene::Scene& scene);

    std::string version_;
    std::map<std::string, std::unique_ptr<InstalledEffects>> installed_;
    std::map<std::string, std::unique_ptr<OfEffects>> effects_;
    std::map<std::vector<std::string>, std::vector<std::filesystem::path>> rasters_;
    std::map<std::filesystem::path, std::string> hashes_;
    std::map<std::string, bool> indexes_;
    std::map<Key, std::string> records_;
    std::set<Key> added_;
};

/// Key of effects. Equal keys mean equal programs and parameter values.
std::string effects_key(const scene::Effects& effects);

}  // namespace relevo::session
