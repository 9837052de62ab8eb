#include "session/plugin_check.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/paths.h"
#include "base/text.h"
#include "base/units.h"
#include "effect/selection.h"
#include "render/programs.h"
#include "session/active_effects.h"
#include "session/non_finite.h"
#include "session/session.h"
#include "session/words.h"
#include "shader/core_texts.h"

namespace relevo::session {
namespace {

namespace fs = std::filesystem;

/// A view of the bundled DEM.
struct View {
    std::string_view name;
    bool on_ground;
    std::string_view time;
};
// The sun stands 57, 57 and -10 degrees high.
constexpr std::array<View, 3> kViews = {{{"from outside", false, "2026-06-21T16:00-04:00"},
                                         {"on the ground", true, "2026-06-21T16:00-04:00"},
                                         {"at night", true, "2026-06-21T21:53-04:00"}}};
constexpr std::size_t kOnGround = 1;

/// The lines of an error for the author of a plugin: without the program's name, which the author
/// does not know, and without options of other commands.
std::vector<std::string> author_lines(const std::string& what) {
    std::vector<std::string> lines;
    for (std::string line : split(what, '\n')) {
        if (line.starts_with("--disable ")) continue;
        if (const std::size_t at = line.rfind("; --disable "); at != std::string::npos)
            line.resize(at);
        for (const std::string_view head : {"shader: ", "plugin: ", "render: "})
            if (line.starts_with(head)) line.erase(0, head.size());
        lines.push_back(std::move(line));
    }
    if (lines.size() > 1 && lines.front().ends_with("the driver refuses it"))
        lines.erase(lines.begin());
    return lines;
}

class Check {
  public:
    Check(const effect::Effect& effect, const PluginCheckOptions& options,
          const OnFinding& on_finding, const OnCheckProgress& on_progress)
        : effect_(effect),
          id_(effect.id()),
          options_(options),
          on_finding_(on_finding),
          on_progress_(on_progress) {}

    void run(const effect::Registry& registry) {
        using Ids = std::vector<std::string>;
        const std::string bundled = (share_dir() / "plugins" / "").string();
        std::vector<const effect::Effect*> drawn, stitched;
        for (const effect::Effect& other : registry.effects())
            if (other.id() != id_ && other.manifest.folder.string().starts_with(bundled))
                (answers(effect_, other) || answers(other, effect_) ? drawn : stitched)
                    .push_back(&other);
        pictures_ = 2 * kViews.size() + drawn.size();
        // What is wrong alone is wrong with others, and their programs take far longer to compile.
        if (!draws_all({.only = Ids{id_}}, "") || !texts_.empty()) return;
        if (!draws_all({.enable = {id_}}, "with the default effects")) return;
        for (const effect::Effect* other : drawn)
            if (!draws({.only = Ids{id_, other->id()}}, kViews[kOnGround], "with " + other->id()))
                return;
        for (const effect::Effect* other : stitched)
            if (!stitches(registry, {.only = Ids{id_, other->id()}}, "with " + other->id())) return;
    }

  private:
    scene::Scene scene_of(const effect::Switches& switches, const View& view) const {
        scene::Scene scene;
        scene.dems = {(share_dir() / "data/dem/jacksboro.tif").string()};
        scene.width_px = 160;
        scene.height_px = 120;
        scene.time.at = view.time;
        if (view.on_ground) {
            scene.view.eye = {{radians(36.33), radians(-84.20), 300}, /*above_ground=*/true};
            scene.view.heading_deg = 210;
        } else {
            scene.view = scene::parse_view("az=210,el=30");
        }
        scene.effects.switches = switches;
        scene.effects.plugin_path = options_.plugin_path;
        return scene;
    }

    bool draws_all(const effect::Switches& switches, const std::string& with) {
        for (const View& view : kViews)
            if (!draws(switches, view, with)) return false;
        return true;
    }

    /// Whether an effect provides a word that changes the text of another one.
    static bool answers(const effect::Effect& effect, const effect::Effect& asking) {
        const effect::Manifest& manifest = asking.manifest;
        return std::ranges::any_of(effect.manifest.provides, [&](const std::string& word) {
            return contains(manifest.wants, word) || contains(manifest.needs, word);
        });
    }

    /// As draws(), of the texts of the programs alone.
    bool stitches(const effect::Registry& registry, const effect::Switches& switches,
                  const std::string& with) {
        try {
            const effect::Selection selection = effect::select(registry, {}, switches);
            shader::StitchInput input = selection.stitch_input();
            input.values = &session_->effects().values;
            input.max_texture_units = session_->device().max_texture_units;
            render::stitch_frames(shader::FolderTexts(share_dir() / "shaders"), input, {});
        } catch (const Error& error) {
            return reports(error, with);
        }
        return true;
    }

