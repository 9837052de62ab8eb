#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "json/object_reader.h"
#include "scene/scene.h"

namespace relevo::scene {

/// Reads the members of scenes from JSON, of whole ones and of parts that change another.
class SceneReader {
  public:
    /// What times may leave open.
    enum class Dates {
        Needed,  ///< times are complete
        Later,   ///< of a job: a time of day, or an event, whose date comes from elsewhere
    };

    /// @param who   what errors begin with: "scene", "job"
    /// @param file  as errors name it
    /// @param folder  from which relative paths count
    SceneReader(std::string_view who, std::string file, std::filesystem::path folder,
                Dates dates = Dates::Needed);

    /// Takes what `object` says of a scene and puts it in the place of what `scene` has; members
    /// that are no scene's are left to the caller. A new place of the camera replaces the old one
    /// whole; effects are merged as scene::merge() does, the rest value by value.
    /// @param path  of the object in the file, "" at the top, "shots[3]" inside
    /// @throws Error (BadInput) `who: FILE:LINE: shots[3].camera.fov: what, expected E but got G`
    void take(json::ObjectReader& object, std::string_view path, Scene& scene) const;

    /// The same for the object of a camera or of effects alone.
    void take_camera(const json::Value& value, const std::string& path, Scene& scene) const;
    void take_effects(const json::Value& value, const std::string& path, Effects& effects) const;

    /// A standpoint from [latitude, longitude] or [latitude, longitude, height], which without a
    /// height is so far above the ground.
    Standpoint standpoint(const json::ObjectReader& object, const json::Value& value,
                          const char* key, double height_agl_m) const;

    /// A path that counts from the file's folder; what is no path of this machine stays.
    std::string beside(const std::string& name) const;
    /// A reader of an object inside the file.
    /// A weather's text, with the name of a file counted from the folder.
    json::Value whole_report(json::Value value) const;
    json::ObjectReader inside(const json::Value& value, const std::string& path) const;

  private:
    /// Takes the options that the table has for an object.
    void take_options(json::ObjectReader& object, std::string_view name, Scene& scene) const;
    void dem(const json::Value& value, const std::string& path, Scene& scene) const;
    void time(const json::Value& value, const std::string& path, TimeSpec& spec) const;
    void check_time(const json::ObjectReader& object, const TimeSpec& spec) const;
    void overlay(const json::Value& value, const std::string& path, Scene& scene) const;
    void stamps(const json::Value& value, const std::string& path, Scene& scene) const;
    /// @returns whether it has a size
    bool picture(const json::Value& value, const std::string& path, Scene& scene) const;

    std::string who_, file_;
    std::filesystem::path folder_;
    Dates dates_;
};

/// Whether a text is a time of day alone: "6:30", "18:30:15".
bool is_clock(std::string_view text);

}  // namespace relevo::scene
