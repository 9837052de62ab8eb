#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/shared.h"
#include "dem/summary.h"

namespace relevo::cli {

void add_info(CLI::App& app) {
    struct Arguments {
        DemArguments dem;
        bool json = false;
    };
    const auto arguments = std::make_shared<Arguments>();
    CLI::App& verb = *app.add_subcommand("info", "What a DEM is, and what is assumed of it");
    arguments->dem.add_to(verb);
    verb.add_flag("--json", arguments->json, "One JSON object on standard output");
    verb.callback([arguments] {
        const dem::Heightfield field = dem::load(arguments->dem.paths, arguments->dem.options);
        const dem::Summary summary = dem::summarize(field);
        if (arguments->json)
            fmt::print("{}\n", dem::to_json(summary));
        else
            fmt::print("{}", dem::to_text(summary));
    });
}

}  // namespace relevo::cli
