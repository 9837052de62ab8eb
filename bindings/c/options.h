#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "figure/options.h"
#include "json/object_reader.h"
#include "scene/scene.h"

namespace relevo::c {

/// A JSON text of the caller's, an object whose members are read one by one.
class Options {
  public:
    /// @param text  null: no members
    /// @param who   what errors begin with
    /// @throws Error (BadInput) for what is no JSON object
    Options(const char* text, const std::string& who);
    Options(const Options&) = delete;
    Options& operator=(const Options&) = delete;

    json::ObjectReader& reader() { return reader_; }
    /// A walk of a million points has room [bytes].
    static constexpr std::size_t kMaxBytes = std::size_t{128} << 20;

  private:
    json::Value value_;
    json::ObjectReader reader_;
};

/// A number that figures are asked for with.
inline double number(json::ObjectReader& reader, const figure::Option& option, bool whole = false) {
    return reader.number(option.key, option.value, option.min, option.max, whole);
}

/// Changes a scene by a JSON text, as a shot of a job does. "format" may be there.
/// Relative names become absolute ones.
/// @param text    null: no change
/// @param folder  from which relative paths count
/// @throws Error (BadInput)
void change_scene(scene::Scene& scene, const char* text, const std::filesystem::path& folder);

/// The name of a model of refraction, as scenes have it.
/// @param who  what errors begin with @throws Error (BadInput) for an unknown one
std::string refraction_name(const std::string& name, const std::string& who);

/// A scene of a DEM.
/// @param text  members of `dem` without `files`, and `surroundings`; null: none
/// @throws Error (BadInput)
scene::Scene read_dem(const std::vector<std::string>& files, const char* text);
scene::Scene read_dem(const std::vector<std::string>& files, json::Value dem);

/// Takes members out of an object, into one of their own.
json::Value take_members(json::Value& object, const std::vector<std::string>& names);

/// JSON of a DEM, as read_dem() takes it. @throws Error (BadInput)
json::Value parse_dem(const char* text);

/// Whether two scenes with absolute names show one DEM, read in the same way. How its voids are
/// drawn may differ.
bool same_dem(scene::Scene a, scene::Scene b);

}  // namespace relevo::c
