#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <memory>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/error.h"
#include "base/log.h"
#include "base/object_store.h"
#include "base/output_file.h"
#include "base/parallel_for.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/job_run.h"
#include "cli/shard.h"
#include "scene/job.h"
#include "scene/sheet.h"
#include "session/batch.h"
#include "session/made.h"
#include "session/picture_file.h"
#include "session/record.h"
#include "session/scene_inputs.h"

namespace relevo::cli {
namespace {

namespace fs = std::filesystem;

/// What the audits of a job's pictures come to.
class Audits {
  public:
    void add(const std::string& picture, const session::ShadowAudit& audit) {
        if (audit.pixels() == 0) return;
        ++pictures_;
        if (pictures_ > 1 && audit.agreement() >= worst_.agreement()) return;
        worst_ = audit;
        picture_ = picture;
    }

    void tell() const {
        if (pictures_ == 0)
            log::warning("audit: no picture has ground whose shadows could be compared");
        else
            log::info(fmt::format("{}; the worst of {}, {}", worst_.text(), pictures_,
                                  printable(picture_)));
    }

  private:
    std::size_t pictures_ = 0;
    session::ShadowAudit worst_;
    std::string picture_;
};

/// Pictures that were not written because they show no ground.
class Blanks {
  public:
    void add(const scene::Shot& shot) {
        if (count_++ == 0) first_ = shot.output.string();
    }

    void tell() const {
        if (count_ == 0) return;
        log::error(
            fmt::format("{} only sky (first: {}); turn the camera or add --allow-blank",
                        count_ == 1 ? "1 picture shows" : fmt::format("{} pictures show", count_),
                        printable(first_)));
    }

  private:
    std::size_t count_ = 0;
    std::string first_;
};

/// The pictures of a job on their way.
class Run {
  public:
    Run(const JobArguments& arguments, JobRun& work)
        : notices_(work.notices),
          arguments_(arguments),
          files_(work.files),
          times_(work.times),
          shots_(work.shots),
          inputs_(work.inputs) {}

    void run() {
        for (const scene::Shot& shot : shots_)
            check_format(shot);
        session::settle(shots_, times_, inputs_);
        session::order_for_drawing(shots_);
        for (const scene::Shot& shot : shots_)
            if (session::scene_in(shot.output, shot.scene) == session::SceneIn::Sidecar)
                beside_.insert(shot.output);
        check_outputs();
        take_shard();
        const std::size_t all = shots_.size();
        const bool keeps = arguments_.resume || arguments_.missing || arguments_.plan.on;
        const std::string refusal = keeps ? leave_out_made() : what_is_in_the_way();
        made_ = all - shots_.size();
        if (arguments_.missing) return tell_missing();
        if (arguments_.plan.on) return tell_plan(refusal);
        if (arguments_.dry_run) return tell(refusal);
        if (!refusal.empty()) bad_input(refusal);
        check_folders();
        draw();
    }

  private:
    void check_format(const scene::Shot& shot) const {
        image::check_encoding(shot.output, arguments_.format.encoding(),
                              {.width_px = shot.scene.width_px,
                               .height_px = shot.scene.height_px,
                               .alpha = shot.scene.transparent,
                               .layers = !arguments_.format.layers.empty()});
    }

    /// Neighbours stay together: they share most of what is loaded.
    void take_shard() {
        if (arguments_.shard.empty()) return;
        const Shard shard = parse_shard(arguments_.shard, environment_variable);
        const auto at = [&](std::size_t number) {
            return shots_.begin() +
                   static_cast<std::ptrdiff_t>(shots_.size() * number / shard.count);
        };
        shots_ = std::vector<scene::Shot>(at(shard.number - 1), at(shard.number));
    }

    /// Says before any work is done that a result would replace what some picture is made of, or
    /// another result. Of all pictures, also where others draw the other parts.
    void check_outputs() {
        std::vector<fs::path> outputs;
        for (const scene::Shot& shot : shots_) {
            inputs_.add_to(files_, shot.scene);
            for (const fs::path& path : files_of(shot))
                outputs.push_back(path);
        }
        for (const fs::path& script : arguments_.plan.scripts())
            outputs.push_back(script);
        files_.check_planned(outputs, "run");
    }

    bool has_sidecar(const scene::Shot& shot) const {
        return wants_sidecar() || beside_.contains(shot.output);
    }

