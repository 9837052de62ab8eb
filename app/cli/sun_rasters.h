#pragma once

#include <string>
#include <vector>

#include "cli/sun_options.h"
#include "light/raster.h"

/// What the verbs that give a figure for every post of a DEM share.
namespace relevo::cli {

/// DEM..., -k, -o, --overwrite, --co.
struct RasterArguments {
    DemArguments dem;
    double terrestrial_refraction = 0.13;
    OutputArguments output;
    std::vector<std::string> creation_options;

    void add_to(CLI::App& verb);
    /// Opens the result, before any work is done. @throws Error as OutputArguments::open, (Usage)
    /// for creation options that there are not
    OutputFile& open(FilesInUse& files) const;
    dem::Posts load() const { return dem::Posts::load(dem.paths, dem.options); }
    /// What every such file says of itself; `more` besides.
    light::RasterMetadata about(const dem::Posts& posts, const std::string& definition,
                                std::int64_t holes, light::RasterMetadata more) const;
};

/// --refraction's model in words, over each post.
std::string air_of_posts(const RefractionArguments& refraction, const dem::Posts& posts);

/// Warns of holes, where there are some.
void warn_of_holes(std::int64_t holes);

}  // namespace relevo::cli
