#include "effect/registry.h"

#include <algorithm>
#include <new>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/paths.h"
#include "base/text.h"
#include "effect/search_path.h"

namespace relevo::effect {
namespace {

/// Whether there is a plugin.json, readable or not.
bool is_plugin(const std::filesystem::path& folder) {
    std::error_code ignored;
    return std::filesystem::exists(
        std::filesystem::symlink_status(folder / "plugin.json", ignored));
}

/// The folder's own name, also if the path is ".".
std::string name_of(const std::filesystem::path& folder) {
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::absolute(folder, error).lexically_normal();
    return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

/// One name for a folder, whichever way it is named.
std::filesystem::path one_name(const std::filesystem::path& folder) {
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::canonical(folder, error);
    return error ? folder : whole;
}

std::vector<std::filesystem::path> plugin_folders(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_directory(path, error))
        bad_input(fmt::format("plugin: {}: no such folder", path.string()));
    if (is_plugin(path)) return {path};
    std::vector<std::filesystem::path> folders;
    for (std::filesystem::directory_iterator entry(path, error), end; !error && entry != end;
         entry.increment(error))
        if (is_plugin(entry->path())) folders.push_back(entry->path());
    if (error)
        bad_input(fmt::format("plugin: {}: cannot be read, {}", path.string(), error.message()));
    // The file system's order is arbitrary.
    std::ranges::sort(folders);
    return folders;
}

}  // namespace

Registry Registry::load(const std::vector<std::filesystem::path>& search_paths,
                        const std::filesystem::path& data_dir) {
    Registry registry;
    registry.search_paths_ = search_paths;
    std::set<std::filesystem::path> seen;
    for (const std::filesystem::path& path : search_paths) {
        for (const std::filesystem::path& folder : plugin_folders(path)) {
            // Two search paths may have the same folder.
            if (!seen.insert(one_name(folder)).second) continue;
            std::string id = name_of(folder);
            try {
                Effect effect = load_effect(folder, data_dir);
                id = effect.id();
                if (const Effect* first = registry.find(id))
                    bad_input(fmt::format(
                        "plugin: {}: the id {} is taken by {}; remove one of the two",
                        effect.manifest.file.string(), id, first->manifest.file.string()));
                registry.effects_.push_back(std::move(effect));
            } catch (const Error& error) {
                registry.broken_.push_back({id, folder, error.what()});
            } catch (const std::bad_alloc&) {
                registry.broken_.push_back(
                    {id, folder,
                     fmt::format("plugin: {}: there is not enough memory to read it",
                                 folder.string())});
            }
        }
    }
    std::ranges::sort(registry.effects_, {}, &Effect::id);
    return registry;
}

Registry Registry::load_installed(const std::vector<std::filesystem::path>& extra) {
    return load(plugin_search_path(extra), share_dir() / "data");
}

const Effect* Registry::find(std::string_view id) const {
    const auto found = std::ranges::find(effects_, id, &Effect::id);
    return found == effects_.end() ? nullptr : &*found;
}

bool Registry::is_broken(std::string_view id) const {
    return !find(id) && std::ranges::find(broken_, id, &BrokenEffect::id) != broken_.end();
}

const Effect& Registry::effect(std::string_view id, std::string_view who) const {
    if (const Effect* found = find(id)) return *found;
    if (const auto broken = std::ranges::find(broken_, id, &BrokenEffect::id);
        broken != broken_.end())
        bad_input(
            fmt::format("{}: {}: this plugin could not be loaded: {}", who, id, broken->error));
    std::vector<std::string> ids;
    for (const Effect& effect : effects_)
        ids.push_back(effect.id());
    const std::optional<std::string> near = nearest(id, ids);
    bad_input(fmt::format(
        "{}: {}: no such plugin; {}", who, id,
        near ? fmt::format("did you mean {}?", *near)
             : fmt::format("there are {}", ids.empty() ? std::string("none")
                                                       : fmt::format("{}", fmt::join(ids, ", ")))));
}

std::vector<shader::Param> Registry::params() const {
    std::vector<shader::Param> result;
    for (const Effect& effect : effects_) {
        const std::vector<shader::Param> own = effect.params();
        result.insert(result.end(), own.begin(), own.end());
    }
    return result;
}

std::vector<shader::TextParam> Registry::texts() const {
    std::vector<shader::TextParam> result;
    for (const Effect& effect : effects_)
        result.insert(result.end(), effect.manifest.texts.begin(), effect.manifest.texts.end());
    return result;
}

std::vector<std::string> Registry::provided_words() const {
    std::set<std::string> words;
    for (const Effect& effect : effects_)
        words.insert(effect.manifest.provides.begin(), effect.manifest.provides.end());
    return {words.begin(), words.end()};
}

}  // namespace relevo::effect
