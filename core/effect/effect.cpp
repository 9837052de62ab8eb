#include "effect/effect.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/text.h"
#include "shader/limits.h"

namespace relevo::effect {
namespace {

/// Of one file. Drivers need minutes to compile longer ones.
constexpr std::size_t kMaxGlslBytes = std::size_t{1} << 20;

template <typename... Args>
[[noreturn]] void fail(const std::string& file, int line, fmt::format_string<Args...> message,
                       Args&&... args) {
    bad_input(fmt::format("{}: {}:{}: {}", kPluginWho, file, line,
                          fmt::format(message, std::forward<Args>(args)...)));
}

/// @param line  of plugin.json
template <typename... Args>
[[noreturn]] void fail(const Effect& effect, int line, fmt::format_string<Args...> message,
                       Args&&... args) {
    fail(effect.manifest.file.string(), line, message, std::forward<Args>(args)...);
}

/// A parameter of the plugin; null without one.
const shader::Param* find_param(const Effect& effect, const std::string& address) {
    for (const shader::Snippet& snippet : effect.snippets)
        for (const shader::Param& param : snippet.source.params)
            if (param.address == address) return &param;
    return nullptr;
}

/// An entry of plugin.json; null without one.
template <typename Entry>
const Entry* find_named(const std::vector<Entry>& entries, std::string_view name) {
    const auto found = std::ranges::find(entries, name, &Entry::name);
    return found == entries.end() ? nullptr : &*found;
}

std::string glsl_text(const std::filesystem::path& file) {
    std::string text = read_text(file, kPluginWho);
    if (text.size() > kMaxGlslBytes)
        bad_input(fmt::format("{}: {}: expected at most {} KiB but got {}", kPluginWho,
                              file.string(), kMaxGlslBytes >> 10, (text.size() + 1023) >> 10));
    return text;
}

std::string_view sampler_of(TextureSpec::Kind kind) {
    using Kind = TextureSpec::Kind;
    if (kind == Kind::D2Array) return "sampler2DArray";
    return kind == Kind::D2 || kind == Kind::Table ? "sampler2D" : "sampler3D";
}

void check_wants(const Effect& effect) {
    for (const shader::Snippet& snippet : effect.snippets)
        for (const shader::Wanted& wanted : snippet.wanted)
            if (!contains(effect.manifest.wants, wanted.word))
                fail(snippet.file, wanted.line,
                     "HAS_{}: {} does not want it; add \"{}\" to its \"wants\"", wanted.word,
                     effect.manifest.file.string(), wanted.word);
}

/// Textures of core's are there for passes and for hooks of finished pixels.
void check_core_sampler(const shader::Sampler& sampler) {
    std::vector<std::string_view> names;
    for (const shader::CoreTexture& texture : shader::kCoreTextures)
        names.push_back(texture.name);
    if (!contains(names, sampler.resource))
        fail(sampler.file, sampler.line, "{}: expected one of {} but got {}", sampler.name,
             fmt::join(names, ", "), sampler.resource);
    if (sampler.type != "sampler2D")
        fail(sampler.file, sampler.line, "{}: expected a sampler2D for {} but got a {}",
             sampler.name, sampler.resource, sampler.type);
}

/// What a sampler of the plugin's own reads.
struct Readable {
    std::string name;
    std::string_view what, type;  ///< "texture", "sampler2D"
    int line;                     ///< in plugin.json
};

std::vector<Readable> readables(const Manifest& manifest) {
    std::vector<Readable> all;
    for (const TextureSpec& texture : manifest.textures)
        all.push_back({texture.name, "texture", sampler_of(texture.kind), texture.line});
    for (const LinesSpec& lines : manifest.lines)
        all.push_back({lines.name, "lines", "sampler2D", lines.line});
    for (const shader::PluginPass& pass : manifest.passes)
        all.push_back({pass.name, "pass", shader::sampler_of(pass.output), pass.line});
    return all;
}

void check_sampler(const Effect& effect, const shader::Sampler& sampler) {
    const Manifest& manifest = effect.manifest;
    if (sampler.file == manifest.file) return;  // core's, of a raster
    if (sampler.resource.starts_with("core.")) return check_core_sampler(sampler);
    if (!sampler.resource.starts_with(effect.id() + '.')) return;  // another plugin's
    const std::string name = sampler.resource.substr(effect.id().size() + 1);
    const std::vector<Readable> all = readables(manifest);
    if (const Readable* const readable = find_named(all, name)) {
        if (sampler.type != readable->type)
            fail(sampler.file, sampler.line,
                 "{}: expected a {} for the {} {} of {}:{} but got a {}", sampler.name,
                 readable->type, readable->what, name, manifest.file.string(), readable->line,
                 sampler.type);
        return;
    }
    if (!manifest.module.empty()) return;
    if (find_named(manifest.fields, name))
        fail(sampler.file, sampler.line,
             "{0}: a field has no sampler; remove this line and read it by {0}(place_m)",
             sampler.name);
    if (find_named(manifest.rasters, name))
        fail(sampler.file, sampler.line,
             "{0}: a raster has no sampler; remove this line and read it by {0}(s)", sampler.name);
    std::vector<std::string> names;
    for (const Readable& readable : all)
        names.push_back(readable.name);
    const std::optional<std::string> near = nearest(name, names);
    fail(sampler.file, sampler.line, "{}: {} has no texture {}{}", sampler.name,
         manifest.file.string(), name, near ? fmt::format("; did you mean {}?", *near) : "");
}

/// "vec4 haze_pass_blur(in Texel t)"
std::string head_of(const shader::PluginPass& pass) {
    std::string head(shader::signature_of(pass.kind));
    return head.replace(head.find("pass"), 4, pass.function);
}

void check_function(const Effect& effect, const shader::PluginPass& pass) {
    int functions = 0;
    for (const shader::Snippet& snippet : effect.snippets)
        for (const shader::PassFunction& function : snippet.passes) {
            if (function.name != pass.name) continue;
            ++functions;
            if (function.kind != pass.kind)
                fail(snippet.file, function.line,
                     "{}: it is the function of a pass of kind {}, but the kind in {}:{} is {}; "
                     "expected {}",
                     pass.function, word_of(function.kind), effect.manifest.file.string(),
                     pass.line, word_of(pass.kind), head_of(pass));
        }
    if (functions != 1)
        fail(effect, pass.line,
             "passes.{}: expected one function {} in the plugin's GLSL but got {}", pass.name,
             head_of(pass), functions);
}

/// Each pass has one function, and each function of a pass its pass.
void check_passes(const Effect& effect) {
    const Manifest& manifest = effect.manifest;
    for (const shader::PluginPass& pass : manifest.passes) {
        if (find_named(manifest.textures, pass.name))
            fail(effect, pass.line,
                 "passes.{}: a texture of \"textures\" has this name too; rename one", pass.name);
        check_function(effect, pass);
        for (const std::string& address : pass.parameters)
            if (!find_param(effect, address))
                fail(effect, pass.line, "passes.{}: parameters: the plugin has no {}", pass.name,
                     address);
    }
    for (const shader::Snippet& snippet : effect.snippets)
        for (const shader::PassFunction& function : snippet.passes)
            if (!find_named(manifest.passes, function.name))
                fail(snippet.file, function.line,
                     "{0}_pass_{1}: {2} has no pass {1}; add \"passes\": {{\"{1}\": {{}}}}",
                     effect.id(), function.name, manifest.file.string());
}

/// Each set of instances has one function, and each such function its set.
void check_instances(const Effect& effect) {
    for (const shader::InstanceSet& set : effect.manifest.instances) {
        std::ptrdiff_t functions = 0;
        for (const shader::Snippet& snippet : effect.snippets)
            functions += std::ranges::count(snippet.places, set.name, &shader::PlaceFunction::name);
        if (functions != 1)
            fail(effect, set.line,
                 "instances.{}: expected one function void {}(in InstanceSite at, inout Instance "
                 "it) in the plugin's GLSL but got {}",
                 set.name, set.function, functions);
        if (find_named(effect.manifest.passes, set.name))
            fail(effect, set.line, "instances.{}: a pass has this name too; rename one", set.name);
    }
    for (const shader::Snippet& snippet : effect.snippets)
        for (const shader::PlaceFunction& function : snippet.places)
            if (!find_named(effect.manifest.instances, function.name))
                fail(snippet.file, function.line,
                     "{0}_place_{1}: {2} has no instances {1}; add \"instances\": {{\"{1}\": "
                     "{{...}}}}",
                     effect.id(), function.name, effect.manifest.file.string());
}

void check_textures(const Effect& effect) {
    std::set<std::string> read;
    for (const shader::Snippet& snippet : effect.snippets)
        for (const shader::Sampler& sampler : snippet.source.samplers) {
            check_sampler(effect, sampler);
            read.insert(sampler.resource);
        }
    if (!effect.manifest.module.empty()) return;
    for (const TextureSpec& texture : effect.manifest.textures)
        if (!read.contains(texture.resource))
            fail(effect, texture.line,
                 "textures.{}: nothing reads it; expected uniform {} {}_{}; in the plugin's GLSL",
                 texture.name, sampler_of(texture.kind), effect.id(), texture.name);
}

void check_texts(const Effect& effect) {
    for (const shader::TextParam& text : effect.manifest.texts)
        if (find_param(effect, text.address))
            bad_input(
                fmt::format("{}: {}: texts: {} is a parameter of the plugin's GLSL too; "
                            "rename one of them",
                            kPluginWho, effect.manifest.file.string(), text.address));
}

void check_marks(const Effect& effect) {
    for (const MarksSpec& marks : effect.manifest.marks)
        if (const std::string fault = fault_of(marks, effect.params(), effect.manifest.texts,
                                               !effect.manifest.module.empty());
            !fault.empty())
            fail(effect, marks.line, "{}", fault);
}

/// The parameters that a ramp names must be the plugin's own.
void check_ramps(const Effect& effect) {
    for (const shader::ColourRamp& ramp : effect.ramps()) {
        for (const shader::ColourRamp::End& end : {ramp.from, ramp.to}) {
            if (end.of != shader::ColourRamp::End::Of::Param) continue;
            const shader::Param* const param = find_param(effect, end.address);
            if (!param || param->type != shader::ParamType::Float)
                fail(ramp.file, ramp.line,
                     "{}: ramp: expected a number, lowest, highest, floor or a float parameter of "
                     "the plugin's but got {}",
                     ramp.name, end.address);
        }
        if (ramp.where.empty()) continue;
        const shader::Param* const param = find_param(effect, ramp.where);
        if (!param || !contains(param->words, ramp.where_word))
            fail(ramp.file, ramp.line,
                 "{}: where: expected an enum parameter of the plugin's and one of its words but "
                 "got {}, {}",
                 ramp.name, ramp.where, ramp.where_word);
    }
}

/// A parameter that plugin.json names.
struct NamedParam {
    std::string address;
    std::string_view key;
    int line;
    bool may_be_int = false;
};

std::vector<NamedParam> named_params(const Manifest& manifest) {
    std::vector<NamedParam> all;
    if (const auto& displaces = manifest.displaces)
        for (const DisplaceSpec::Length* length : displaces->lengths())
            if (!length->address.empty())
                all.push_back({length->address, "displaces", displaces->line});
    if (const auto& invents = manifest.invents)
        all.push_back({invents->address, "invents", invents->line});
    if (const auto& weather = manifest.weather)
        for (const WeatherSpec::Setting& setting : weather->settings)
            all.push_back({setting.address, "weather.set", setting.line, true});
    for (const Rising& rising : manifest.rising)
        for (const std::string& address : rising.addresses)
            all.push_back({address, "rising", rising.line, true});
    return all;
}

/// They are numbers that users set.
void check_named(const Effect& effect) {
    for (const auto& [address, key, line, may_be_int] : named_params(effect.manifest)) {
        const shader::Param* const param = find_param(effect, address);
        const bool fits = param && (param->type == shader::ParamType::Float ||
                                    (may_be_int && param->type == shader::ParamType::Int));
        // Host parameters are written after the tiles to draw are chosen.
        if (!fits || param->is_host)
            fail(effect, line,
                 "{}: expected a parameter of type float{}, not host, but got \"{}\", which is {}",
                 key, may_be_int ? " or int" : "", address,
                 !param           ? "none of the plugin's"
                 : param->is_host ? "host"
                                  : fmt::format("of type {}", glsl_name(param->type)));
    }
}

/// What windows show first is there, and can be set.
void check_first(const Effect& effect) {
    for (const std::string& address : effect.manifest.first) {
        const shader::Param* const param = find_param(effect, address);
        if (!(param && !param->is_host) &&
            std::ranges::find(effect.manifest.texts, address, &shader::TextParam::address) ==
                effect.manifest.texts.end())
            fail(effect, effect.manifest.first_line,
                 "first: expected parameters and texts of the plugin, not host, but got \"{}\"",
                 address.substr(address.find('.') + 1));
    }
}

/// Without a bound core would cull terrain that is displaced into view.
void check_displace(const Effect& effect) {
    const auto& displaces = effect.manifest.displaces;
    const std::string function = effect.id() + "_on_displace";
    for (const shader::Snippet& snippet : effect.snippets) {
        const shader::HookFunction* const hook = snippet.find("displace");
        if (!hook) continue;
        if (displaces) return;
        fail(snippet.file, hook->line,
             "{}: {} does not say how far it moves the ground; add \"displaces\": {{\"down_m\": "
             "D, \"up_m\": U}} with the most metres down and up, or \"displaces\": {{\"to_m\": "
             "H}} where ground ends between its own height and H",
             function, effect.manifest.file.string());
    }
    if (displaces)
        fail(effect, displaces->line,
             "displaces: no hook moves the ground; define {}, or remove this", function);
}

void check_hooks(const Effect& effect) {
    std::map<std::string_view, std::pair<const shader::Snippet*, int>> defined;
    for (const shader::Snippet& snippet : effect.snippets)
        for (const shader::HookFunction& function : snippet.hooks) {
            const auto [first, is_new] =
                defined.try_emplace(function.hook->name, &snippet, function.line);
            if (!is_new)
                fail(snippet.file, function.line, "{}: defined already in {}:{}", function.name,
                     first->second.first->file, first->second.second);
        }
    if (defined.empty() && effect.manifest.module.empty() && effect.manifest.marks.empty() &&
        effect.manifest.instances.empty())
        bad_input(
            fmt::format("{}: {}: no hook, module, marks or instances, so it does nothing; define a "
                        "function such as {}_on_albedo",
                        kPluginWho, effect.manifest.file.string(), effect.id()));
}

}  // namespace

bool Effect::provides(std::string_view capability) const {
    return contains(manifest.provides, capability);
}

bool Effect::answers(std::string_view hook) const {
    return std::ranges::any_of(snippets,
                               [&](const shader::Snippet& snippet) { return snippet.find(hook); });
}

std::vector<shader::Param> Effect::params() const {
    std::vector<shader::Param> result;
    for (const shader::Snippet& snippet : snippets)
        result.insert(result.end(), snippet.source.params.begin(), snippet.source.params.end());
    return result;
}

std::vector<shader::ColourRamp> Effect::ramps() const {
    std::vector<shader::ColourRamp> result;
    for (const shader::Snippet& snippet : snippets)
        result.insert(result.end(), snippet.source.ramps.begin(), snippet.source.ramps.end());
    return result;
}

Effect load_effect(const std::filesystem::path& folder, const std::filesystem::path& data_dir) {
    Effect effect;
    effect.manifest = load_manifest(folder, data_dir);
    const std::string manifest = effect.manifest.file.string();
    for (const RasterSpec& raster : effect.manifest.rasters)
        effect.snippets.push_back(
            shader::parse_snippet(effect.id(), manifest, raster_glsl(raster, effect.id())));
    for (const FieldSpec& field : effect.manifest.fields)
        effect.snippets.push_back(
            shader::parse_snippet(effect.id(), manifest, field_glsl(field, effect.id())));
    for (const std::filesystem::path& file : effect.manifest.glsl)
        effect.snippets.push_back(
            shader::parse_snippet(effect.id(), file.string(), glsl_text(file)));
    shader::check_growth(effect.snippets);
    for (const auto check :
         {check_hooks, check_ramps, check_named, check_displace, check_first, check_wants,
          check_passes, check_instances, check_textures, check_texts, check_marks})
        check(effect);
    return effect;
}

}  // namespace relevo::effect
