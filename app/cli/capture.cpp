#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <future>
#include <memory>
#include <new>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "base/units.h"
#include "cli/commands.h"
#include "cli/effects.h"
#include "cli/not_numbers.h"
#include "cli/shared.h"
#include "geo/format.h"
#include "render/ground.h"
#include "render/renderer.h"
#include "scene/moment.h"
#include "sun/celestial.h"
#include "sun/position.h"

namespace relevo::cli {
namespace {

struct Arguments {
    DemArguments dem;
    TimeArguments time;
    RefractionArguments refraction;
    ViewArguments view;
    EffectArguments effects;
    std::string output, size = "1280x1024", device = "auto", timings, dump_shaders;
    std::vector<std::string> ab;
    double exposure_ev = 0;
    double pixel_error = render::TerrainOptions{}.pixel_error;
    int repeat = 0;
    bool overwrite = false;
};

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double, std::milli>(to - from).count();
}

/// What each stage took. Loading goes on beside the start of the device, so that the stages' sum is
/// more than the whole.
class Timings {
  public:
    void add(const std::string& stage, Clock::time_point began) {
        add(stage, milliseconds(began, Clock::now()));
    }
    void add(const std::string& stage, double took_ms) { stages_[stage] = took_ms; }

    /// @param processor_ms  of all threads, for all frames
    void write(OutputFile& file, const render::PassTimes& passes, std::vector<double> frames_ms,
               double processor_ms, int triangles, const gl::DeviceInfo& device) {
        nlohmann::ordered_json json;
        json["device"] = device.renderer;
        json["triangles"] = triangles;
        json["stages_ms"] = stages_;
        json["whole_ms"] = milliseconds(began_, Clock::now());
        nlohmann::ordered_json& pass_json = json["passes_ms"] = nlohmann::ordered_json::object();
        for (const auto& [name, ms] : passes)
            pass_json[name] = ms;
        if (!frames_ms.empty()) {
            std::sort(frames_ms.begin(), frames_ms.end());
            json["frames"] = {
                {"count", frames_ms.size()},
                {"min_ms", frames_ms.front()},
                {"median_ms", frames_ms[frames_ms.size() / 2]},
                {"max_ms", frames_ms.back()},
                {"processor_ms", processor_ms / static_cast<double>(frames_ms.size())}};
        }
        file.write(json_text(json));
        file.finish();
    }

