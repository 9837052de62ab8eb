#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <future>
#include <memory>
#include <new>
#include <thread>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/folder_watch.h"
#include "base/held_notices.h"
#include "base/log.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/exaggeration_argument.h"
#include "cli/format_arguments.h"
#include "cli/scene_arguments.h"
#include "cli/timings.h"
#include "dem/files_of.h"
#include "effect/search_path.h"
#include "geo/format.h"
#include "scene/panorama.h"
#include "scene/sheet.h"
#include "scene/stereo.h"
#include "session/batch.h"
#include "session/picture_file.h"
#include "session/record.h"
#include "session/scene_times.h"
#include "session/session.h"

namespace relevo::cli {
namespace {

struct CaptureArguments {
    SceneArguments scene;
    ExaggerationArgument exaggeration;
    FormatArguments format;
    std::string output, device = "auto", timings, dump_shaders, save_scene, from;
    std::vector<std::string> ab;
    int repeat = 0;
    bool overwrite = false, sidecar = false, audit = false, allow_blank = false, watch = false;
};

/// What is to be drawn.
struct Wanted {
    scene::Scene scene;
    std::vector<std::string> compared;
};

Wanted wanted(const CaptureArguments& arguments) {
    if (arguments.from.empty()) return {arguments.scene.scene(), arguments.ab};
    if (!arguments.scene.file.empty()) bad_usage("--scene and --from exclude each other; use one");
    const image::Metadata metadata = session::read_record(arguments.from);
    const auto text = metadata.find(session::kSceneKeyword);
    if (text == metadata.end())
        bad_input(
            fmt::format("--from: {}: contains no scene; expected a picture of relevo capture or "
                        "run with its metadata",
                        printable(arguments.from)));
    const std::filesystem::path path = arguments.from;
    Wanted result{scene::read_scene_text(text->second, path.string(), path.parent_path()),
                  arguments.ab};
    arguments.scene.apply_to(result.scene);
    session::Trust trusted(arguments.scene.named(), "--from: " + printable(path.string()),
                           session::NamedBy::Picture);
    trusted.check_names(result.scene);
    trusted.keep_folders(result.scene.effects);
    trusted.tell();
    const auto compared = metadata.find(session::kComparedKeyword);
    if (compared != metadata.end() && arguments.ab.empty())
        result.compared = split(compared->second, ',');
    return result;
}

/// "21 June 2026 16:34", local time of the scene's zone.
std::string local_time(const session::Session& session) {
    constexpr std::array kMonths = {"January",   "February", "March",    "April",
                                    "May",       "June",     "July",     "August",
                                    "September", "October",  "November", "December"};
    const std::string text = session.clock_text();  // 2026-06-21 16:34 UTC-04:00
    const sun::Date date = sun::parse_date(text.substr(0, 10));
    return fmt::format("{} {} {} {}", date.day, kMonths[static_cast<std::size_t>(date.month - 1)],
                       date.year, text.substr(11, 5));
}

/// What the program chose because the command line does not say it, in one line.
void report_chosen(const session::Session& session, bool chose_exaggeration) {
    const bool time = !session.time_reason().empty(), view = !session.view_reason().empty();
    if (!time && !view) return;
    const std::optional<double> azimuth_deg = session.scene().view.orbit.azimuth_deg;
    const auto& overlay = session.overlay_time();
    const char* const whose = overlay && overlay->utc ? " (the overlay's)" : "";
    std::string text = "chosen: " + (time ? local_time(session) + whose : "");
    if (view && azimuth_deg)
        text += fmt::format("{}seen from the {}", time ? ", " : "",
                            geo::compass_point(std::fmod(*azimuth_deg + 360, 360)));
    if (chose_exaggeration) text += fmt::format(", heights × {:g}", session.scene().exaggeration);
    log::info(text + (chose_exaggeration ? "; --time, --view and --exaggerate set others"
                      : time && view     ? "; --time and --view set others"
                      : time             ? "; --time sets another"
                                         : "; --view sets another"));
}

/// Place, time, sun and the assumptions about the ground.
void report_scene(const session::Session& session) {
    log::debug(fmt::format("{}, {}: sun at {}", session.place_text(), sun::to_iso(session.time()),
                           session.sun_text()));
    for (const std::string& reason : {session.time_reason(), session.view_reason()})
        if (!reason.empty()) log::debug(reason);
    if (const std::string climate = session.climate_text(); !climate.empty())
        log::debug(
            fmt::format("natural ground at the centre of the DEM, in a year of mean "
                        "climate: {}",
                        climate));
    for (const std::string& note : session.ground_notes())
        log::info(note);
}

void check_shows_ground(const CaptureArguments& arguments, const session::Session& session) {
    if (!arguments.allow_blank && !session.shows_ground())
        failed("capture: the picture shows only sky; turn the camera or add --allow-blank");
}

// In one piece: the stages of a picture in their order.
void capture(const CaptureArguments& arguments) {
    log::HeldNotices notices;
    const std::filesystem::path output = arguments.format.named(arguments.output);
    const image::Encoding encoding = arguments.format.encoding(arguments.output);
    session::PictureFormat format = arguments.format.picture();
    format.map_alone = scene::is_pdf(output);
    auto [scene, compared] = wanted(arguments);
    arguments.exaggeration.apply_to(scene,
                                    !arguments.scene.file.empty() || !arguments.from.empty());
    const bool linear = image::holds_linear_light(output);
    if (contains(split(arguments.scene.stamps, ','), "all") && scene::is_from_above(scene.view))
        scene.stamps.margin = true;  // a map sheet
    const bool stamped = scene.stamps != scene::Stamps();
    if (linear) scene.stamps.margin = false;  // without stamps
    scene::check_panorama(scene);
    scene::check_stereo(scene);
    scene::check_sheet(scene, output);
    // What is measured in a picture has its true heights.
    if (arguments.audit || !format.layers.empty() || linear) scene.chooses_exaggeration = false;
    session::SceneTimes times;
    times.fit_map(scene);
    if (arguments.audit && !compared.empty())
        bad_usage("--audit: cannot audit a comparison; remove --ab");
    image::check_encoding(output, encoding,
                          {.width_px = scene.width_px,
                           .height_px = scene.height_px,
                           .alpha = scene.transparent,
                           .layers = !format.layers.empty()});
    const bool in_bands = session::needs_bands(scene, format, linear);
    if (in_bands) {
        image::check_bands(output);
        session::check_in_bands(scene, linear);
    }
    if (in_bands && (arguments.audit || !compared.empty()))
        bad_usage("--audit and --ab need a picture of less than 1 GiB; use a smaller --size");
    FilesInUse files;
    if (!arguments.scene.file.empty()) files.add_input(arguments.scene.file, "the scene");
    if (!arguments.from.empty()) {
        files.add_input(arguments.from, "the picture");
        const std::filesystem::path beside = session::sidecar_of(arguments.from);
        std::error_code ignored;
        if (std::filesystem::exists(beside, ignored)) files.add_input(beside, "its sidecar");
    }
    dem::add_named(scene.dems, files);  // before any output is opened
    if (!scene.weather_file.empty()) files.add_input(scene.weather_file, "the weather");
    const auto open = [&](const std::string& path, const char* who) {
        return path.empty() ? nullptr : &files.open_output(path, arguments.overwrite, who);
    };
    OutputFile& picture_file = *open(to_file(arguments.output), "image");
    Timings timings(open(arguments.timings, "--timings"));
    OutputFile* const scene_file = open(arguments.save_scene, "--save-scene");
    scene::Scene hashed = scene::with_absolute_paths(scene);
    const session::SceneIn scene_in = session::scene_in(output, hashed);
    const bool sidecar =
        arguments.sidecar || arguments.audit || scene_in == session::SceneIn::Sidecar;
    const std::vector<std::filesystem::path> beside = session::files_beside(scene, output);
    if (arguments.format.is_standard_output(arguments.output) && !beside.empty())
        bad_usage(
            "-o -: the place of a map is in a file next to it; name a file, or add --format tif");
    if (!arguments.format.is_standard_output(arguments.output))
        session::warn_of_files_beside(scene, output);
    if (arguments.format.is_standard_output(arguments.output) && (sidecar || arguments.watch))
        bad_usage(
            "-o -: --sidecar, --audit, --watch and scenes that are too long for the format "
            "need a file; name one");
    OutputFile* const sidecar_file =
        open(sidecar ? session::sidecar_to_write(output).string() : "", "--sidecar");
    std::vector<OutputFile*> beside_files;
    for (const std::filesystem::path& path : beside)
        beside_files.push_back(open(path.string(), "--ortho"));

    session::Options options{.device = arguments.device,
                             .source = scene.ortho ? times.source(scene) : nullptr,
                             .radiance = linear,
                             .format = format,
                             .audited = arguments.audit,
                             .compared = compared};
    if (!arguments.dump_shaders.empty())
        options.stitched = [&](const render::StitchedFrames& frames) {
            render::dump_programs(frames, arguments.dump_shaders, arguments.overwrite);
        };
    image::load_format(output);
    session::SceneInputs inputs(RELEVO_VERSION);
    // Hashes files while a session opens. What is wrong with the scene the session says.
    hashed.effects = session::with(std::move(hashed.effects), compared);
    const auto recorded =
        std::async(std::launch::async | std::launch::deferred, [&] { inputs.record(hashed); });
    session::Session session(scene, options, files);
    for (const auto& [stage, took_ms] : session.stages())
        timings.add(stage, took_ms);

    report_scene(session);
    const auto passes_began = Clock::now();
    std::optional<image::Picture> picture;
    if (!in_bands) picture = session.make_picture(timings.passes());
    timings.add_picture(milliseconds_since(passes_began));

    recorded.wait();
    const image::Metadata metadata =
        session::metadata_of(session, inputs, scene_in, session::format_text(encoding, format));
    const auto write_began = Clock::now();
    if (picture) check_shows_ground(arguments, session);
    session::write_picture(session, picture, picture_file, metadata, encoding);
    if (!picture) check_shows_ground(arguments, session);
    if (const auto where = session::georeference_of(session))
        session::write_beside(beside_files, *where);
    timings.add("write", milliseconds_since(write_began));
    for (const std::string& note : session.stamp_notes())
        log::info(note);
    if (linear && stamped) log::info("--stamp has no effect: EXR has linear light without stamps");
    if (scene_file)
        scene_file->write(scene::scene_text(
            session.scene(), std::filesystem::path(arguments.save_scene).parent_path()));
    std::optional<session::ShadowAudit> audit;
    if (arguments.audit) audit = session::audit_shadows(session);
    if (sidecar_file)
        sidecar_file->write(
            session::sidecar_text(session, inputs, output.filename().string(), audit));
    if (scene_in == session::SceneIn::Sidecar) log::warning(session::says_where_scene_is(output));
    timings.write(session, arguments.repeat);
    files.finish_outputs();
    notices.release();
    if (audit) log::info(audit->text());
    report_chosen(session, scene.chooses_exaggeration && session.scene().exaggeration != 1);
}

/// The folders of the plugins and of the presets that a picture is made from.
std::vector<std::filesystem::path> watched_folders(const scene::Effects& effects) {
    std::vector<std::filesystem::path> folders =
        effect::plugin_search_path({effects.plugin_path.begin(), effects.plugin_path.end()});
    for (const std::string& preset : effects.presets)
        if (effect::is_preset_file(preset))
            folders.push_back(std::filesystem::absolute(preset).parent_path());
    return folders;
}

/// Makes the picture, and again after each change of a plugin's file until the program is
/// interrupted. Mistakes are reported, and the picture waits for the next change.
void capture_and_watch(CaptureArguments arguments) {
    constexpr std::chrono::milliseconds kStep(200);
    const scene::Effects effects = wanted(arguments).scene.effects;
    FolderWatch watch;
    watch.watch(watched_folders(effects), {".json", ".glsl", ".so"});
    while (true) {
        try {
            capture(arguments);
            log::info(fmt::format("{} is written; waiting for changes of plugins, Ctrl+C ends",
                                  printable(arguments.output)));
            arguments.overwrite = true;  // what this command itself has written
        } catch (const Error& error) {
            if (error.code() == ErrorCode::Usage || error.code() == ErrorCode::NoDevice) throw;
            // No change of a plugin would end this mistake.
            if (!arguments.overwrite && std::filesystem::exists(arguments.output)) throw;
            log::error(error.what());
        }
        while (!watch.changed())
            std::this_thread::sleep_for(kStep);
    }
}

}  // namespace

void add_capture(Verb app) {
    const auto arguments = std::make_shared<CaptureArguments>();
    const Verb verb = app.add_verb("capture", "Makes one picture");
    arguments->exaggeration.add_to(verb);
    arguments->scene.add_to(verb);
    verb.add_option("-o,--output", arguments->output,
                    "Picture to write: png, jpg, webp, avif, tif, pdf (of --sheet), or exr (linear "
                    "light); - is standard output")
        .required();
    arguments->format.add_to(verb, /*with_format=*/true);
    verb.add_flag("--overwrite", arguments->overwrite, "Replace existing files");
    verb.add_option("--save-scene", arguments->save_scene, "Write the scene as JSON");
    verb.add_option_function(
        "--from",
        [arguments](const std::string& path) {
            arguments->from = path;
            arguments->scene.dem.dem_option.required(false);
        },
        "Make this picture again from the scene in it; other options override the scene");
    verb.add_flag("--sidecar", arguments->sidecar,
                  "Write a JSON sidecar: sun, camera, device, versions, DEM");
    verb.add_flag("--audit", arguments->audit,
                  "Compare the drawn shadows with the computed ones; implies --sidecar");
    verb.add_flag("--watch", arguments->watch,
                  "Write the picture again after each change of a plugin's file");
    verb.add_flag("--allow-blank", arguments->allow_blank, "Accept a picture that shows no ground");
    verb.add_option("--ab", arguments->ab,
                    "Comparison: left half with these effects, right half without")
        .delimiter(',')
        .group("Effects");
    verb.add_option("--device", arguments->device,
                    "GL device: auto, an index, software, or a part of its name");
    const Option timings =
        verb.add_option("--timings", arguments->timings, "Write the time of each stage as JSON")
            .group("Diagnosis");
    verb.add_option("--repeat", arguments->repeat, "Additional frames for --timings")
        .needs(timings)
        .check(whole_number())
        .check(in_range(0, 1e6))
        .group("Diagnosis");
    verb.add_option("--dump-shaders", arguments->dump_shaders,
                    "Write the generated shaders into a folder")
        .group("Diagnosis");
    verb.callback([arguments] {
        try {
            if (arguments->watch)
                capture_and_watch(*arguments);
            else
                capture(*arguments);
        } catch (const std::bad_alloc&) {
            failed(fmt::format(
                "capture: --size {}: not enough memory for the picture and the DEM; "
                "use a smaller --size or --memory",
                arguments->scene.size.empty() ? "1280x720" : printable(arguments->scene.size)));
        }
    });
}

}  // namespace relevo::cli
