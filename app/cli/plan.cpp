#include "cli/plan.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "base/allocation.h"
#include "base/contains.h"
#include "base/error.h"
#include "base/log.h"
#include "base/output_file.h"
#include "base/parallel_for.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/shared.h"
#include "cli/sun.h"

namespace relevo::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kGiB = 1 << 30;

std::string bytes_text(double bytes) {
    return bytes < kGiB ? fmt::format("{:.1f} MiB", bytes / kMiB)
                        : fmt::format("{:.1f} GiB", bytes / kGiB);
}

/// How the posts of a file are stored: of "Int16" 2.
int bytes_of_type(const std::string& type) {
    const std::size_t digits = type.find_first_of("0123456789");
    return digits == std::string::npos ? 1 : std::max(1, std::stoi(type.substr(digits)) / 8);
}

/// The program that runs.
std::string this_program() {
    std::error_code error;
    const fs::path path = fs::read_symlink("/proc/self/exe", error);
    return error ? "relevo" : path.string();
}

/// Memory that this computer gives to processes [MiB].
double memory_here_mib() {
    double bytes = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
    if (const auto granted = allocation().memory_bytes)
        bytes = std::min(bytes, static_cast<double>(*granted));
    return bytes / kMiB;
}

/// Tasks that this computer does at once: as many as it has processors, if it has memory for them.
int tasks_at_once(const PlanArguments& arguments, const PlannedWork& work) {
    if (arguments.threads > 0) return std::max(1, work.threads / arguments.threads);
    const double fit = memory_here_mib() / std::max(1.0, kTaskMemoryMargin * work.memory_mib);
    return static_cast<int>(std::clamp(fit, 1.0, double(work.threads)));
}

/// Tasks that take about as long as is asked for; for GNU parallel enough of them that all
/// processors of this computer have work.
TaskList tasks_of(const PlanArguments& arguments, const PlannedWork& work) {
    const int at_once = arguments.parallel.empty() ? 1 : tasks_at_once(arguments, work);
    TaskList list{.program = this_program(),
                  .folder = fs::current_path().string(),
                  .command = work.words,
                  .merge = work.merge_words,
                  .tasks = 1,
                  .threads = arguments.threads > 0 ? arguments.threads : work.threads / at_once,
                  .memory_mib = work.memory_mib,
                  .task_s = 0,
                  .rasters = work.rasters};
    const double all_s = work.computing_s * work.threads / list.threads;
    const double wanted =
        std::max<double>(at_once, std::floor(all_s / (60.0 * arguments.task_minutes)));
    const double most =
        static_cast<double>(std::min<std::size_t>(work.left, std::size_t(arguments.most_tasks)));
    list.tasks = static_cast<std::size_t>(std::clamp(wanted, 1.0, std::max(1.0, most)));
    list.task_s = work.ready_s + all_s / static_cast<double>(list.tasks);
    return list;
}

/// Posts that tiles may read: those of a window around each, and the halo.
double posts_read_on_demand(const dem::Posts& posts, const std::vector<output::PlannedTile>& tiles,
                            double halo_m) {
    const glm::dvec2 spacing_m = posts.grid().post_spacing_m();
    const auto line = [&](int first, int count, int all, double step_m) {
        const double halo = std::min(halo_m / step_m, double(all));
        return std::min(double(all), first + count + halo) - std::max(0.0, first - halo);
    };
    double sum = 0;
    for (const output::PlannedTile& tile : tiles) {
        const dem::Window& window = tile.window;
        sum += line(window.column, window.columns, posts.grid().columns(), spacing_m.x) *
               line(window.row, window.rows, posts.grid().rows(), spacing_m.y);
    }
    return sum;
}