  private:
    Clock::time_point began_ = Clock::now();
    nlohmann::ordered_json stages_ = nlohmann::ordered_json::object();
};

/// The DEM, and how long it took.
struct Loaded {
    dem::Source source;
    dem::Heightfield field;
    double took_ms = 0;
};

constexpr int kDivider_px = 2;

/// Puts the left half of one picture beside the right half of the other, with a line between.
template <typename Picture, typename Value>
Picture side_by_side(const Picture& left, const Picture& right, Value line) {
    Picture both = right;
    const int first = std::max((left.width - kDivider_px) / 2, 0) * left.channels;
    const int last = std::min(left.width * left.channels, first + kDivider_px * left.channels);
    for (int y = 0; y < left.height; ++y) {
        std::copy_n(left.row(y), first, both.row(y));
        std::fill(both.row(y) + first, both.row(y) + last, line);
    }
    return both;
}

/// The sun that is told of, and from where.
struct SunSeen {
    std::string from, sun;
};

/// As `relevo sun position` has it for the eye's place and height.
SunSeen seen_from_eye(const render::FrameInputs& inputs, const render::Ground& ground,
                      sun::Instant utc, const RefractionArguments& refraction) {
    geo::Geodetic eye = ground.frame.to_geodetic(inputs.camera.eye_m);
    eye.height_m /= inputs.exaggeration;
    return {geo::degrees_text(eye) + " (the eye)",
            sun_text(sun::position(utc, eye), refraction.at(eye))};
}

void capture(const Arguments& arguments) {
    Timings timings;
    const std::filesystem::path output = arguments.output;
    const glm::ivec2 size = parse_size(arguments.size);
    image::check_format(output, size.x, size.y);
    FilesInUse files;
    arguments.dem.add_inputs(files);
    OutputFile& picture_file = files.open_output(output, arguments.overwrite, "image");
    const bool timed = !arguments.timings.empty();
    OutputFile* const timings_file =
        timed ? &files.open_output(arguments.timings, arguments.overwrite, "--timings") : nullptr;
    arguments.dem.add_further_inputs(files);
    const scene::View view = arguments.view.view_of();
    std::optional<sun::ParsedTime> given_time;
    if (arguments.time.given() && !arguments.time.needs_dem()) given_time = arguments.time.parse();

    // The DEM is read on a thread of its own while the device starts and the programs are compiled.
    // Where the system gives no further thread it is read when it is waited for.
    auto loading = std::async(std::launch::async | std::launch::deferred, [&] {
        const auto began = Clock::now();
        dem::Source source = dem::Source::open(arguments.dem.paths, arguments.dem.options);
        dem::Heightfield field = dem::load(source, arguments.dem.options.max_posts);
        return Loaded{std::move(source), std::move(field), milliseconds(began, Clock::now())};
    });
    image::load_format(output);
    const auto device_began = Clock::now();
    const bool compared = !arguments.ab.empty();
    const std::unique_ptr<ActiveEffects> effects =
        (compared ? arguments.effects.with(arguments.ab) : arguments.effects).active();
    const std::unique_ptr<ActiveEffects> others =
        compared ? arguments.effects.without(arguments.ab, *effects).active(/*aloud=*/false)
                 : nullptr;
    effects->add_inputs(files);
    gl::Context context({.device = arguments.device});
    effects->fit(context.info());
    if (compared) others->fit(context.info(), /*aloud=*/false);
    timings.add("device", device_began);
    const auto compile_began = Clock::now();
    render::RendererOptions options{
        .width_px = size.x, .height_px = size.y, .radiance = image::holds_linear_light(output)};
    if (!arguments.dump_shaders.empty())
        options.stitched = [&](const std::vector<render::ProgramText>& texts) {
            render::dump_programs(texts, arguments.dump_shaders, arguments.overwrite);
        };
    render::Renderer renderer(context, effects->inputs(), options);
    options.stitched = nullptr;
    std::optional<render::Renderer> without;
    if (compared) without.emplace(context, others->inputs(), options);
    timings.add("compile", compile_began);
    const Loaded loaded = loading.get();
    const dem::Source& source = loaded.source;
    const dem::Heightfield& dem = loaded.field;
    timings.add("load", loaded.took_ms);
    if (arguments.time.given() && !given_time) given_time = arguments.time.parse_over(source, dem);

    const auto upload_began = Clock::now();
    const render::Ground ground = render::make_ground(dem);
    render::Terrain terrain(
        dem, ground.frame,
        {.pixel_error = arguments.pixel_error, .max_array_layers = context.info().max_array_layers},
        &source);
    timings.add("upload", upload_began);

    const geo::Geodetic place = ground.frame.origin();
    const sun::Instant utc = given_time ? given_time->utc : scene::default_moment(place);
    const sun::Position position = sun::position(utc, place);
    const sun::Refraction air =
        arguments.refraction.at({place.lat_rad, place.lon_rad, ground.air_height_m()});

    render::FrameInputs inputs;
    inputs.sun = render::make_sun_light(position, air, ground, dem.grid);
    inputs.stars = sun::celestial_frame(sun::Epoch::at(utc), place);
    inputs.exposure_ev = arguments.exposure_ev;
    inputs.unix_s = static_cast<double>(utc.unix_us()) * 1e-6;
    inputs.exaggeration = arguments.view.exaggeration;
    const auto ground_height_m = [&](const geo::Geodetic& at) {
        if (dem.reduction > 1) return source.height_at(at);
        const glm::dvec2 post = dem.grid.post(at);
        return dem.height_at(post.x, post.y);
    };
    const auto points = render::points_to_show(dem, ground, inputs.exaggeration);
    inputs.camera = scene::make_camera(
        view, ground_height_m, ground.frame, points, static_cast<double>(size.x) / size.y,
        inputs.exaggeration,
        render::points_moved_to(points, ground, inputs.exaggeration, renderer.displacement()));

    const SunSeen seen = view.eye ? seen_from_eye(inputs, ground, utc, arguments.refraction)
                                  : SunSeen{geo::degrees_text(place), sun_text(position, air)};
    log::info(fmt::format("{}, {}: sun at {}{}", seen.from, sun::to_iso(utc), seen.sun,
                          given_time ? "" : "; no --time given, so a summer morning was taken"));

    render::PassTimes passes;
    const auto passes_began = Clock::now();
    renderer.render_frame(terrain, ground, inputs, timed ? &passes : nullptr);
    timings.add("passes", passes_began);
    if (without) without->render_frame(terrain, ground, inputs);

    const image::Metadata metadata{
        {"Software", "Relevo " RELEVO_VERSION},
        {"Description", fmt::format("{}; {}; sun at {}", seen.from, sun::to_iso(utc), seen.sun)}};
    int not_numbers = 0, others_not_numbers = 0;
    const auto check_numbers = [&] {
        if (not_numbers > 0)
            refuse_not_numbers({arguments.effects, *effects, context, options, terrain, ground,
                                inputs, not_numbers});
        if (others_not_numbers > 0)
            refuse_not_numbers({arguments.effects, *others, context, options, terrain, ground,
                                inputs, others_not_numbers});
    };
    const auto readback_began = Clock::now();
    if (image::holds_linear_light(output)) {
        image::ImageF picture = renderer.read_radiance(&not_numbers);
        if (without)
            picture = side_by_side(picture, without->read_radiance(&others_not_numbers), 0.0f);
        check_numbers();
        timings.add("readback", readback_began);
        const auto write_began = Clock::now();
        image::write(picture_file, picture, metadata);
        timings.add("write", write_began);
    } else {
        image::Image8 picture = renderer.read_picture(&not_numbers);
        if (without)
            picture = side_by_side(picture, without->read_picture(&others_not_numbers),
                                   std::uint8_t{255});
        check_numbers();
        timings.add("readback", readback_began);
        const auto write_began = Clock::now();
        image::write(picture_file, picture, metadata);
        timings.add("write", write_began);
    }

    if (timed) {
        std::vector<double> frames_ms;
        const std::clock_t processor_began = std::clock();
        for (int i = 0; i < arguments.repeat; ++i) {
            const auto began = Clock::now();
            renderer.render_frame(terrain, ground, inputs);
            context.finish();
            frames_ms.push_back(milliseconds(began, Clock::now()));
        }
        const double processor_ms =
            1e3 * static_cast<double>(std::clock() - processor_began) / CLOCKS_PER_SEC;
        timings.write(*timings_file, passes, frames_ms, processor_ms, renderer.triangles(),
                      context.info());
    }
}

}  // namespace

