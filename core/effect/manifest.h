#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "effect/ground_data.h"
#include "effect/marks_spec.h"
#include "effect/rising.h"
#include "effect/weather_spec.h"
#include "shader/instance_set.h"
#include "shader/param_store.h"
#include "shader/plugin_pass.h"

namespace relevo::effect {

/// What messages about the files of a plugin begin with.
inline constexpr std::string_view kPluginWho = "plugin";

/// A texture of a plugin. The sampler `<id>_<name>` reads it.
struct TextureSpec {
    /// Table and Cube are read by read_table() and read_cube().
    enum class Kind { D2, D2Array, D3, Table, Cube };
    enum class Wrap { Repeat, Clamp };

    std::string name;      ///< "noise"
    std::string resource;  ///< "haze.noise": its name for the stitcher
    Kind kind = Kind::D2;
    std::vector<std::filesystem::path> files;  ///< one; of an array, its layers. They exist
    std::string from;   ///< "grade.lut": the text that names the file instead; empty: none
    int slices = 1;     ///< of a volume in an image file: slices one below the other
    bool srgb = false;  ///< colours, linearised when read; else numbers
    Wrap wrap = Wrap::Repeat;
    bool mipmaps = true;
    int line = 0;  ///< in plugin.json

    /// Whether another texture is equal on the device, apart from its name.
    bool same_texels(const TextureSpec& other) const {
        return kind == other.kind && files == other.files && slices == other.slices &&
               srgb == other.srgb && wrap == other.wrap && mipmaps == other.mipmaps;
    }
};

/// A bound of the displacement by a plugin's hook `displace`: core draws terrain that is displaced
/// into view. Heights are the DEM's, not exaggerated.
struct DisplaceSpec {
    /// A length [m], or one of the plugin's parameters.
    struct Length {
        double metres = 0;
        std::string address;  ///< "sea.level_m"; empty: `metres`
    };
    Length down, up;           ///< vertical
    Length aside;              ///< horizontal, in any direction
    std::optional<Length> to;  ///< any height between the ground and this one
    int line = 0;              ///< in plugin.json

    std::vector<const Length*> lengths() const {
        std::vector<const Length*> all{&down, &up, &aside};
        if (to) all.push_back(&*to);
        return all;
    }
};

/// Synthetic detail of an effect, visible near the eye. It is reported.
struct Invention {
    std::string what;        ///< a sentence without a full stop
    std::string address;     ///< "bump.relief": a parameter; 0 removes the detail
    double pixel_posts = 0;  ///< visible if a pixel side has fewer posts ...
    double post_m = 0;       ///< ... which are at least so far apart
    int line = 0;            ///< in plugin.json
};

/// The content of plugin.json. docs/plugin-guide.md has the format.
struct Manifest {
    std::string id;  ///< `[a-z][a-z0-9]*`
    std::string name;
    std::string description;
    std::string version;
    std::string group;  ///< "ground", "light", "air", "water", "maps"; empty: none
    /// Addresses of parameters and texts that matter most, which windows show first.
    std::vector<std::string> first;
    int first_line = 0;  ///< in plugin.json
    bool enabled_by_default = true;
    std::vector<std::string> default_where;  ///< that the DEM must have for it: ground_words()

    // Capability words, `[a-z][a-z0-9_]*`.
    std::vector<std::string> provides;
    std::vector<std::string> needs;      ///< "requires": off without them
    std::vector<std::string> wants;      ///< HAS_<word> in its GLSL is 1 if provided
    std::vector<std::string> exclusive;  ///< of `provides`: only one effect with it may be on
    std::vector<std::string> after;      ///< comes after effects that provide them

    std::vector<std::filesystem::path> glsl;  ///< files, in order. They exist
    std::vector<TextureSpec> textures;
    std::vector<RasterSpec> rasters;
    std::vector<FieldSpec> fields;
    std::vector<LinesSpec> lines;
    std::vector<shader::PluginPass> passes;
    std::vector<MarksSpec> marks;
    std::vector<shader::InstanceSet> instances;
    std::optional<DisplaceSpec> displaces;
    std::optional<Invention> invents;
    std::optional<WeatherSpec> weather;
    std::vector<Rising> rising;
    std::string module;                    ///< name of a native library, or empty
    std::vector<shader::TextParam> texts;  ///< that the module reads, or that name data

    std::filesystem::path folder;
    std::filesystem::path file;  ///< folder / "plugin.json"
};

/// Words of "default_where", for features of a DEM: "water"; "marked_holes", voids that are filled
/// and marked; "covered_voids", voids too wide to be filled as ground.
std::span<const std::string_view> ground_words();

/// Whether core itself provides a capability word, for some of its programs.
bool is_core_word(std::string_view word);

/// Whether a text can be part of a GLSL name, `[a-z][a-z0-9_]*` without __ or a _ at the end: a
/// capability word, or the name of a texture.
bool is_word(std::string_view text);

/// Why a text cannot be the id of a plugin; empty if it can.
std::string fault_of_id(std::string_view text);

/// Reads `folder/plugin.json`.
/// @param data_dir  where `data:ground/rock.png` is: `share_dir() / "data"`
/// @throws Error (BadInput) `plugin: folder/plugin.json:line: ...`
Manifest load_manifest(const std::filesystem::path& folder, const std::filesystem::path& data_dir);

}  // namespace relevo::effect