    /// The files of a picture.
    std::vector<fs::path> files_of(const scene::Shot& shot) const {
        std::vector<fs::path> files{shot.output};
        if (has_sidecar(shot)) files.push_back(session::sidecar_of(shot.output));
        for (const fs::path& path : session::files_beside(shot.scene, shot.output))
            files.push_back(path);
        return files;
    }

    /// @returns why the pictures cannot be made because files have their names; empty if they can
    std::string what_is_in_the_way() {
        std::string first;
        for (const scene::Shot& shot : shots_) {
            const std::vector<fs::path> names = files_of(shot);
            const auto taken = std::ranges::find_if(names, is_taken);
            if (taken != names.end() && there_++ == 0) first = taken->string();
        }
        if (there_ == 0 || arguments_.overwrite) return {};
        return fmt::format(
            "run: {}: exists, the first of {}; pass --overwrite to replace {}, or "
            "--resume to make what is missing",
            printable(first), there_, there_ == 1 ? "it" : "them");
    }

    /// Removes the pictures from the list that exist and can be kept.
    /// @returns why other files cannot be kept; empty if all can
    std::string leave_out_made() {
        std::vector<session::Wanted> wanted;
        std::set<std::string> remote;
        for (const scene::Shot& shot : shots_) {
            wanted.push_back(
                {inputs_.record(shot.scene),
                 session::format_text(arguments_.format.encoding(), arguments_.format.picture()),
                 has_sidecar(shot), arguments_.audit});
            for (const std::string& name : inputs_.remote_names(shot.scene))
                remote.insert(name);
        }
        if (!remote.empty())
            log::warning(
                fmt::format("run: {}: is not on this machine; --resume does not notice "
                            "whether it has changed",
                            printable(*remote.begin())));
        std::vector<session::OnDisk> found(shots_.size());
        parallel_for(0, static_cast<int>(shots_.size()), 1, [&](int first, int last) {
            for (int i = first; i < last; ++i) {
                const auto at = static_cast<std::size_t>(i);
                found[at] = session::on_disk(shots_[at], wanted[at]);
            }
        });
        return leave_out(found);
    }

    std::string leave_out(const std::vector<session::OnDisk>& found) {
        using State = session::OnDisk::State;
        std::string first;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const std::string name = shots_[i].output.string();
            if (found[i].state == State::Part) parts_.insert(shots_[i].output);
            if (found[i].state == State::Other && there_++ == 0)
                first = fmt::format("{}: {}", printable(name), found[i].why);
        }
        std::size_t at = 0;
        std::erase_if(shots_,
                      [&](const scene::Shot&) { return found[at++].state == State::Whole; });
        if (there_ == 0 || arguments_.overwrite) return {};
        return fmt::format(
            "run: {}, the first of {} that --resume cannot keep; pass --overwrite "
            "to make {} again",
            first, there_, there_ == 1 ? "it" : "them");
    }

    /// Says before any work is done where nothing can be written.
    void check_folders() {
        std::set<fs::path> folders;
        for (const scene::Shot& shot : shots_) {
            if (!folders.insert(shot.output.parent_path()).second) continue;
            make_folder_of(shot.output, "run");
            files_.open_alone(shot.output, arguments_.overwrite || parts_.contains(shot.output),
                              "run");
        }
    }

    session::BatchOptions options() const {
        session::BatchOptions result;
        result.device = arguments_.device;
        result.overwrite = arguments_.overwrite;
        result.parts = parts_;
        result.sidecar = wants_sidecar();
        result.audit = arguments_.audit;
        result.allow_blank = arguments_.allow_blank;
        result.encoding = arguments_.format.encoding();
        result.format = arguments_.format.picture();
        result.format.map_alone = !shots_.empty() && scene::is_pdf(shots_.front().output);
        return result;
    }

    /// Says which pictures have no room for their scenes, which nobody has asked sidecars for.
    void tell_of_sidecars() const {
        if (wants_sidecar()) return;
        const auto beside = [&](const scene::Shot& shot) { return has_sidecar(shot); };
        const auto first = std::ranges::find_if(shots_, beside);
        if (first == shots_.end()) return;
        const auto more = std::count_if(std::next(first), shots_.end(), beside);
        log::warning(session::says_where_scene_is(first->output) +
                     (more > 0 ? fmt::format("; the same for {} more", more) : ""));
    }

