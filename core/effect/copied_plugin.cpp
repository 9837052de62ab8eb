// The copy of an effect under another id.
#include <algorithm>
#include <regex>
#include <set>

#include <fmt/format.h>

#include "base/text.h"
#include "effect/instance_reader.h"
#include "effect/new_plugin.h"

namespace relevo::effect {
namespace {

namespace fs = std::filesystem;

/// Renames an effect in its files.
class Renaming {
  public:
    Renaming(const Effect& effect, const std::string& id) : from_(effect.id()), to_(id) {
        for (const shader::Snippet& snippet : effect.snippets)
            add_globals(snippet.source);
        for (const shader::PluginPass& pass : effect.manifest.passes)
            names_.insert(pass.output_name());
    }

    /// haze.glsl -> mist.glsl
    std::string file(const std::string& name) const {
        return name.starts_with(from_ + ".") ? to_ + name.substr(from_.size()) : name;
    }

    std::string glsl(const shader::Source& source) const {
        std::vector<Edit> edits;
        std::string_view before;
        source.each([&](const shader::Token& token) {
            const std::string_view word = source.str(token);
            if (before != "." && names_.contains(word))
                edits.push_back({token.offset, from_.size(), to_});
            before = word;
        });
        for (const shader::Comment& comment : shader::tokenize(source.text, source.file).comments)
            edits.push_back({comment.offset, comment.length,
                             prose(std::string(shader::text_of(source.text, comment)))});
        std::ranges::sort(edits, std::ranges::greater(), &Edit::offset);
        std::string text = source.text;
        for (const Edit& edit : edits)
            text.replace(edit.offset, edit.length, edit.text);
        return text;
    }

    /// haze.density and haze_density in a text for people.
    std::string prose(const std::string& text) const {
        return std::regex_replace(text, std::regex("\\b" + from_ + "(?=[._][a-z])"), to_);
    }

    /// The manifest, which keeps its lines.
    std::string manifest(std::string text, const std::string& name) const {
        const auto replace = [&](const std::string& pattern, const std::string& by) {
            text = std::regex_replace(text, std::regex(pattern), by,
                                      std::regex_constants::format_first_only);
        };
        text = std::regex_replace(text, std::regex("\"" + from_ + "\\."), "\"" + to_ + ".");
        replace("(\"id\"\\s*:\\s*)\"" + from_ + "\"", "$1\"" + to_ + "\"");
        replace("(\"name\"\\s*:\\s*)\"[^\"]*\"", "$1\"" + name + "\"");
        // Two of one kind would both draw.
        replace("\\s*\"enabled_by_default\"\\s*:\\s*(true|false)\\s*,", "");
        replace(",\\s*\"enabled_by_default\"\\s*:\\s*(true|false)", "");  // the last member
        replace("(\\s*)(\"version\"\\s*:)", "$1\"enabled_by_default\": false,$1$2");
        return text;
    }

    /// README.md without pictures and links, which the copy does not have.
    std::string readme(const std::string& text, const std::string& name) const {
        std::string result;
        for (const std::string& line : split(text, '\n')) {
            if (line.starts_with("![")) continue;
            result += result.empty() ? "# " + name : line;
            result += '\n';
        }
        while (result.ends_with("\n\n"))
            result.pop_back();
        result =
            std::regex_replace(result, std::regex("\\[([^\\]]*)\\]\\((?!https?:)[^)]*\\)"), "$1");
        return prose(result);
    }

  private:
    struct Edit {
        std::size_t offset, length;
        std::string text;
    };

    void add_globals(const shader::Source& source) {
        for (const shader::Item& item : source.items)
            names_.insert(item.names.begin(), item.names.end());
        for (const shader::Lifted& lifted : source.lifted())
            names_.insert(lifted.name);
    }

    std::string from_, to_;
    std::set<std::string, std::less<>> names_;  // globals of the effect
};

}  // namespace

PluginFiles copied_plugin(const std::string& id, const Effect& effect) {
    const Renaming renaming(effect, id);
    const std::string name = name_of(id);
    const fs::path folder = effect.manifest.folder;
    PluginFiles files{
        {"plugin.json", renaming.manifest(read_text(effect.manifest.file, "plugins new"), name)}};
    std::set<std::string> done{"plugin.json", "README.md", "CMakeLists.txt", "golden.png"};
    for (const shader::Snippet& snippet : effect.snippets) {
        if (snippet.file == effect.manifest.file) continue;  // core's, of a raster
        const std::string file = fs::path(snippet.file).lexically_relative(folder).string();
        files.emplace_back(renaming.file(file), renaming.glsl(snippet.source));
        done.insert(file);
    }
    std::string readme = fmt::format("# {}\n", name);
    std::error_code error;
    if (fs::is_regular_file(folder / "README.md", error))
        readme = renaming.readme(read_text(folder / "README.md", "plugins new"), name);
    files.emplace_back("README.md",
                       fmt::format("{}\nA copy of {} {}.\n\n{}", readme, effect.id(),
                                   effect.manifest.version, usage_section(id, /*is_on=*/false)));
    std::vector<fs::path> data = mesh_files(effect.manifest);
    for (const TextureSpec& texture : effect.manifest.textures)
        data.insert(data.end(), texture.files.begin(), texture.files.end());
    for (const fs::path& path : data) {
        const std::string file = path.lexically_relative(folder).string();
        if (!file.starts_with("..") && done.insert(file).second)
            files.emplace_back(renaming.file(file), read_text(path, "plugins new"));
    }
    return files;
}

}  // namespace relevo::effect
