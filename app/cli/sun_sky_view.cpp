#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "cli/sun.h"
#include "cli/sun_rasters.h"
#include "figure/horizons.h"
#include "figure/sky_view.h"

namespace relevo::cli {
namespace {

struct SkyViewArguments {
    RasterArguments raster;
    int directions = 0;
    bool level = false;
};

void run_sky_view(const SkyViewArguments& arguments) {
    FilesInUse files;
    OutputFile* const file = arguments.raster.open(files);
    const RasterGround ground = arguments.raster.load();
    figure::SkyView figure;
    arguments.raster.apply_to(figure);
    figure.directions = arguments.directions;
    figure.level = arguments.level;
    double sum = 0, posts = 0;
    std::string definition;
    figure.seen = [&](const light::SkyView& part) {
        const auto seen = static_cast<double>(part.share.size()) - static_cast<double>(part.holes);
        if (seen > 0) sum += part.mean * seen;
        posts += seen;
        definition = part.definition;
    };
    if (!RasterRun(arguments.raster, file, files, ground, figure).make_all()) return;
    fmt::print("sky view            mean {:.4f}\n\n{}\n", sum / std::max(1.0, posts), definition);
}

void run_horizons(const SkyViewArguments& arguments) {
    FilesInUse files;
    OutputFile* const file = arguments.raster.open(files);
    const RasterGround ground = arguments.raster.load();
    figure::Horizons figure;
    arguments.raster.apply_to(figure);
    figure.directions = arguments.directions;
    if (!RasterRun(arguments.raster, file, files, ground, figure).make_all()) return;
    fmt::print("horizons            {} directions, {:.10g} degrees apart, from true north\n\n{}\n",
               arguments.directions, 360.0 / arguments.directions,
               light::horizons_definition(figure.terrestrial_refraction));
}

std::shared_ptr<SkyViewArguments> add_directions(Verb verb, const figure::Option& option) {
    const auto arguments = std::make_shared<SkyViewArguments>();
    arguments->directions = static_cast<int>(option.value);
    arguments->raster.add_to(verb);
    verb.add_option("--directions", arguments->directions,
                    fmt::format("Number of azimuths around each post ({})", option.value))
        .check(in_range(option));
    return arguments;
}

}  // namespace

void add_sun_sky_view(Verb sun_verb) {
    const Verb verb = sun_verb.add_verb("sky-view", "Sky-view factor of each post, as a raster");
    const auto arguments = add_directions(verb, figure::kSkyDirections);
    verb.add_flag("--level", arguments->level,
                  "For a level plane at each post instead of the inclined ground");
    verb.callback([arguments] { run_sky_view(*arguments); });
}

void add_sun_horizons(Verb sun_verb) {
    const Verb verb =
        sun_verb.add_verb("horizons", "Horizon of each post, one band for each azimuth");
    const auto arguments = add_directions(verb, figure::kHorizonDirections);
    verb.callback([arguments] { run_horizons(*arguments); });
}

}  // namespace relevo::cli