    /// @param with  other effects, for messages; empty: none
    /// @returns false if it cannot be drawn
    bool draws(const effect::Switches& switches, const View& view, const std::string& with) {
        const scene::Scene scene = scene_of(switches, view);
        on_progress_(static_cast<double>(drawn_++) / static_cast<double>(pictures_));
        try {
            if (!session_)
                session_ = std::make_unique<Session>(
                    scene, Options{.device = options_.device, .allow_unmet = true}, files_);
            else
                session_->show(scene, parse(scene.time).utc);
            session_->draw();
            check_numbers(scene, view);
        } catch (const Error& error) {
            if (error.code() == ErrorCode::NoDevice) throw;
            return reports(error, with);
        }
        return true;
    }

    /// @returns false if the error is a mistake
    bool reports(const Error& error, const std::string& with) {
        const std::string what = error.what();
        // Two effects that exclude each other are no mistake.
        if (!with.empty() && what.starts_with("effects: ")) return true;
        for (const std::string& line : author_lines(what))
            report(with.empty() ? line : fmt::format("{} ({})", line, with));
        return false;
    }

    void check_numbers(const scene::Scene& scene, const View& view) {
        const render::NonFinite found = session_->non_finite();
        if (found.count == 0) return;
        const std::optional<NonFiniteCause> cause = session_->non_finite_cause(id_);
        if (!cause || !causes_.insert(cause->function).second) return;
        report(fmt::format(
            "{}:{}: {}: {} NaN or infinite in {} of {} pixels {}, the first in "
            "column {}, row {}; usual causes are a division by 0, a root, power or "
            "logarithm of a negative number, and normalize of a zero vector",
            cause->file, cause->line, cause->function,
            cause->value.empty() ? "it makes light that is" : cause->value + " is", found.count,
            scene.width_px * scene.height_px, view.name, found.first.x, found.first.y));
    }

    void report(const std::string& text) {
        if (texts_.insert(text).second) on_finding_({true, text});
    }

    const effect::Effect& effect_;
    std::string id_;
    const PluginCheckOptions& options_;
    const OnFinding& on_finding_;
    const OnCheckProgress& on_progress_;
    std::size_t pictures_ = 0, drawn_ = 0;  // of all that it draws, and of those so far
    FilesInUse files_;
    std::unique_ptr<Session> session_;
    std::set<std::string> texts_, causes_;
};

/// Whether a path is a plugin's folder, or the folder above it.
bool names(const std::string& path, const fs::path& folder) {
    std::error_code ignored;
    return fs::equivalent(path, folder, ignored) ||
           fs::equivalent(path, fs::absolute(folder, ignored).lexically_normal().parent_path(),
                          ignored);
}

bool is_named(const PluginCheckOptions& options, const fs::path& folder) {
    return std::ranges::any_of(options.paths,
                               [&](const std::string& path) { return names(path, folder); });
}

void check_paths(const PluginCheckOptions& options, const effect::Registry& registry) {
    for (const std::string& path : options.paths) {
        const auto is_of = [&](const auto& folder) { return names(path, folder); };
        const bool any =
            std::ranges::any_of(registry.effects(), is_of,
                                [](const auto& effect) { return effect.manifest.folder; }) ||
            std::ranges::any_of(registry.broken(), is_of, &effect::BrokenEffect::folder);
        if (!any)
            bad_input(
                fmt::format("plugins check: {}: expected a folder with a plugin.json, or of "
                            "such folders",
                            path));
    }
}

}  // namespace

PluginCheckTotals check_plugins(const PluginCheckOptions& options, const OnFinding& on_finding,
                                const OnCheckProgress& on_progress) {
    PluginCheckOptions all = options;
    all.plugin_path.insert(all.plugin_path.end(), options.paths.begin(), options.paths.end());
    const effect::Registry registry =
        effect::Registry::load_installed({all.plugin_path.begin(), all.plugin_path.end()});
    check_paths(options, registry);
    PluginCheckTotals totals;
    const OnFinding report = [&](const effect::Finding& finding) {
        ++(finding.is_error ? totals.errors : totals.warnings);
        on_finding(finding);
    };
    for (const effect::BrokenEffect& broken : registry.broken()) {
        if (!is_named(options, broken.folder)) continue;
        totals.checked.push_back(broken.id);
        for (const std::string& line : author_lines(broken.error))
            report({true, line});
    }
    std::vector<const effect::Effect*> named;
    for (const effect::Effect& effect : registry.effects())
        if (is_named(options, effect.manifest.folder)) named.push_back(&effect);
    for (std::size_t i = 0; i < named.size(); ++i) {
        totals.checked.push_back(named[i]->id());
        const int errors = totals.errors;
        for (const effect::Finding& finding : effect::lint(*named[i], registry))
            report(finding);
        const OnCheckProgress of_all = [&](double share) {
            on_progress((static_cast<double>(i) + share) / static_cast<double>(named.size()));
        };
        if (totals.errors == errors) Check(*named[i], all, report, of_all).run(registry);
    }
    return totals;
}

}  // namespace relevo::session