/// Posts that tiles read with their halos, one after the other, less what the one before has.
double posts_read_of_sites(const dem::Posts& posts, const std::vector<output::PlannedTile>& tiles,
                           double halo_m) {
    const auto count = [](const dem::Window& window) {
        return window.is_empty() ? 0.0 : double(window.columns) * window.rows;
    };
    double sum = 0;
    dem::Window last;
    for (const output::PlannedTile& tile : tiles) {
        const dem::Window site = figure::FarGround::halo_of(posts.grid(), halo_m, tile.window);
        sum += count(site) - count(common(site, last));
        last = site;
    }
    return sum;
}

}  // namespace

bool PlanArguments::is_for(const Verb& verb) {
    return verb.command().starts_with("plan ");
}

void PlanArguments::add_to(Verb verb) {
    on = true;
    verb.add_option("--slurm", slurm,
                    "File to write: submits an array of tasks and the merge of their results")
        .group("Tasks");
    verb.add_option("--parallel", parallel, "File to write: a task a line, for GNU parallel")
        .group("Tasks");
    verb.add_option("--cpus", threads, "Processors of a task (those of this computer)")
        .check(in_range(1, 1024))
        .group("Tasks");
    verb.add_option("--task-minutes", task_minutes, "Least duration of a task, minutes (10)")
        .check(in_range(1, 10080))
        .group("Tasks");
    verb.add_option("--most-tasks", most_tasks,
                    "Tasks at most; Slurm's own limit is often 1001 (1000)")
        .check(in_range(1, 1'000'000))
        .group("Tasks");
}

void PlanArguments::check(const FilesInUse& files, const std::string& shard, bool overwrite) const {
    if (!on) return;
    if (!shard.empty())
        bad_usage("--shard: a plan is of all tasks, and gives each of them its part; pass none");
    if (!slurm.empty()) files.open_alone(slurm, overwrite, "--slurm");
    if (!parallel.empty()) files.open_alone(parallel, overwrite, "--parallel");
}

std::vector<fs::path> PlanArguments::scripts() const {
    std::vector<fs::path> names;
    for (const std::string& name : {slurm, parallel})
        if (!name.empty()) names.emplace_back(name);
    return names;
}

std::vector<std::string> PlanArguments::words(const Verb& verb) const {
    std::vector<std::string> words = split(verb.command(), ' '), names{"--"};
    words.erase(words.begin());  // plan
    for (const GivenOption& option : verb.given()) {
        if (contains(kNames, option.name) || option.name == "--resume" ||
            option.name == "--overwrite")
            continue;
        if (option.is_flag) words.push_back(option.name);
        for (const std::string& value : option.values) {
            if (option.is_flag) break;
            if (option.name.starts_with('-'))
                words.push_back(option.name + "=" + value);
            else
                names.push_back(value);
        }
    }
    if (names.size() > 1) words.insert(words.end(), names.begin(), names.end());
    return words;
}

void tell_tasks(const PlanArguments& arguments, const PlannedWork& work) {
    if (work.left == 0) {
        fmt::print("tasks               none, all is there\n");
        return;
    }
    const TaskList list = tasks_of(arguments, work);
    fmt::print("tasks               {}, some {} each on {} threads\n", list.tasks,
               duration_text(list.task_s), list.threads);
    const auto write = [&](const std::string& path, const std::string& text, const char* who) {
        if (!path.empty()) write_text(path, text, work.overwrite, who);
    };
    write(arguments.slurm, slurm_script(list), "--slurm");
    write(arguments.parallel, parallel_lines(list), "--parallel");
    if (!arguments.slurm.empty()) fmt::print("\nsh {}\n", shell_word(arguments.slurm));
    if (!arguments.parallel.empty())
        fmt::print("\nparallel -j {} < {} && {}\n", tasks_at_once(arguments, work),
                   shell_word(arguments.parallel), shell_line("relevo", list.merge));
}

