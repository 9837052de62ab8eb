#include "cli/plugin_tools.h"

#include <cstdio>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/text.h"
#include "effect/new_plugin.h"
#include "session/plugin_check.h"
#include "session/plugin_golden.h"

namespace relevo::cli {
namespace {

effect::Registry registry_of(const std::vector<std::string>& plugin_path) {
    return effect::Registry::load_installed({plugin_path.begin(), plugin_path.end()});
}

void add_new(Verb plugins, const std::vector<std::string>& plugin_path) {
    struct Arguments {
        effect::NewPlugin plugin;
        std::string into = ".";
    };
    const auto arguments = std::make_shared<Arguments>();
    const Verb verb = plugins.add_verb("new", "Writes a new plugin's folder");
    verb.add_option("ID", arguments->plugin.id, "A letter a-z, then letters and digits").required();
    verb.add_flag("--native", arguments->plugin.native, "With the C++ source of a module");
    verb.add_option("--from", arguments->plugin.copied, "Copy an installed effect: haze");
    verb.add_option("--into", arguments->into, "Folder for the plugin's folder (.)");
    verb.callback([arguments, &plugin_path] {
        for (const auto& file :
             effect::write_new_plugin(arguments->plugin, arguments->into, registry_of(plugin_path)))
            fmt::print("{}\n", printable(file.string()));
    });
}

std::string counted(int count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

void check(const session::PluginCheckOptions& options) {
    // What effects switch on and off is no matter here, nor are other broken plugins.
    const log::Level level = log::level();
    if (level != log::Level::Debug) log::set_level(log::Level::Error);
    std::optional<ProgressBar> bar;
    const session::PluginCheckTotals totals = session::check_plugins(
        options,
        [&](const effect::Finding& finding) {
            bar.reset();
            fmt::print("{}: {}\n", finding.is_error ? "error" : "warning",
                       printable_lines(finding.text));
            std::fflush(stdout);
        },
        [&](double share) {
            if (!bar) bar.emplace("plugins check");
            bar->show(share);
        });
    bar.reset();
    log::set_level(level);
    const std::string text =
        fmt::format("{}: {}, {}", fmt::join(totals.checked, ", "), counted(totals.errors, "error"),
                    counted(totals.warnings, "warning"));
    if (totals.errors > 0) failed("plugins check: " + text);
    fmt::print("{}\n", text);
}

void add_check(Verb plugins, const std::vector<std::string>& plugin_path) {
    const auto options = std::make_shared<session::PluginCheckOptions>();
    const Verb verb = plugins.add_verb("check", "Finds mistakes in plugins, also by drawing");
    verb.add_option("PATH", options->paths, "Plugins, or folders of plugins").required();
    verb.add_option("--device", options->device,
                    "GL device: auto, an index, software, or a part of its name");
    verb.callback([options, &plugin_path] {
        options->plugin_path = plugin_path;
        check(*options);
    });
}

void add_test(Verb plugins) {
    struct Arguments {
        std::string folder;
        bool update = false;
    };
    const auto arguments = std::make_shared<Arguments>();
    const Verb verb = plugins.add_verb("test", "Compares a plugin's picture with its golden.png");
    verb.add_option("FOLDER", arguments->folder, "The plugin's folder").required();
    verb.add_flag("--update", arguments->update, "Write golden.png instead");
    verb.callback([arguments] {
        fmt::print("{}\n", session::test_plugin(arguments->folder, arguments->update).text);
    });
}

}  // namespace

void add_plugin_tools(Verb plugins, const std::vector<std::string>& plugin_path) {
    add_new(plugins, plugin_path);
    add_check(plugins, plugin_path);
    add_test(plugins);
}

}  // namespace relevo::cli
