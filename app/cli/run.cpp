#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/parallel_for.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/scene_arguments.h"
#include "cli/shard.h"
#include "dem/files_of.h"
#include "scene/job.h"
#include "session/batch.h"

namespace relevo::cli {
namespace {

namespace fs = std::filesystem;

/// More pictures than anybody means without saying so.
constexpr std::size_t kMostUnasked = 100'000;
constexpr std::size_t kMost = 1'000'000'000;

struct Arguments {
    SceneArguments scene;
    std::string job, output, device = "auto", shard;
    bool overwrite = false, resume = false, dry_run = false, yes = false, sidecar = false;
    bool allow_blank = false;
};

std::optional<std::string> environment(const char* name) {
    const char* const value = std::getenv(name);
    return value ? std::optional<std::string>(value) : std::nullopt;
}

/// Tells of the first few of many.
void warn_of(const std::vector<std::string>& reasons, const char* what) {
    constexpr std::size_t kFew = 3;
    for (std::size_t i = 0; i < std::min(kFew, reasons.size()); ++i)
        log::warning(fmt::format("{}: {}", what, reasons[i]));
    if (reasons.size() > kFew)
        log::warning(fmt::format("{}: {} more", what, reasons.size() - kFew));
}

/// A job on its way.
class Run {
  public:
    explicit Run(const Arguments& arguments) : arguments_(arguments) {}

    void run() {
        shots_ = shots();
        for (const scene::Shot& shot : shots_)
            image::check_format(shot.output, shot.scene.width_px, shot.scene.height_px);
        session::settle(shots_, moments_);
        session::order_for_drawing(shots_);
        take_shard();
        add_inputs();
        leave_out_what_is_there();
        if (arguments_.dry_run) return tell();
        check_folders();
        draw();
    }

  private:
    std::vector<scene::Shot> shots() {
        scene::Job job = scene::read_job(
            arguments_.job, [&](scene::Scene& scene) { arguments_.scene.apply_to(scene); });
        if (!arguments_.output.empty()) {
            job.output = arguments_.output;
            job.output_given = false;
            job.folder.clear();
        }
        files_.add_input(arguments_.job, "the job");
        scene::Shots drawn_up = scene::shots_of(
            job, [&](const scene::Scene& scene) { return moments_.of(scene); },
            arguments_.yes ? kMost : kMostUnasked);
        warn_of(drawn_up.left_out, "left out");
        return std::move(drawn_up.shots);
    }

    /// Neighbours stay together: they share most of what is loaded.
    void take_shard() {
        if (arguments_.shard.empty()) return;
        const Shard shard = parse_shard(arguments_.shard, environment);
        const auto at = [&](std::size_t number) {
            return shots_.begin() +
                   static_cast<std::ptrdiff_t>(shots_.size() * number / shard.count);
        };
        shots_ = std::vector<scene::Shot>(at(shard.number - 1), at(shard.number));
    }

    /// What the pictures are made of, which none of them may replace.
    void add_inputs() {
        std::set<std::vector<std::string>> dems;
        for (const scene::Shot& shot : shots_)
            if (dems.insert(shot.scene.dems).second)
                for (const fs::path& file : dem::files_of(shot.scene.dems)) {
                    inputs_.push_back(file);
                    files_.add_input(file, "the DEM");
                }
    }

    /// Pictures that are made already are left out with --resume; other files stay as they are
    /// unless --overwrite is there.
    void leave_out_what_is_there() {
        const std::size_t before = shots_.size();
        if (arguments_.resume) leave_out_made();
        made_ = before - shots_.size();
        if (arguments_.overwrite) return;
        std::size_t there = 0;
        std::string first;
        for (const scene::Shot& shot : shots_) {
            std::error_code missing;
            if (!fs::exists(fs::symlink_status(shot.output, missing))) continue;
            if (there++ == 0) first = shot.output.string();
        }
        if (there > 0)
            bad_input(fmt::format(
                "run: {}: exists, the first of {}{}; pass --overwrite to replace {}{}",
                printable(first), there,
                arguments_.resume ? " that are not whole, of another scene, or older than the DEM"
                                  : "",
                there == 1 ? "it" : "them",
                arguments_.resume ? "" : ", or --resume to make what is missing"));
    }

