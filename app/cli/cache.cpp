#include <chrono>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/shared.h"
#include "dem/level_cache.h"
#include "sun/time.h"

namespace relevo::cli {
namespace {

double mib_of(std::int64_t bytes) {
    return static_cast<double>(bytes) / kMiB;
}

/// "2026-06-21T10:12:00Z".
std::string time_text(std::filesystem::file_time_type time) {
    const auto system = std::chrono::file_clock::to_sys(time);
    return sun::to_iso(sun::Instant::from_unix_us(
        std::chrono::duration_cast<std::chrono::microseconds>(system.time_since_epoch()).count()));
}

std::int64_t bytes_of(const std::vector<dem::CachedDem>& dems) {
    std::int64_t sum = 0;
    for (const dem::CachedDem& dem : dems)
        sum += dem.entry.bytes;
    return sum;
}

void print_json(const CacheFolder& folder, const std::vector<dem::CachedDem>& dems) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const dem::CachedDem& dem : dems)
        list.push_back({{"dem", printable(dem.file.string())},
                        {"mib", mib_of(dem.entry.bytes)},
                        {"used", time_text(dem.entry.used)},
                        {"file", printable(dem.entry.path.string())}});
    const nlohmann::ordered_json all = {{"folder", printable(folder.folder().string())},
                                        {"mib", mib_of(bytes_of(dems))},
                                        {"most_mib", mib_of(folder.most_bytes())},
                                        {"dems", list}};
    fmt::print("{}", json_text(with_schema("relevo-cache-1", all)));
}

void print_list(const CacheFolder& folder, const std::vector<dem::CachedDem>& dems) {
    fmt::print("folder     {}\n", folder.folder().empty()
                                      ? "none: neither XDG_CACHE_HOME nor HOME is set"
                                      : printable(folder.folder().string()));
    fmt::print("size       {:.0f} MiB of at most {:.0f}, averaged levels of {} DEM{}\n",
               mib_of(bytes_of(dems)), mib_of(folder.most_bytes()), dems.size(),
               dems.size() == 1 ? "" : "s");
    for (const dem::CachedDem& dem : dems)
        fmt::print("{:6.0f} MiB  {}  {}\n", mib_of(dem.entry.bytes), time_text(dem.entry.used),
                   dem.file.empty() ? "(damaged)" : printable(dem.file.string()));
}

}  // namespace

void add_cache(Verb app) {
    struct Arguments {
        bool clear = false, json = false;
    };
    const auto arguments = std::make_shared<Arguments>();
    const Verb verb = app.add_verb(
        "cache", "Lists the averaged levels of large DEMs that are kept on disk, or removes them");
    verb.add_flag("--clear", arguments->clear, "Remove all of them");
    verb.add_flag("--json", arguments->json, "One JSON object on standard output");
    verb.callback([arguments] {
        const CacheFolder folder = dem::user_level_cache();
        if (arguments->clear)
            if (const std::string failure = folder.clear(); !failure.empty())
                failed(fmt::format("{}: cannot be cleared, {}", printable(folder.folder().string()),
                                   failure));
        const std::vector<dem::CachedDem> dems = dem::cached_dems(folder);
        if (arguments->json)
            print_json(folder, dems);
        else
            print_list(folder, dems);
    });
}

}  // namespace relevo::cli
