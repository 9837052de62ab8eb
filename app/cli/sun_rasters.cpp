#include "cli/sun_rasters.h"

#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"

namespace relevo::cli {

bool RasterGround::whole() const {
    return window == dem::Window{0, 0, posts.grid().columns(), posts.grid().rows()};
}

dem::Grid RasterGround::grid() const {
    return whole() ? posts.grid() : posts.grid().part(window, window.columns, window.rows);
}

void RasterArguments::add_to(CLI::App& verb) {
    dem.add_to(verb);
    verb.add_option("-k,--terrestrial-refraction", terrestrial_refraction,
                    "Curvature of a line of sight over the ground, in units of the Earth's (0.13)")
        ->check(in_range(-1.0, 0.9));
    output.endings = {"tif", "tiff"};
    verb.add_option("-o,--output", output.path, "Write a cloud-optimised GeoTIFF on the DEM's grid")
        ->required();
    verb.add_flag("--overwrite", output.overwrite, "Replace an existing file");
    verb.add_option("--co", creation_options,
                    "Creation option of GDAL's COG driver: COMPRESS=ZSTD; may be repeated")
        ->allow_extra_args(false);
    verb.add_option("--clip", clip,
                    "Only the posts in W,S,E,N of the DEM's CRS; ground around them counts all "
                    "the same")
        ->type_name("W,S,E,N");
    verb.add_option("--clip-crs", clip_crs, "CRS of --clip instead: EPSG:4326");
}

OutputFile& RasterArguments::open(FilesInUse& files) const {
    light::check_creation_options(creation_options);
    return *output.open(files, dem);
}

RasterGround RasterArguments::load() const {
    if (clip.empty() && !clip_crs.empty()) bad_usage("--clip-crs: goes with --clip");
    std::optional<dem::Clip> rectangle;
    if (!clip.empty()) rectangle = dem::parse_clip(clip, "--clip");
    if (!clip_crs.empty()) rectangle->crs = geo::Crs::parse(clip_crs, "--clip-crs");
    dem::Posts posts = dem::Posts::load(dem.paths, dem.options);
    const dem::Grid& grid = posts.grid();
    const dem::Window window = rectangle ? dem::window_of(grid, *rectangle, "--clip")
                                         : dem::Window{0, 0, grid.columns(), grid.rows()};
    return {std::move(posts), window, {window}};
}

light::RasterMetadata RasterArguments::about(const RasterGround& ground,
                                             const std::string& definition, std::int64_t holes,
                                             light::RasterMetadata more) const {
    light::RasterMetadata about{
        {"TIFFTAG_SOFTWARE", "Relevo " RELEVO_VERSION},
        {"DEFINITION", definition},
        {"DEM", ground.posts.about().path},
        {"TERRESTRIAL_REFRACTION", fmt::format("{:.4g}", terrestrial_refraction)},
        {"HOLES", fmt::format("{}", holes)}};
    if (!ground.whole()) {
        const dem::Window& w = ground.window;
        about.emplace_back(
            "CLIP", fmt::format("columns {} to {} and rows {} to {} of the DEM, from 0", w.column,
                                w.column + w.columns - 1, w.row, w.row + w.rows - 1));
    }
    for (auto& item : more)
        about.push_back(std::move(item));
    return about;
}

std::string air_of_posts(const RefractionArguments& refraction, const dem::Posts& posts) {
    if (refraction.name() == "standard")
        return "integrated ICAO standard atmosphere over each post";
    geo::Geodetic ground = posts.grid().center();
    const double height_m =
        posts.height_at((posts.grid().columns() - 1) / 2.0, (posts.grid().rows() - 1) / 2.0);
    ground.height_m = std::isnan(height_m) ? posts.lowest_m() : height_m;
    return refraction.at(ground).description();
}

void warn_of_holes(std::int64_t holes) {
    if (holes > 0)
        log::warning(
            fmt::format("the DEM has {} holes: they get no figure, and hide nothing", holes));
}

}  // namespace relevo::cli