namespace {

/// Of tiles that are narrow for their halo.
void warn_of_wide_halo(double halo_m, const dem::Posts& posts,
                       const std::vector<output::PlannedTile>& todo) {
    // No wider than the DEM is beyond a tile.
    const glm::dvec2 spacing_m = posts.grid().post_spacing_m();
    int side = 1;
    for (const output::PlannedTile& tile : todo)
        side = std::max({side, tile.window.columns, tile.window.rows});
    const double side_m = side * std::min(spacing_m.x, spacing_m.y),
                 beyond_m = std::max(posts.grid().columns() * spacing_m.x,
                                     posts.grid().rows() * spacing_m.y) -
                            side_m;
    const double sides = std::min(halo_m, beyond_m) / side_m;
    constexpr double kWide = 2;
    if (sides > kWide)
        log::warning(
            fmt::format("the halo is {:.1f} times as wide as a tile, and all of it may be "
                        "read for each; larger --tiles read less",
                        sides));
}

}  // namespace

void tell_raster_plan(const PlanArguments& arguments, const figure::RasterRun& run,
                      const figure::RasterRunOptions& options, const dem::Posts& posts,
                      std::vector<std::string> words) {
    const figure::RasterEstimate estimate = run.estimate();
    const std::vector<output::PlannedTile>& todo = run.todo();
    const std::size_t tiles = run.folder()->plan().tiles.size();
    fmt::print("tiles               {} {}, {} there already\n", tiles, options.tiles.description(),
               run.folder()->there());
    const dem::TileReport& found = posts.about().tiles;
    if (const std::int64_t voids = found.missing.count + found.broken.count; voids > 0)
        fmt::print("voids               {} of {} tiles of the DEM are missing or broken\n", voids,
                   found.tiles);
    fmt::print(
        "halo                {:.1f} km: ground so far off can change a figure (relief "
        "{:.0f} m)\n",
        run.halo_m() / 1000, double{posts.highest_m()} - posts.lowest_m());
    if (!todo.empty()) {
        const double bytes = bytes_of_type(posts.about().data_type);
        const double read =
            bytes * (options.tiles.halo_km ? posts_read_of_sites(posts, todo, run.halo_m())
                                           : posts_read_on_demand(posts, todo, run.halo_m()));
        fmt::print("memory              some {:.0f} MiB a task, {:.0f} of them heights\n",
                   estimate.memory_mib, estimate.heights_mib);
        fmt::print(
            "computing           some {:.3g} processor hours, as {:.3g} % of it took {:.2g} s on "
            "{} "
            "threads\n",
            estimate.computing_s * estimate.threads / 3600, 100 * estimate.sampled_share,
            estimate.sampled_s, estimate.threads);
        fmt::print("reading             up to {}, with the halo of each tile\n", bytes_text(read));
        fmt::print("writing             {} before compression\n",
                   bytes_text(estimate.result_bytes));
    }
    warn_of_wide_halo(run.halo_m(), posts, todo);
    const fs::path folder = options.output;
    tell_tasks(arguments, {.left = todo.size(),
                           .ready_s = estimate.ready_s,
                           .computing_s = estimate.computing_s,
                           .threads = estimate.threads,
                           .memory_mib = estimate.memory_mib,
                           .words = std::move(words),
                           .merge_words = {"merge", "--output=" + (folder / "mosaic.vrt").string(),
                                           "--stac=" + (folder / "mosaic.json").string(),
                                           "--overwrite", "--", options.output},
                           .rasters = tiles * estimate.bands,
                           .overwrite = options.overwrite});
}

void add_plan(Verb app) {
    const Verb verb = app.add_verb(
        "plan", "Tiles, memory, time and tasks of a command for many computers, before it runs");
    verb.require_verb(1);
    const Verb sun = verb.add_verb("sun", "Rasters of the sun, in tiles");
    sun.require_verb(1);
    add_sun_hours(sun);
    add_sun_shadow(sun);
    add_sun_sky_view(sun);
    add_sun_horizons(sun);
    add_run(verb);
}

}  // namespace relevo::cli