    void leave_out_made() {
        std::vector<char> made(shots_.size());
        parallel_for(0, static_cast<int>(shots_.size()), 1, [&](int first, int last) {
            for (int i = first; i < last; ++i) {
                const auto at = static_cast<std::size_t>(i);
                std::error_code missing;
                made[at] = session::is_made(shots_[at], inputs_) &&
                           (!arguments_.sidecar ||
                            fs::exists(session::sidecar_of(shots_[at].output), missing));
            }
        });
        std::size_t at = 0;
        std::erase_if(shots_, [&](const scene::Shot&) { return made[at++]; });
    }

    /// Says before any work is done where nothing can be written.
    void check_folders() {
        std::set<fs::path> folders;
        for (const scene::Shot& shot : shots_) {
            const fs::path folder = shot.output.parent_path();
            if (!folders.insert(folder).second) continue;
            std::error_code error;
            if (!folder.empty()) fs::create_directories(folder, error);
            if (error)
                bad_input(fmt::format("run: {}: the folder cannot be made, {}",
                                      printable(folder.string()), error.message()));
            files_.open_alone(shot.output, arguments_.overwrite, "run");
        }
    }

    session::BatchOptions options() const {
        session::BatchOptions result;
        result.device = arguments_.device;
        result.version = RELEVO_VERSION;
        result.overwrite = arguments_.overwrite;
        result.sidecar = arguments_.sidecar;
        result.allow_blank = arguments_.allow_blank;
        return result;
    }

    void draw() {
        const auto began = std::chrono::steady_clock::now();
        const std::string there =
            made_ > 0 ? fmt::format("; {} were there already", made_) : std::string();
        std::string first;
        std::size_t failures = 0;
        {
            CountBar bar(shots_.size());
            session::BatchOptions batch = options();
            batch.made = [&](const scene::Shot&) { bar.add(); };
            batch.failed = [&](const scene::Shot& shot, const std::string& why) {
                log::error(fmt::format("{}: {}", printable(shot.output.string()), why));
                if (first.empty()) first = printable(shot.output.string());
                bar.add();
            };
            failures = session::draw_batch(shots_, batch, moments_, files_);
        }
        const double took_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        log::info(fmt::format("{} pictures in {}{}", shots_.size() - failures,
                              duration_text(took_s), there));
        if (failures > 0)
            throw Error(ErrorCode::Incomplete,
                        fmt::format("run: {} of {} pictures could not be made, the first is {}; "
                                    "--resume tries them again",
                                    failures, shots_.size(), first));
    }

    /// Lists the files, and says how long they take: as some of them do that are drawn for it.
    void tell() {
        for (const scene::Shot& shot : shots_)
            fmt::print("{}\n", shot.output.string());
        std::string time = "no time";
        if (!shots_.empty()) {
            try {
                time = "some " + duration_text(session::time_batch(shots_, options(), moments_));
            } catch (const Error& error) {
                time = fmt::format("an unknown time ({})", error.what());
            }
        }
        log::info(fmt::format("{} pictures would take {}{}", shots_.size(), time,
                              made_ > 0 ? fmt::format("; {} are there already", made_) : ""));
    }

    const Arguments& arguments_;
    FilesInUse files_;
    session::Moments moments_;
    std::vector<scene::Shot> shots_;
    std::vector<fs::path> inputs_;
    std::size_t made_ = 0;
};

}  // namespace

void add_run(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    CLI::App& verb = *app.add_subcommand("run", "Takes the pictures of a job");
    verb.add_option("JOB", arguments->job, "Job: a file of JSON, docs/jobs.md")->required();
    arguments->scene.add_to(verb, /*with_file=*/false);
    arguments->scene.dem.dem_option->required(false);
    verb.add_option("-o,--output", arguments->output,
                    "Template of the names, {dem}_{time:%Y%m%dT%H%M}_{n:04}.png");
    verb.add_flag("--overwrite", arguments->overwrite, "Replace existing files");
    verb.add_flag("--resume", arguments->resume,
                  "Leave out pictures that are there, whole and of the same scene");
    verb.add_option("--shard", arguments->shard,
                    "Part of the pictures: I/N, or array for the task of a scheduler's array");
    verb.add_flag("--dry-run", arguments->dry_run, "List the files and say how long it would take");
    verb.add_flag("--yes", arguments->yes, "More than 100000 pictures are meant");
    verb.add_flag("--sidecar", arguments->sidecar,
                  "Write a JSON beside each picture: sun, camera, device, versions, DEM");
    verb.add_flag("--allow-blank", arguments->allow_blank,
                  "Take pictures without ground in them too");
    verb.add_option("--device", arguments->device,
                    "GL device: auto, an index, software, or a part of its name");
    verb.callback([arguments] { Run(*arguments).run(); });
}

}  // namespace relevo::cli
