#pragma once

#include <string>
#include <vector>

#include "cli/sun_options.h"
#include "dem/clip.h"
#include "light/raster.h"

/// What the verbs that give a figure for every post of a DEM share.
namespace relevo::cli {

/// A DEM, and what of it a raster is made of.
struct RasterGround {
    dem::Posts posts;
    dem::Window window;              ///< that is asked for
    std::vector<dem::Window> parts;  ///< of it, one after the other

    bool whole() const;
    dem::Grid grid() const;  ///< of the result
};

/// DEM..., -k, -o, --overwrite, --co, --clip, --clip-crs.
struct RasterArguments {
    DemArguments dem;
    double terrestrial_refraction = 0.13;
    OutputArguments output;
    std::vector<std::string> creation_options;
    std::string clip, clip_crs;

    void add_to(CLI::App& verb);
    /// Opens the result, before any work is done. @throws Error as OutputArguments::open, (Usage)
    /// for creation options that there are not
    OutputFile& open(FilesInUse& files) const;
    /// @throws Error (Usage, BadInput) as dem::load, dem::parse_clip and dem::window_of
    RasterGround load() const;
    /// What every such file says of itself; `more` besides.
    light::RasterMetadata about(const RasterGround& ground, const std::string& definition,
                                std::int64_t holes, light::RasterMetadata more) const;
};

/// --refraction's model in words, over each post.
std::string air_of_posts(const RefractionArguments& refraction, const dem::Posts& posts);

/// Warns of holes, where there are some.
void warn_of_holes(std::int64_t holes);

}  // namespace relevo::cli
