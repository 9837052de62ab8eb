#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <memory>
#include <new>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/scene_arguments.h"
#include "dem/files_of.h"
#include "session/session.h"

namespace relevo::cli {
namespace {

struct Arguments {
    SceneArguments scene;
    std::string output, device = "auto", timings, dump_shaders, save_scene;
    std::vector<std::string> ab;
    int repeat = 0;
    bool overwrite = false, no_legend = false;
};

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point began) {
    return std::chrono::duration<double, std::milli>(Clock::now() - began).count();
}

/// What each stage of the run took, and the further frames of --repeat.
class Timings {
  public:
    explicit Timings(OutputFile* file) : file_(file) {}

    bool wanted() const { return file_ != nullptr; }
    render::PassTimes* passes() { return file_ ? &passes_ : nullptr; }
    void add(const std::string& stage, double took_ms) { stages_[stage] = took_ms; }

    void write(session::Session& session, int repeat) {
        if (!file_) return;
        nlohmann::ordered_json json;
        json["device"] = session.device().renderer;
        json["triangles"] = session.triangles();
        json["stages_ms"] = stages_;
        json["whole_ms"] = milliseconds_since(began_);
        nlohmann::ordered_json& passes = json["passes_ms"] = nlohmann::ordered_json::object();
        for (const auto& [name, ms] : passes_)
            passes[name] = ms;
        if (repeat > 0) {
            json["frames"] = frames(session, repeat, 0);
            json["frames_with_sun_moved"] = frames(session, repeat, kSunStep_s);
        }
        file_->write(json_text(json));
    }

  private:
    static constexpr double kSunStep_s = 60;

    /// @param step_s  by which the sun moves before each frame
    static nlohmann::ordered_json frames(session::Session& session, int repeat, double step_s) {
        std::vector<double> frames_ms;
        const std::clock_t processor_began = std::clock();
        for (int i = 0; i < repeat; ++i) {
            const auto began = Clock::now();
            if (step_s > 0) session.set_moment(session.moment() + step_s);
            session.draw_alone();
            frames_ms.push_back(milliseconds_since(began));
        }
        const double processor_ms =
            1e3 * static_cast<double>(std::clock() - processor_began) / CLOCKS_PER_SEC;
        std::sort(frames_ms.begin(), frames_ms.end());
        return {{"count", frames_ms.size()},
                {"min_ms", frames_ms.front()},
                {"median_ms", frames_ms[frames_ms.size() / 2]},
                {"max_ms", frames_ms.back()},
                {"processor_ms", processor_ms / static_cast<double>(frames_ms.size())}};
    }

    OutputFile* file_;
    Clock::time_point began_ = Clock::now();
    nlohmann::ordered_json stages_ = nlohmann::ordered_json::object();
    render::PassTimes passes_;
};

/// Reads the picture back and encodes it.
template <typename Picture>
void write_picture(OutputFile& file, const image::Metadata& metadata, Timings& timings,
                   const Picture& picture_of) {
    const auto readback_began = Clock::now();
    const auto picture = picture_of();
    timings.add("readback", milliseconds_since(readback_began));
    const auto write_began = Clock::now();
    image::write(file, picture, metadata);
    timings.add("write", milliseconds_since(write_began));
}

/// Into the upper right corner, as large as the picture has room for.
void add_legend(const chart::Legend& about, image::Image8& picture) {
    constexpr double kUsual_px = 1024, kMargin = 12;
    const chart::Drawing drawing = chart::legend(about);
    const double scale = std::clamp(std::min(picture.width, picture.height) / kUsual_px, 0.5, 8.0);
    const int x = static_cast<int>(picture.width - scale * (drawing.width() + kMargin));
    chart::paint(drawing, x, static_cast<int>(scale * kMargin), scale, picture);
}

void capture(const Arguments& arguments) {
    const std::filesystem::path output = arguments.output;
    const scene::Scene scene = arguments.scene.scene();
    image::check_format(output, scene.width_px, scene.height_px);
    FilesInUse files;
    if (!arguments.scene.file.empty()) files.add_input(arguments.scene.file, "the scene");
    dem::add_named(scene.dems, files);  // before any output is opened
    const auto open = [&](const std::string& path, const char* who) {
        return path.empty() ? nullptr : &files.open_output(path, arguments.overwrite, who);
    };
    OutputFile& picture_file = *open(arguments.output, "image");
    Timings timings(open(arguments.timings, "--timings"));
    OutputFile* const scene_file = open(arguments.save_scene, "--save-scene");

    session::Options options{.device = arguments.device,
                             .radiance = image::holds_linear_light(output),
                             .compared = arguments.ab};
    if (!arguments.dump_shaders.empty())
        options.stitched = [&](const std::vector<render::ProgramText>& texts) {
            render::dump_programs(texts, arguments.dump_shaders, arguments.overwrite);
        };
    image::load_format(output);
    session::Session session(scene, options, files);
    for (const auto& [stage, took_ms] : session.stages())
        timings.add(stage, took_ms);

    const std::string where = session.place_text(), when = sun::to_iso(session.moment());
    const std::string sun = session.sun_text();
    std::string chosen = session.moment_reason();
    if (!chosen.empty()) chosen = "; no --time given" + chosen;
    if (const std::string view = session.view_reason(); !view.empty())
        chosen += "; by its relief " + view;
    log::info(fmt::format("{}, {}: sun at {}{}", where, when, sun, chosen));
    if (const std::string climate = session.climate_text(); !climate.empty())
        log::info(fmt::format("natural ground of a normal year, in the DEM's middle: {}", climate));
    for (const std::string& note : session.ground_notes())
        log::info(note);
    const auto passes_began = Clock::now();
    session.draw(timings.passes());
    timings.add("passes", milliseconds_since(passes_began));

    const image::Metadata metadata{
        {"Software", "Relevo " RELEVO_VERSION},
        {"Description", fmt::format("{}; {}; sun at {}", where, when, sun)}};
    if (options.radiance)
        write_picture(picture_file, metadata, timings, [&] { return session.radiance(); });
    else
        write_picture(picture_file, metadata, timings, [&] {
            image::Image8 picture = session.picture();
            if (session.legend() && !arguments.no_legend) add_legend(*session.legend(), picture);
            return picture;
        });
    if (scene_file)
        scene_file->write(scene::scene_text(
            session.scene(), std::filesystem::path(arguments.save_scene).parent_path()));
    timings.write(session, arguments.repeat);
    files.finish_outputs();
}

}  // namespace

void add_capture(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    CLI::App& verb = *app.add_subcommand("capture", "Takes one picture");
    arguments->scene.add_to(verb);
    verb.add_option("-o,--output", arguments->output,
                    "Picture to write: png, jpg, webp, tif, or exr in linear light")
        ->required();
    verb.add_flag("--overwrite", arguments->overwrite, "Replace existing files");
    verb.add_flag("--no-legend", arguments->no_legend, "Leave the overlay's legend out")
        ->group("Overlay");
    verb.add_option("--save-scene", arguments->save_scene, "Write what is drawn as a scene, JSON");
    verb.add_option("--ab", arguments->ab,
                    "Compare: the left half with these effects, the right half without them")
        ->delimiter(',')
        ->group("Effects");
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
            failed(fmt::format(
                "capture: --size {}: not enough memory for the picture and the DEM; "
                "use a smaller --size or --memory",
                arguments->scene.size.empty() ? "1280x1024" : printable(arguments->scene.size)));
        }
    });
}

}  // namespace relevo::cli
