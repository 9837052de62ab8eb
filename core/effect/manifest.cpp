#include "effect/manifest.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/paths.h"
#include "base/text.h"
#include "effect/instance_reader.h"
#include "effect/pass_reader.h"
#include "json/object_reader.h"

namespace relevo::effect {
namespace {

constexpr int kFormat = 1;
constexpr double kMaxDisplaced_m = 1e5;

// Words of core's command line, parameters and timings, and prefixes of its shaders' globals.
constexpr std::array<std::string_view, 68> kReserved = {
    "air",     "all",     "antialias", "backdrop",  "background", "beyond",   "camera",
    "climate", "colour",  "copy",      "core",      "crown",      "data",     "depth",
    "east",    "edge",    "edges",     "end",       "field",      "floor",    "footprint",
    "frame",   "gbuffer", "geometry",  "gl",        "ground",     "height",   "hook",
    "house",   "houses",  "instance",  "instances", "land",       "light",    "lines",
    "load",    "moon",    "net",       "neutral",   "noise",      "none",     "normal",
    "overlay", "page",    "picture",   "pixel",     "place",      "post",     "raster",
    "river",   "scene",   "screen",    "select",    "side",       "slope",    "srgb",
    "steps",   "store",   "stored",    "sun",       "surface",    "surround", "tangent",
    "terrain", "up",      "varyings",  "vertex",    "water"};

constexpr std::size_t kMaxInstanceSets = 16;

// Capabilities that core provides itself: render/core_passes.h.
constexpr std::array<std::string_view, 6> kCoreWords = {"houses", "mapped",  "near",
                                                        "night",  "outside", "water"};

constexpr std::array<std::string_view, 5> kGroups = {"ground", "light", "air", "water", "maps"};
constexpr std::array<std::string_view, 3> kGroundWords = {"water", "marked_holes", "covered_voids"};

bool is_lower(char c) {
    return c >= 'a' && c <= 'z';
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool is_id(std::string_view text) {
    return !text.empty() && is_lower(text[0]) &&
           std::ranges::all_of(text, [](char c) { return is_lower(c) || is_digit(c); });
}

bool is_resource(std::string_view text) {
    const std::size_t dot = text.find('.');
    return dot != std::string_view::npos && is_id(text.substr(0, dot)) &&
           is_word(text.substr(dot + 1));
}

std::vector<std::string> words(json::ObjectReader& object, const std::string& key) {
    std::vector<std::string> result = object.strings(key);
    for (const std::string& word : result)
        if (!is_word(word))
            object.fail(object.line_of(key), key,
                        fmt::format("expected words of a-z, 0-9 and _ but got \"{}\"", word));
    return result;
}

/// @param folder  the plugin's, or the program's data folder, which may have links
std::filesystem::path own_file(const json::ObjectReader& object, int line, const std::string& key,
                               const std::filesystem::path& folder, const std::string& name,
                               bool shared = false) {
    const std::filesystem::path path(name);
    const bool inside =
        path.is_relative() && std::ranges::none_of(path, [](const auto& p) { return p == ".."; });
    if (!inside || (!shared && !file_inside(folder, path)))
        object.fail(line, key,
                    fmt::format("expected a file of the plugin's own folder but got {}", name));
    std::error_code ignored;
    const std::filesystem::path file = folder / path;
    if (!std::filesystem::exists(file, ignored))
        object.fail(line, key, fmt::format("{}: no such file", file.string()));
    if (!std::filesystem::is_regular_file(file, ignored))
        object.fail(line, key, fmt::format("{}: it is not a regular file", file.string()));
    return file;
}

class ManifestReader {
  public:
    ManifestReader(const std::filesystem::path& folder, const std::filesystem::path& data_dir)
        : data_dir_(data_dir) {
        manifest_.folder = folder;
        manifest_.file = folder / "plugin.json";
    }

    Manifest run() {
        const std::string file = manifest_.file.string();
        const json::Value root =
            json::parse(kPluginWho, file, read_text(manifest_.file, kPluginWho));
        json::ObjectReader object(kPluginWho, file, "", root);
        const json::Value& format = object.need("format");
        if (format.kind != json::Value::Kind::Number || format.number != kFormat)
            object.fail(format.line, "format",
                        fmt::format("expected {}, the format that this program reads, but got {}",
                                    kFormat, json::describe(format)));
        identity(object);
        manifest_.provides = words(object, "provides");
        for (const std::string_view word : kCoreWords)
            if (contains(manifest_.provides, word))
                object.fail(object.line_of("provides"), "provides",
                            fmt::format("\"{}\" is core's own word; expected another", word));
        manifest_.exclusive = words(object, "exclusive");
        for (const std::string& word : manifest_.exclusive)
            if (!contains(manifest_.provides, word))
                object.fail(object.line_of("exclusive"), "exclusive",
                            fmt::format("expected words of \"provides\" but got \"{}\"", word));
        manifest_.needs = words(object, "requires");
        manifest_.wants = words(object, "wants");
        manifest_.after = words(object, "after");
        manifest_.module = object.string("module", "");
        if (manifest_.module.find_first_of("/\\") != std::string::npos)
            object.fail(object.line_of("module"), "module",
                        fmt::format("expected the bare name of a library but got \"{}\"",
                                    manifest_.module));
        glsl(object);
        textures(object);
        passes(object);
        instances(object);
        marks(object);
        texts(object);
        displaces(object);
        invents(object);
        manifest_.rising = read_rising(object, manifest_.id);
        if (const json::Value* const value = object.take("weather"))
            manifest_.weather = read_weather_spec(object.inner("weather", *value), manifest_.id);
        object.string("$schema", "");  // which editors look for
        object.finish();
        return std::move(manifest_);
    }

  private:
    void identity(json::ObjectReader& object) {
        manifest_.id = object.string("id");
        if (const std::string fault = fault_of_id(manifest_.id); !fault.empty())
            object.fail(object.line_of("id"), "id", fault);
        manifest_.name = object.string("name");
        manifest_.description = object.string("description", "");
        manifest_.version = object.string("version");
        manifest_.group = object.string("group", "");
        if (!manifest_.group.empty() && !contains(kGroups, manifest_.group))
            object.fail(object.line_of("group"), "group",
                        fmt::format("expected one of {} but got \"{}\"", fmt::join(kGroups, ", "),
                                    manifest_.group));
        manifest_.first_line = object.line_of("first");
        for (const std::string& name : object.strings("first"))
            manifest_.first.push_back(manifest_.id + '.' + name);
        manifest_.enabled_by_default = object.boolean("enabled_by_default", true);
        manifest_.default_where = object.strings("default_where");
        for (const std::string& word : manifest_.default_where)
            if (!contains(kGroundWords, word))
                object.fail(object.line_of("default_where"), "default_where",
                            fmt::format("expected words of {} but got \"{}\"",
                                        fmt::join(kGroundWords, ", "), word));
    }

    void glsl(json::ObjectReader& object) {
        const int line = object.line_of("glsl");
        const bool given = object.take("glsl") != nullptr;
        std::vector<std::string> names = object.strings("glsl");
        const std::string usual = manifest_.id + ".glsl";
        if (!given) {
            std::error_code ignored;
            const bool there = std::filesystem::is_regular_file(manifest_.folder / usual, ignored);
            if (there || manifest_.module.empty()) names = {usual};
        }
        for (const std::string& name : names)
            manifest_.glsl.push_back(own_file(object, line, "glsl", manifest_.folder, name));
    }

    /// Reads an object whose members have one kind.
    /// @param what  the kind, for messages
    /// @param read  is called with the name and a reader of the value
    template <typename Read>
    void named(json::ObjectReader& object, const std::string& key, std::string_view what,
               const Read& read) {
        const json::Value* const list = object.take(key);
        if (!list) return;
        if (list->kind != json::Value::Kind::Object)
            object.fail(list->line, key,
                        fmt::format("expected an object of name and {} but got {}", what,
                                    json::describe(*list)));
        for (const auto& [name, value] : list->members) {
            if (!is_word(name))
                object.fail(value.line, key,
                            fmt::format("expected words of a-z, 0-9 and _ but got \"{}\"", name));
            json::ObjectReader entry = object.inner(key + "." + name, value);
            read(name, entry);
            entry.finish();
        }
    }

    void textures(json::ObjectReader& object) {
        named(object, "textures", "texture",
              [&](const std::string& name, json::ObjectReader& entry) { texture(name, entry); });
    }

    void texture(const std::string& name, json::ObjectReader& object) {
        const std::string& id = manifest_.id;
        const int line = object.line();
        const std::size_t kind = object.choice(
            "kind", {"2d", "2d-array", "3d", "table", "cube", "raster", "lines", "field"});
        if (kind == 7)
            manifest_.fields.push_back(read_field_spec(object, id, name, line));
        else if (kind == 6)
            manifest_.lines.push_back(read_lines_spec(object, id, name, line));
        else if (kind == 5)
            manifest_.rasters.push_back(read_raster_spec(object, id, name, line));
        else
            own_texture(object, manifest_.textures.emplace_back(
                                    TextureSpec{.name = name,
                                                .resource = id + '.' + name,
                                                .kind = static_cast<TextureSpec::Kind>(kind),
                                                .line = line}));
    }

    void own_texture(json::ObjectReader& object, TextureSpec& spec) const {
        const bool is_table =
            spec.kind == TextureSpec::Kind::Table || spec.kind == TextureSpec::Kind::Cube;
        is_table ? table_texture(object, spec) : file_texture(object, spec);
    }

    /// A table in a file of the plugin, or in one that the user chooses.
    void table_texture(json::ObjectReader& object, TextureSpec& spec) const {
        spec.wrap = TextureSpec::Wrap::Clamp;
        spec.mipmaps = false;
        const std::string file = object.string("file", ""), from = object.string("from", "");
        if (file.empty() == from.empty())
            object.fail(spec.line, "", "expected a \"file\" of the plugin, or a text \"from\"");
        if (from.empty())
            spec.files.push_back(data_file(object, "file", file));
        else
            spec.from = manifest_.id + '.' + from;
    }

    void file_texture(json::ObjectReader& object, TextureSpec& spec) const {
        if (spec.kind == TextureSpec::Kind::D2Array) {
            for (const std::string& file : object.strings("files"))
                spec.files.push_back(data_file(object, "files", file));
            if (spec.files.empty())
                object.fail(object.line_of("files"), "files",
                            "expected a list of files, one a layer");
        } else {
            spec.files.push_back(data_file(object, "file", object.string("file")));
        }
        if (spec.kind == TextureSpec::Kind::D3)
            spec.slices = static_cast<int>(object.number("slices", 1, 1, 2048, true));
        spec.srgb = object.choice("encoding", {"linear", "srgb"}) == 1;
        spec.wrap = static_cast<TextureSpec::Wrap>(object.choice("wrap", {"repeat", "clamp"}, 0));
        spec.mipmaps = object.boolean("mipmaps", true);
    }

    void passes(json::ObjectReader& object) {
        named(object, "passes", "pass", [&](const std::string& name, json::ObjectReader& entry) {
            manifest_.passes.push_back(read_pass(entry, manifest_.id, name));
        });
        complete_passes(object, manifest_.passes);
    }

    void instances(json::ObjectReader& object) {
        named(object, "instances", "meshes",
              [&](const std::string& name, json::ObjectReader& entry) {
                  manifest_.instances.push_back(read_instance_set(
                      entry, manifest_.id, name,
                      [&](const json::ObjectReader& level, const std::string& key,
                          const std::string& file) { return data_file(level, key, file); }));
              });
        if (manifest_.instances.size() > kMaxInstanceSets)
            object.fail(object.line_of("instances"), "instances",
                        fmt::format("expected at most {} but got {}", kMaxInstanceSets,
                                    manifest_.instances.size()));
    }

    std::filesystem::path data_file(const json::ObjectReader& object, const std::string& key,
                                    const std::string& name) const {
        constexpr std::string_view kShared = "data:";
        const bool shared = name.substr(0, kShared.size()) == kShared;
        return own_file(object, object.line_of(key), key, shared ? data_dir_ : manifest_.folder,
                        shared ? name.substr(kShared.size()) : name, shared);
    }

    void marks(json::ObjectReader& object) {
        named(object, "marks", "marks", [&](const std::string& name, json::ObjectReader& entry) {
            manifest_.marks.push_back(read_marks(entry, manifest_.id, name));
        });
    }

    void texts(json::ObjectReader& object) {
        named(object, "texts", "text", [&](const std::string& name, json::ObjectReader& entry) {
            manifest_.texts.push_back(text(name, entry));
        });
        bool reads_texts = !manifest_.module.empty() || !manifest_.marks.empty();
        // Data names a text of the plugin.
        const auto check = [&](const auto& data, const std::string& address, bool is_file) {
            if (address.empty()) return;
            check_text(object, "textures." + data.name, data.line, address, is_file);
            reads_texts = true;
        };
        for (const LinesSpec& lines : manifest_.lines)
            check(lines, lines.file, true);
        for (const FieldSpec& field : manifest_.fields)
            check(field, field.file, true);
        for (const TextureSpec& texture : manifest_.textures)
            check(texture, texture.from, true);
        for (const RasterSpec& raster : manifest_.rasters) {
            check(raster, raster.file, true);
            check(raster, raster.colours, false);
        }
        if (!reads_texts && !manifest_.texts.empty())
            object.fail(
                object.line_of("texts"), "texts",
                "expected a \"module\", \"marks\", or data of \"textures\", that reads them");
    }

    void check_text(const json::ObjectReader& object, const std::string& key, int line,
                    const std::string& address, bool is_file) const {
        const auto text = std::ranges::find(manifest_.texts, address, &shader::TextParam::address);
        if (text == manifest_.texts.end() || (is_file && !text->is_file))
            object.fail(line, key,
                        fmt::format("expected a text{}; add \"texts\": {{\"{}\": {{{}}}}}",
                                    is_file ? " of kind \"file\"" : "",
                                    address.substr(address.find('.') + 1),
                                    is_file ? "\"kind\": \"file\"" : ""));
    }

    shader::TextParam text(const std::string& name, json::ObjectReader& object) const {
        shader::TextParam text;
        text.address = manifest_.id + '.' + name;
        text.is_file = object.choice("kind", {"text", "file"}, 0) == 1;
        text.label = object.string("label", name);
        text.description = object.string("description", "");
        text.initial = object.string("default", "");
        if (text.is_file && !text.initial.empty())
            text.initial = data_file(object, "default", text.initial).string();
        return text;
    }

    void displaces(json::ObjectReader& object) {
        const json::Value* const value = object.take("displaces");
        if (!value) return;
        json::ObjectReader bound = object.inner("displaces", *value);
        DisplaceSpec& spec = manifest_.displaces.emplace();
        spec.line = value->line;
        spec.down = length(bound, "down_m", 0);
        spec.up = length(bound, "up_m", 0);
        spec.aside = length(bound, "aside_m", 0);
        if (bound.take("to_m")) spec.to = length(bound, "to_m", -kMaxDisplaced_m);
        bound.finish();
    }

    void invents(json::ObjectReader& object) {
        const json::Value* const value = object.take("invents");
        if (!value) return;
        json::ObjectReader said = object.inner("invents", *value);
        Invention& invention = manifest_.invents.emplace();
        invention.line = value->line;
        invention.what = said.string("what");
        const std::string by = said.string("by");
        if (!is_word(by))
            said.fail(said.line_of("by"), "by",
                      fmt::format("expected a parameter of the plugin's own, such as \"strength\", "
                                  "but got \"{}\"",
                                  by));
        invention.address = manifest_.id + '.' + by;
        invention.pixel_posts = said.number("pixel_posts", 1, 0, 1e6, false);
        invention.post_m = said.number("post_m", 0, 0, 1e6, false);
        said.finish();
    }

    /// @param min  of a number [m]
    DisplaceSpec::Length length(json::ObjectReader& object, const std::string& key,
                                double min) const {
        const json::Value* const value = object.take(key);
        if (!value) return {};
        const std::string prefix = manifest_.id + '.';
        if (value->kind == json::Value::Kind::Number && value->number >= min &&
            value->number <= kMaxDisplaced_m)
            return {value->number, {}};
        if (value->kind == json::Value::Kind::String &&
            value->text.substr(0, prefix.size()) == prefix && is_resource(value->text))
            return {0, value->text};
        object.fail(value->line, key,
                    fmt::format("expected metres from {:g} to {:g}, or a parameter such as "
                                "\"{}height_m\", but got {}",
                                min, kMaxDisplaced_m, prefix, json::describe(*value)));
    }

    Manifest manifest_;
    const std::filesystem::path& data_dir_;
};

}  // namespace

bool is_word(std::string_view text) {
    return !text.empty() && is_lower(text[0]) && text.back() != '_' &&
           text.find("__") == std::string_view::npos &&
           std::ranges::all_of(text, [](char c) { return is_lower(c) || is_digit(c) || c == '_'; });
}

std::span<const std::string_view> ground_words() {
    return kGroundWords;
}

bool is_core_word(std::string_view word) {
    return contains(kCoreWords, word);
}

std::string fault_of_id(std::string_view text) {
    if (!is_id(text))
        return fmt::format("expected a letter a-z and then letters and digits but got \"{}\"",
                           text);
    if (contains(kReserved, text))
        return fmt::format("{} is a word of core's; choose another", text);
    return {};
}

Manifest load_manifest(const std::filesystem::path& folder, const std::filesystem::path& data_dir) {
    return ManifestReader(folder, data_dir).run();
}

}  // namespace relevo::effect
