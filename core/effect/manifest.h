#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "shader/param_store.h"

namespace relevo::effect {

/// A texture that a plugin brings: the sampler `<id>_<name>` reads it.
struct TextureSpec {
    enum class Kind { D2, D2Array, D3 };
    enum class Wrap { Repeat, Clamp };

    std::string name;      ///< "noise"
    std::string resource;  ///< "haze.noise": what the stitcher calls it
    Kind kind = Kind::D2;
    std::vector<std::filesystem::path> files;  ///< one; of an array, its layers. They exist
    int slices = 1;     ///< of a volume in a picture: slices that lie below each other
    bool srgb = false;  ///< colours, linearised when read; else plain numbers
    Wrap wrap = Wrap::Repeat;
    bool mipmaps = true;
    int line = 0;  ///< in plugin.json

    /// Whether another is the same on the device, whatever it is called.
    bool same_texels(const TextureSpec& other) const {
        return kind == other.kind && files == other.files && slices == other.slices &&
               srgb == other.srgb && wrap == other.wrap && mipmaps == other.mipmaps;
    }
};

/// How far a plugin's hook `displace` moves the ground at most, so that core draws what is moved
/// into sight. Heights are the DEM's, not exaggerated.
struct DisplaceSpec {
    /// A length [m], or the parameter of the plugin's own that holds it.
    struct Length {
        double metres = 0;
        std::string address;  ///< "sea.level_m"; empty: `metres`
    };
    Length down, up;           ///< along the vertical
    Length aside;              ///< across it, in any direction
    std::optional<Length> to;  ///< anywhere between the ground and this height
    int line = 0;              ///< in plugin.json

    std::vector<const Length*> lengths() const {
        std::vector<const Length*> all{&down, &up, &aside};
        if (to) all.push_back(&*to);
        return all;
    }
};

/// What an effect shows of ground near the eye that nobody has measured, so that it can be said.
struct Invention {
    std::string what;        ///< a sentence without its end
    std::string address;     ///< "bump.relief": the parameter that 0 takes it away by
    double pixel_posts = 0;  ///< seen where a side of a pixel has fewer posts than that
    int line = 0;            ///< in plugin.json
};

/// What plugin.json says. The format is docs/plugin-guide.md's.
struct Manifest {
    std::string id;  ///< `[a-z][a-z0-9]*`
    std::string name;
    std::string description;
    std::string version;
    bool enabled_by_default = true;
    std::vector<std::string> default_where;  ///< what a DEM must have for that: ground_words()

    // Capability words, `[a-z][a-z0-9_]*`.
    std::vector<std::string> provides;
    std::vector<std::string> needs;      ///< "requires": off without them
    std::vector<std::string> wants;      ///< HAS_<word> in its GLSL says whether they are there
    std::vector<std::string> exclusive;  ///< of `provides`: one effect alone may be on with it
    std::vector<std::string> after;      ///< comes behind the effects that provide them

    std::vector<std::filesystem::path> glsl;  ///< files, in order. They exist
    std::vector<TextureSpec> textures;
    std::optional<DisplaceSpec> displaces;
    std::optional<Invention> invents;
    std::string module;                    ///< name of a native library, or empty
    std::vector<shader::TextParam> texts;  ///< that the module reads

    std::filesystem::path folder;
    std::filesystem::path file;  ///< folder / "plugin.json"
};

/// What a DEM may have, as a plugin's "default_where" says it: "water"; "marked_holes", which are
/// filled and to be painted; "covered_voids", which are too wide to be filled as ground.
std::span<const std::string_view> ground_words();

/// Reads `folder/plugin.json`.
/// @param data_dir  where `data:ground/rock.png` is: `share_dir() / "data"`
/// @throws Error (BadInput) `plugin: folder/plugin.json:line: ...`
Manifest load_manifest(const std::filesystem::path& folder, const std::filesystem::path& data_dir);

}  // namespace relevo::effect
