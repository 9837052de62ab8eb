#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "base/units.h"
#include "cli/sun.h"
#include "cli/sun_rasters.h"
#include "light/raster/horizons.h"
#include "session/sun_raster.h"

namespace relevo::cli {
namespace {

struct SkyViewArguments {
    RasterArguments raster;
    int directions = session::kSkyDirections;
    bool level = false;
};

std::vector<double> azimuths_of(int directions) {
    std::vector<double> azimuth_rad;
    for (int i = 0; i < directions; ++i)
        azimuth_rad.push_back(2 * kPi * i / directions);
    return azimuth_rad;
}

void warn_of_beyond(RasterRun& raster, const SkyViewArguments& arguments, const dem::Posts& posts) {
    raster.warn_of(
        [&](const dem::Window& window) {
            return light::terrain_beyond(posts, window, azimuths_of(arguments.directions),
                                         arguments.raster.terrestrial_refraction,
                                         arguments.raster.highest_m);
        },
        light::kStandsOver);
}

void run_sky_view(const SkyViewArguments& arguments) {
    FilesInUse files;
    OutputFile* const file = arguments.raster.open(files);
    const RasterGround ground = arguments.raster.load();
    const double refraction = arguments.raster.terrestrial_refraction;
    RasterRun raster(arguments.raster, file, files, ground,
                     {.type = output::RasterType::Float,
                      .bands = {session::sky_view_band()},
                      .metadata = {{"DIRECTIONS", fmt::format("{}", arguments.directions)}},
                      .calls = 1,
                      .bytes_a_post = 22,
                      .halo_m = light::horizon_reach_m(ground.posts, refraction)});
    if (raster.is_done()) return;
    warn_of_beyond(raster, arguments, ground.posts);
    light::SkyViewOptions options{.directions = arguments.directions,
                                  .refraction = refraction,
                                  .level = arguments.level,
                                  .part = {},
                                  .done = raster.done()};
    double sum = 0, posts = 0;
    std::string definition;
    const auto maker_of = [&](const dem::Posts& of, const dem::Posts* around,
                              const dem::Window& window) -> PartMaker {
        const auto plan = std::make_shared<light::SunPlan>(of, light::LightPath{refraction, {}},
                                                           window, false, around);
        light::add_sky_view_directions(*plan, options.directions);
        return [&, plan](const dem::Window& part) -> PartFigures {
            options.part = part;
            const light::SkyView view = light::sky_view(*plan, options);
            const auto seen =
                static_cast<double>(view.share.size()) - static_cast<double>(view.holes);
            if (seen > 0) sum += view.mean * seen;
            posts += seen;
            definition = view.definition;
            raster.put(0, part, view.share);
            return {view.holes, view.definition};
        };
    };
    if (!raster.make_all(maker_of)) return;
    fmt::print("sky view            mean {:.4f}\n\n{}\n", sum / std::max(1.0, posts), definition);
}

void run_horizons(const SkyViewArguments& arguments) {
    FilesInUse files;
    OutputFile* const file = arguments.raster.open(files);
    const RasterGround ground = arguments.raster.load();
    const double refraction = arguments.raster.terrestrial_refraction;
    const std::vector<double> azimuth_rad = azimuths_of(arguments.directions);
    std::vector<output::RasterBand> bands;
    for (const double azimuth : azimuth_rad) {
        const std::string azimuth_deg = fmt::format("{:.10g}", degrees(azimuth));
        bands.push_back(
            {"horizon towards azimuth " + azimuth_deg, "deg", {{"AZIMUTH_DEG", azimuth_deg}}});
    }
    RasterRun raster(arguments.raster, file, files, ground,
                     {.type = output::RasterType::Float,
                      .bands = bands,
                      .metadata = {},
                      .calls = azimuth_rad.size(),
                      .bytes_a_post = 12,
                      .halo_m = light::horizon_reach_m(ground.posts, refraction)});
    if (raster.is_done()) return;
    warn_of_beyond(raster, arguments, ground.posts);
    const std::function<void(double)> done = raster.done();
    const std::string definition = light::horizons_definition(refraction);
    const auto maker_of = [&](const dem::Posts& of, const dem::Posts* around,
                              const dem::Window& window) -> PartMaker {
        const auto plan = std::make_shared<light::SunPlan>(of, light::LightPath{refraction, {}},
                                                           window, false, around);
        light::add_horizon_directions(*plan, azimuth_rad);
        return [&, plan](const dem::Window& part) -> PartFigures {
            std::int64_t holes = 0;
            for (std::size_t k = 0; k < azimuth_rad.size(); ++k) {
                Array2d<float> elevation = light::horizon_elevations(*plan, plan->suns()[k], part);
                for (float& value : elevation) {
                    if (k == 0) holes += std::isnan(value);
                    value = static_cast<float>(degrees(double{value}));
                }
                raster.put(k, part, elevation);
                done(1);
            }
            return {holes, definition};
        };
    };
    if (!raster.make_all(maker_of)) return;
    fmt::print("horizons            {} directions, {:.10g} degrees apart, from true north\n\n{}\n",
               arguments.directions, 360.0 / arguments.directions, definition);
}

std::shared_ptr<SkyViewArguments> add_directions(Verb verb, int least, int most) {
    const auto arguments = std::make_shared<SkyViewArguments>();
    arguments->raster.add_to(verb);
    verb.add_option("--directions", arguments->directions,
                    "Number of azimuths around each post (36)")
        .check(in_range(least, most));
    return arguments;
}

}  // namespace

void add_sun_sky_view(Verb sun_verb) {
    const Verb verb = sun_verb.add_verb("sky-view", "Sky-view factor of each post, as a raster");
    const auto arguments = add_directions(verb, 4, 3600);
    verb.add_flag("--level", arguments->level,
                  "For a level plane at each post instead of the inclined ground");
    verb.callback([arguments] { run_sky_view(*arguments); });
}

void add_sun_horizons(Verb sun_verb) {
    const Verb verb =
        sun_verb.add_verb("horizons", "Horizon of each post, one band for each azimuth");
    const auto arguments = add_directions(verb, 1, 720);
    verb.callback([arguments] { run_horizons(*arguments); });
}

}  // namespace relevo::cli
