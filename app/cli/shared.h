#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>

#include "base/files_in_use.h"
#include "cli/verb.h"
#include "figure/options.h"
#include "light/point/refraction_at.h"
#include "scene/options.h"
#include "scene/scene.h"
#include "session/words.h"
#include "sun/position.h"
#include "sun/refraction.h"
#include "sun/zone.h"

/// Options that several verbs take. Each struct adds its options to a verb, and makes a value of
/// core's from what was given.
namespace relevo::cli {

/// -o and --overwrite of a verb that writes a file of one of several formats.
struct ResultArguments {
    std::string path;
    bool overwrite = false;
    std::vector<std::string> endings;  ///< that the verb writes

    /// Of `path`, in lower case: "glb"; empty without one.
    std::string ending() const;
    /// @throws Error (Usage) for an ending that the verb does not write
    void check_ending() const;
};

/// Options of scene::options(), and what was given of them.
class OptionArguments {
  public:
    void add_to(Verb verb, const scene::Option& option);
    bool has(std::string_view flag) const;
    /// What was given of an option that takes a text; empty: nothing.
    std::string text(std::string_view flag) const;
    /// Whether there is any of a JSON object: "overlay".
    bool has_any(std::string_view object) const;
    /// Puts what was given in the place of what a scene says.
    void apply_to(scene::Scene& scene) const;

  private:
    std::vector<std::pair<const scene::Option*, json::Value>> given_;
};

/// DEM... and how to read it.
struct DemArguments {
    std::vector<std::string> paths;
    OptionArguments values;
    std::optional<double> nodata;
    bool no_nodata = false;
    std::optional<dem::Bounds> bounds;
    bool no_cache = false;
    std::vector<std::string> surroundings;
    Option dem_option;

    void add_to(Verb verb);
    /// --surroundings, for verbs of light over Posts.
    void add_surroundings_to(Verb verb);
    /// What a run reads: names, before an output is opened, and then all files behind them.
    /// @throws Error as FilesInUse::add_input
    void add_named(FilesInUse& files) const;
    void add_all(FilesInUse& files) const;
    /// Puts what was given in the place of what a scene says.
    void apply_to(scene::Scene& scene) const;
    dem::LoadOptions options() const;
};

/// --time, --date and --tz.
struct TimeArguments {
    std::string time, date, zone;

    void add_to(Verb verb);
    /// @throws Error (Usage) for --date or --tz without --time, which would say nothing
    bool given() const;
    scene::TimeSpec spec() const { return {time, date, zone}; }
};

/// --refraction and --no-refraction.
struct RefractionArguments {
    OptionArguments model;
    bool off = false;

    /// @param body  whose light it is, as --help says
    void add_to(Verb verb, sun::Body body = sun::Body::Sun);
    bool given() const { return off || model.has("--refraction"); }
    /// As scene::Scene has it.
    std::string name() const;
    sun::Refraction at(const geo::Geodetic& place) const {
        return light::refraction_at(name(), place);
    }
};

inline constexpr double kMiB = 1 << 20;  // bytes

/// Where the camera stands.
struct ViewArguments {
    std::string view, eye, look_at;
    std::optional<double> heading_deg, pitch_deg;

    void add_to(Verb verb);
    bool any() const;  ///< whether one is given
    /// Puts what was given in the place of what a scene says. @throws Error (Usage)
    void apply_to(scene::Scene& scene) const;
};

/// A number with both ends included; else "expected 0.1 to 170 but got 500".
Check in_range(double min, double max);
inline Check in_range(const figure::Range& range) {
    return in_range(range.min, range.max);
}
/// An option of figures. @param letter  "-k,", or none
template <typename Number>
Option add_number(const Verb& verb, const figure::Option& option, Number& number,
                  const std::string& letter = "") {
    std::string name = option.key;
    std::ranges::replace(name, '_', '-');
    return verb.add_option(letter + "--" + name, number, option.help).check(in_range(option));
}

/// Any number that is one: no infinity, nothing but digits and an exponent.
Check any_number();

/// A whole number that an int holds; else "expected a whole number but got 1.5".
Check whole_number();

/// What the JSON of a verb calls its shape: "relevo-sun-day-1". The number rises when a key changes
/// its meaning or goes.
std::string schema_of(const Verb& verb);

/// The same object with `schema` as its first key, unless it has one.
nlohmann::ordered_json with_schema(const std::string& schema, const nlohmann::ordered_json& json);

/// JSON as the contract has it, two blanks a level. Text that is not UTF-8, such as a file's name,
/// has U+FFFD for what cannot be said.
std::string json_text(const nlohmann::ordered_json& json);

/// "1280x720" as width and height. @throws Error (Usage)
glm::ivec2 parse_size(const std::string& text);

}  // namespace relevo::cli