    void draw() {
        tell_of_sidecars();
        const auto began = std::chrono::steady_clock::now();
        const std::string there =
            made_ > 0 ? fmt::format("; {} were there already", made_) : std::string();
        std::string first;
        std::size_t failures = 0;
        Audits audits;
        Blanks blanks;
        {
            ProgressBar bar;
            std::size_t done = 0;  // both below are called on one thread at a time
            const auto count = [&] { bar.show(++done, shots_.size()); };
            session::BatchOptions batch = options();
            batch.made = [&](const scene::Shot&) { count(); };
            batch.audited = [&](const scene::Shot& shot, const session::ShadowAudit& audit) {
                audits.add(shot.output.string(), audit);
            };
            batch.failed = [&](const scene::Shot& shot, const std::string& why) {
                log::error(fmt::format("{}: {}", printable(shot.output.string()), why));
                if (first.empty()) first = printable(shot.output.string());
                count();
            };
            batch.blank = [&](const scene::Shot& shot) {
                blanks.add(shot);
                if (first.empty()) first = printable(shot.output.string());
                count();
            };
            failures = session::draw_batch(shots_, batch, times_, inputs_, files_);
        }
        const double took_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        notices_.release();
        log::info(fmt::format("{} pictures in {}{}", shots_.size() - failures,
                              duration_text(took_s), there));
        if (arguments_.audit && !shots_.empty()) audits.tell();
        blanks.tell();
        if (failures > 0)
            throw Error(ErrorCode::Incomplete,
                        fmt::format("run: {} of {} pictures could not be made, the first is {}; "
                                    "--resume tries them again",
                                    failures, shots_.size(), first));
    }

    /// Lists the files, and says how long they take: as some of them do that are drawn for it.
    /// @param refusal  why none of them would be made, or empty
    void tell(const std::string& refusal) {
        for (const scene::Shot& shot : shots_)
            fmt::print("{}\n", shot.output.string());
        std::string time = "no time";
        if (!shots_.empty()) {
            try {
                time = "some " + duration_text(session::time_batch(shots_, options(), times_));
            } catch (const Error& error) {
                time = fmt::format("an unknown time ({})", error.what());
            }
        }
        notices_.release();
        std::string already;
        if (made_ > 0) already = fmt::format("; {} are there already and stay", made_);
        if (there_ > 0 && refusal.empty()) already += fmt::format("; {} are replaced", there_);
        log::info(fmt::format("{} pictures would take {}{}", shots_.size(), time, already));
        if (!refusal.empty()) log::warning("would be refused: " + refusal);
        for (const std::string& problem : folder_problems())
            log::warning("would be refused: " + problem);
    }

    /// Names the pictures that are not there, or not whole.
    void tell_missing() const {
        for (const scene::Shot& shot : shots_)
            fmt::print("{}\n", shot.output.string());
        if (shots_.empty()) {
            log::info(fmt::format("all {} pictures are there", made_));
            return;
        }
        failed(fmt::format(
            "run: {} of {} pictures are missing or not whole, the first is {}; make "
            "them with --resume",
            shots_.size(), shots_.size() + made_, printable(shots_.front().output.string())));
    }

    /// Draws some of the pictures, and says what tasks make all.
    void tell_plan(const std::string& refusal) {
        if (!refusal.empty()) bad_input(refusal);
        double computing_s = 0;
        if (!shots_.empty()) computing_s = session::time_batch(shots_, options(), times_);
        notices_.release();
        constexpr double kMiB = 1024;  // of what getrusage counts
        struct rusage used {};
        getrusage(RUSAGE_SELF, &used);
        const double memory_mib = static_cast<double>(used.ru_maxrss) / kMiB;
        fmt::print("pictures            {}, {} there already\n", shots_.size() + made_, made_);
        fmt::print("memory              some {:.0f} MiB a task, as for those drawn to measure\n",
                   memory_mib);
        fmt::print("computing           some {:.3g} processor hours\n",
                   computing_s * thread_count() / 3600);
        const std::vector<std::string> words = arguments_.plan.words(*arguments_.verb);
        std::vector<std::string> check = words;
        check.insert(std::ranges::find(check, "--"), "--missing");
        tell_tasks(arguments_.plan, {.left = shots_.size(),
                                     .ready_s = 0,
                                     .computing_s = computing_s,
                                     .threads = thread_count(),
                                     .memory_mib = memory_mib,
                                     .words = words,
                                     .merge_words = check,
                                     .overwrite = arguments_.overwrite});
    }

