#include <algorithm>
#include <functional>
#include <memory>

#include <fmt/format.h>

#include "cli/sun.h"
#include "cli/sun_rasters.h"
#include "figure/horizons.h"

namespace relevo::cli {
namespace {

template <typename Figure>
struct Arguments {
    RasterArguments raster;
    Figure figure;

    /// @param say  what came of it; is called if files were made
    void make(const std::function<void(const dem::Posts&)>& say) const {
        FilesInUse files;
        OutputFile* const file = raster.open(files);
        const figure::RasterGround ground = raster.load();
        if (raster.make(file, files, ground, figure)) say(ground.posts);
    }
};

void run(Arguments<figure::SkyView>& arguments) {
    double sum = 0, posts = 0;
    std::string definition;
    arguments.figure.seen = [&](const light::SkyView& part) {
        const auto seen = static_cast<double>(part.share.size()) - static_cast<double>(part.holes);
        if (seen > 0) sum += part.mean * seen;
        posts += seen;
        definition = part.definition;
    };
    arguments.make([&](const dem::Posts&) {
        fmt::print("sky view            mean {:.4f}\n\n{}\n", sum / std::max(1.0, posts),
                   definition);
    });
}

void run(Arguments<figure::Horizons>& arguments) {
    const figure::Horizons& figure = arguments.figure;
    arguments.make([&](const dem::Posts& posts) {
        fmt::print(
            "horizons            {} directions, {:.10g} degrees apart, from true north\n\n{}\n",
            figure.directions, 360.0 / figure.directions,
            light::horizons_definition(posts, figure.terrestrial_refraction));
    });
}

template <typename Figure>
Figure& add(Verb verb, const figure::Option& directions) {
    const auto arguments = std::make_shared<Arguments<Figure>>();
    arguments->raster.add_to(verb, arguments->figure);
    add_number(verb, directions, arguments->figure.directions);
    verb.callback([arguments] { run(*arguments); });
    return arguments->figure;
}

}  // namespace

void add_sun_sky_view(Verb sun_verb) {
    const Verb verb = sun_verb.add_verb("sky-view", "Sky-view factor of each post, as a raster");
    verb.add_flag("--level", add<figure::SkyView>(verb, figure::kSkyDirections).level,
                  "For a level plane at each post instead of the inclined ground");
}

void add_sun_horizons(Verb sun_verb) {
    add<figure::Horizons>(
        sun_verb.add_verb("horizons", "Horizon of each post, one band for each azimuth"),
        figure::kHorizonDirections);
}

}  // namespace relevo::cli
