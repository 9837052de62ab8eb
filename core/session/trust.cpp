#include "session/trust.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/allowed_name.h"
#include "base/contains.h"
#include "base/error.h"
#include "base/log.h"
#include "base/paths.h"
#include "base/text.h"
#include "effect/registry.h"
#include "effect/search_path.h"

namespace relevo::session {
namespace {

/// One name for a folder, whichever way it is named.
std::string absolute(const std::string& folder) {
    std::error_code unknown;
    const std::filesystem::path whole = std::filesystem::weakly_canonical(folder, unknown);
    return unknown ? folder : (whole / "").parent_path().string();  // without a slash at its end
}

}  // namespace

Trust::Trust(Named given, std::string file, NamedBy by)
    : given_(std::move(given)), file_(std::move(file)), by_(by) {
    if (given_.all) allow_all_names();
    for (const std::string& folder : given_.plugin_folders)
        named_.push_back(absolute(folder));
    // Their plugins are loaded whether or not a scene names the folder.
    for (const std::filesystem::path& folder : effect::user_plugin_folders())
        named_.push_back(absolute(folder.string()));
}

void Trust::check_names(const scene::Scene& scene) const {
    const auto check = [&](const char* key, const std::string& name) {
        if (!is_allowed(name))
            bad_usage(
                fmt::format("{}: {}: '{}' is not a file of this machine; name it on the "
                            "command line, or add --trust",
                            file_, key, printable(name)));
    };
    for (const std::string& name : scene.dems)
        check("dem.files", name);
    if (scene.overlay) {
        check("overlay.file", scene.overlay->file);
        check("overlay.colours", scene.overlay->colours);
    }
    check("land_cover", scene.land_cover.file);
    check("land_cover_classes", scene.land_cover.classes);
    check("weather", scene.forecast);
    for (const std::string& preset : scene.effects.presets)
        check("effects.presets", preset);
}

/// The plugins below a folder that have no native module.
std::vector<std::string> Trust::without_modules(const std::string& folder) {
    std::vector<std::string> folders;
    const effect::Registry registry = effect::Registry::load({folder}, share_dir() / "data");
    for (const effect::Effect& effect : registry.effects())
        (effect.manifest.module.empty() ? folders : modules_)
            .push_back(effect.manifest.folder.string());
    for (const effect::BrokenEffect& broken : registry.broken())
        modules_.push_back(broken.folder.string());
    return folders;
}

const Trust::Known& Trust::folder(const std::string& name) {
    const auto known = known_.find(name);
    if (known != known_.end()) return known->second;
    Known folder{absolute(name), Folder::LeftOut, {name}};
    if (contains(named_, folder.path))
        folder.kind = Folder::Named;
    else if (given_.all)
        folder.kind = Folder::Allowed;
    else if (!contains(left_out_, folder.path))
        left_out_.push_back(folder.path);
    if (folder.kind == Folder::Allowed && by_ == NamedBy::Picture)
        folder.folders = without_modules(name);
    return known_.emplace(name, std::move(folder)).first->second;
}

void Trust::keep_folders(scene::Effects& effects) {
    std::vector<std::string> kept;
    for (const std::string& name : std::exchange(effects.plugin_path, {})) {
        const Known& of = folder(name);
        if (of.kind == Folder::LeftOut || contains(kept, of.path)) continue;
        kept.push_back(of.path);
        effects.plugin_path.insert(effects.plugin_path.end(), of.folders.begin(), of.folders.end());
    }
}

std::vector<std::string> Trust::warnings() const {
    std::vector<std::string> lines;
    const auto add = [&](const std::vector<std::string>& folders, const char* what,
                         const char* otherwise) {
        if (folders.empty()) return;
        const std::string first = printable(folders.front());
        const std::string more =
            folders.size() == 1 ? "" : fmt::format(" and {} more", folders.size() - 1);
        lines.push_back(fmt::format("{}: {} {}{} are not used; add --plugin-path {}{}", file_, what,
                                    first, more, first, otherwise));
    };
    add(left_out_, "plugins of", ", or --trust for all");
    add(modules_, "native modules of", "");
    return lines;
}

void Trust::tell() const {
    for (const std::string& line : warnings())
        log::warning(line);
}

}  // namespace relevo::session