    /// Folders in which no file can be made, told without making any.
    std::vector<std::string> folder_problems() const {
        std::vector<std::string> problems;
        std::set<fs::path> folders;
        for (const scene::Shot& shot : shots_) {
            if (!folders.insert(shot.output.parent_path()).second) continue;
            if (object_store_of(shot.output.native())) continue;
            fs::path there = fs::absolute(shot.output).parent_path();
            std::error_code missing;
            while (there.has_relative_path() && !fs::exists(there, missing))
                there = there.parent_path();
            const int error = !fs::is_directory(there, missing)         ? ENOTDIR
                              : access(there.c_str(), W_OK | X_OK) != 0 ? errno
                                                                        : 0;
            if (error != 0)
                problems.push_back(fmt::format("run: {}: no file can be made in it, {}",
                                               printable(there.string()),
                                               std::generic_category().message(error)));
        }
        return problems;
    }

    bool wants_sidecar() const { return arguments_.sidecar || arguments_.audit; }

    log::HeldNotices& notices_;
    const JobArguments& arguments_;
    FilesInUse& files_;
    session::SceneTimes& times_;
    std::vector<scene::Shot>& shots_;
    session::SceneInputs& inputs_;
    std::set<fs::path> beside_;  ///< pictures whose scene is in a sidecar, for want of room
    std::set<fs::path> parts_;   ///< pictures of which, or of whose sidecar, --resume finds one
    std::size_t made_ = 0;       ///< pictures that --resume keeps
    std::size_t there_ = 0;      ///< names of the others that files have already
};

}  // namespace

void run_job(const JobArguments& arguments) {
    JobRun work;
    arguments.plan.check(work.files, arguments.shard, arguments.overwrite);
    work.read(arguments);
    if ((arguments.plan.on || arguments.missing) &&
        (!arguments.contact_sheet.empty() || work.job.is_film()))
        bad_usage(fmt::format("{}: makes one file, which cannot be split into tasks",
                              printable(arguments.job)));
    if (!arguments.contact_sheet.empty())
        run_contact_sheet(arguments, work);
    else if (work.job.is_film())
        run_film(arguments, work);
    else
        Run(arguments, work).run();
}

void add_run(Verb app) {
    const auto arguments = std::make_shared<JobArguments>();
    const Verb verb = app.add_verb("run", "Makes the pictures or the film of a job");
    arguments->verb = verb;
    verb.add_option("JOB", arguments->job, "Job file, JSON: docs/jobs.md").required();
    arguments->scene.add_to(verb, /*with_file=*/false);
    arguments->scene.dem.dem_option.required(false);
    const Option output =
        verb.add_option("-o,--output", arguments->output,
                        "Template of the file names, {dem}_{time:%Y%m%dT%H%M}_{n:04}.png");
    arguments->format.add_to(verb, /*with_format=*/false);
    verb.add_flag("--overwrite", arguments->overwrite, "Replace existing files");
    verb.add_flag("--resume", arguments->resume,
                  "Skip pictures that exist, complete, of the same scene and from the same files");
    verb.add_option("--shard", arguments->shard,
                    "Make one part of the pictures: I/N, or array in an array task of a scheduler");
    if (PlanArguments::is_for(verb)) {
        arguments->plan.add_to(verb);
    } else {
        verb.add_flag("--dry-run", arguments->dry_run, "List the files and estimate the time");
        verb.add_flag("--missing", arguments->missing,
                      "List the pictures that are missing or not whole; status 1 if there are any");
    }
    verb.add_flag("--yes", arguments->yes, "Allow more than 100000 pictures");
    verb.add_flag("--sidecar", arguments->sidecar,
                  "Write a JSON sidecar for each picture: sun, camera, device, versions, DEM");
    verb.add_flag("--audit", arguments->audit,
                  "Compare the drawn shadows with the computed ones; implies --sidecar");
    verb.add_flag("--allow-blank", arguments->allow_blank, "Accept pictures that show no ground");
    const Option sheet =
        verb.add_option("--contact-sheet", arguments->contact_sheet,
                        "Make one picture instead, with all pictures small and with captions")
            .group("Contact sheet");
    verb.add_option("--columns", arguments->columns,
                    "Columns of the contact sheet; default: by shape")
        .needs(sheet)
        .check(whole_number())
        .check(in_range(1, 1000))
        .group("Contact sheet");
    verb.add_option("--device", arguments->device,
                    "GL device: auto, an index, software, or a part of its name");
    verb.callback([arguments, template_given = output] {
        if (template_given.count() > 0 && arguments->output.empty())
            bad_usage("-o: expected a template of names but got nothing");
        run_job(*arguments);
    });
}

}  // namespace relevo::cli
