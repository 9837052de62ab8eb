#include "cli/shard.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"

namespace relevo::cli {
namespace {

/// What a scheduler calls a task of an array, its first one, its last one, and how far apart they
/// are. Documentation of: Slurm sbatch, LSF bsub, Grid Engine qsub, AWS Batch array jobs, PBS qsub.
struct Scheduler {
    const char* name;
    const char* task;
    const char* first;  ///< null: `first_task`
    const char* last;   ///< null: `count`
    const char* step;
    const char* count;
    int first_task;
};
constexpr std::array kSchedulers{
    Scheduler{"Slurm", "SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_MAX",
              "SLURM_ARRAY_TASK_STEP", "SLURM_ARRAY_TASK_COUNT", 0},
    Scheduler{"AWS Batch", "AWS_BATCH_JOB_ARRAY_INDEX", nullptr, nullptr, nullptr,
              "AWS_BATCH_JOB_ARRAY_SIZE", 0},
    Scheduler{"PBS", "PBS_ARRAY_INDEX", nullptr, nullptr, nullptr, nullptr, 1},
    Scheduler{"PBS", "PBS_ARRAYID", nullptr, nullptr, nullptr, nullptr, 1},
    Scheduler{"LSF", "LSB_JOBINDEX", nullptr, "LSB_JOBINDEX_END", "LSB_JOBINDEX_STEP", nullptr, 1},
    Scheduler{"Grid Engine", "SGE_TASK_ID", "SGE_TASK_FIRST", "SGE_TASK_LAST", "SGE_TASK_STEPSIZE",
              nullptr, 1},
};

std::optional<long> whole(const std::string& text) {
    const auto number = parse_number(text);
    if (!number || *number != std::floor(*number) || std::abs(*number) > 1e9) return std::nullopt;
    return static_cast<long>(*number);
}

[[noreturn]] void refuse_shard(const std::string& text, const std::string& what) {
    bad_usage(fmt::format("--shard: {}: {}", text, what));
}

/// A number that a scheduler gives.
std::optional<long> given(const Environment& environment, const char* name,
                          const std::string& text) {
    const auto value = name ? environment(name) : std::nullopt;
    if (!value) return std::nullopt;
    const auto number = whole(*value);
    if (!number)
        refuse_shard(text,
                     fmt::format("expected a whole number in {} but got \"{}\"", name, *value));
    return number;
}

Shard of_array(const std::string& text, std::optional<long> count, const Environment& environment) {
    for (const Scheduler& scheduler : kSchedulers) {
        // Grid Engine says "undefined", LSF 0, where there is no array.
        const auto set = environment(scheduler.task);
        if (!set || *set == "undefined" ||
            (scheduler.task == std::string("LSB_JOBINDEX") && *set == "0"))
            continue;
        const long task = *given(environment, scheduler.task, text);
        const long first = given(environment, scheduler.first, text).value_or(scheduler.first_task);
        const long step = std::max(1L, given(environment, scheduler.step, text).value_or(1));
        const auto last = given(environment, scheduler.last, text);
        if (!count) count = given(environment, scheduler.count, text);
        if (!count && last) count = (*last - first) / step + 1;
        if (!count)
            refuse_shard(text,
                         fmt::format("{} does not say how many tasks its array has; write array/N",
                                     scheduler.name));
        const long at = (task - first) / step;
        if ((task - first) % step != 0 || at < 0 || at >= *count ||
            (last && (*last - first) / step >= *count))
            refuse_shard(text,
                         fmt::format("expected tasks of {} in equal steps from {} on, {} of them, "
                                     "but this is task {}; write --shard I/N",
                                     scheduler.name, first, *count, task));
        return {static_cast<std::size_t>(at) + 1, static_cast<std::size_t>(*count)};
    }
    refuse_shard(text,
                 "expected a task of an array of Slurm, PBS, LSF, Grid Engine or AWS Batch, but "
                 "none of their variables is set; write --shard I/N");
}

}  // namespace

Shard parse_shard(const std::string& text, const Environment& environment) {
    const std::vector<std::string> pieces = split(text, '/');
    const auto count = pieces.size() == 2 ? whole(pieces[1]) : std::nullopt;
    const bool counted = count && *count >= 1;
    if (pieces.size() == 1 && pieces[0] == "array") return of_array(text, {}, environment);
    if (pieces.size() == 2 && pieces[0] == "array" && counted)
        return of_array(text, count, environment);
    const auto number = pieces.size() == 2 ? whole(pieces[0]) : std::nullopt;
    if (!counted || !number || *number < 1 || *number > *count)
        refuse_shard(text, "expected I/N with I from 1 to N, array, or array/N");
    return {static_cast<std::size_t>(*number), static_cast<std::size_t>(*count)};
}

}  // namespace relevo::cli