void add_capture(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    CLI::App& verb = *app.add_subcommand("capture", "Takes one picture");
    arguments->dem.add_to(verb);
    verb.add_option("-o,--output", arguments->output,
                    "Picture to write: png, jpg, webp, tif, or exr in linear light")
        ->required();
    verb.add_option("--size", arguments->size, "Width and height in pixels, 1280x1024");
    verb.add_flag("--overwrite", arguments->overwrite, "Replace existing files");
    arguments->time.add_to(verb);
    arguments->refraction.add_to(verb);
    arguments->view.add_to(verb);
    arguments->effects.add_to(verb);
    verb.add_option("--ab", arguments->ab,
                    "Compare: the left half with these effects, the right half without them")
        ->delimiter(',')
        ->group("Effects");
    verb.add_option("--exposure", arguments->exposure_ev, "Stops brighter than natural, EV")
        ->check(in_range(-20.0, 20.0));
    verb.add_option("--pixel-error", arguments->pixel_error,
                    "Largest error of the ground's shape in the picture, pixels; 0 draws every "
                    "post")
        ->check(in_range(0.0, 100.0));
    verb.add_option("--device", arguments->device,
                    "GL device: auto, an index, software, or a part of its name");
    CLI::Option* timings =
        verb.add_option("--timings", arguments->timings, "Write what each stage took, as JSON")
            ->group("Diagnosis");
    verb.add_option("--repeat", arguments->repeat, "Further frames to time")
        ->needs(timings)
        ->check(whole_number())
        ->check(CLI::NonNegativeNumber)
        ->group("Diagnosis");
    verb.add_option("--dump-shaders", arguments->dump_shaders,
                    "Write the stitched programs into a folder")
        ->group("Diagnosis");
    verb.callback([arguments] {
        try {
            capture(*arguments);
        } catch (const std::bad_alloc&) {
            failed(
                fmt::format("capture: --size {}: not enough memory for the picture and the DEM; "
                            "use a smaller --size or --memory",
                            printable(arguments->size)));
        }
    });
}

}  // namespace relevo::cli
