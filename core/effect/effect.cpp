#include "effect/effect.h"

#include <algorithm>

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

[[noreturn]] void fail(const std::string& file, int line, const std::string& message) {
    bad_input(fmt::format("{}: {}:{}: {}", kPluginWho, file, line, message));
}

std::string glsl_text(const std::filesystem::path& file) {
    std::string text = read_text(file, kPluginWho);
    if (text.size() > kMaxGlslBytes)
        bad_input(fmt::format("{}: {}: expected at most {} KiB but got {}", kPluginWho,
                              file.string(), kMaxGlslBytes >> 10, (text.size() + 1023) >> 10));
    return text;
}

std::string_view sampler_of(TextureSpec::Kind kind) {
    switch (kind) {
        case TextureSpec::Kind::D2:
            return "sampler2D";
        case TextureSpec::Kind::D2Array:
            return "sampler2DArray";
        case TextureSpec::Kind::Table:
            return "sampler2D";
        default:
            return "sampler3D";
    }
}

void check_wants(const Effect& effect) {
    for (const shader::Snippet& snippet : effect.snippets)
        for (const shader::Wanted& wanted : snippet.wanted)
            if (!contains(effect.manifest.wants, wanted.word))
                fail(snippet.file, wanted.line,
                     fmt::format("HAS_{}: {} does not want it; add \"{}\" to its \"wants\"",
                                 wanted.word, effect.manifest.file.string(), wanted.word));
}

/// Textures of core's are there for passes and for hooks of finished pixels.
void check_core_sampler(const shader::Sampler& sampler) {
    std::vector<std::string> names;
    for (const shader::CoreTexture& texture : shader::kCoreTextures)
        names.emplace_back(texture.name);
    if (!contains(names, sampler.resource))
        fail(sampler.file, sampler.line,
             fmt::format("{}: expected one of {} but got {}", sampler.name, fmt::join(names, ", "),
                         sampler.resource));
    if (sampler.type != "sampler2D")
        fail(sampler.file, sampler.line,
             fmt::format("{}: expected a sampler2D for {} but got a {}", sampler.name,
                         sampler.resource, sampler.type));
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
    const std::string prefix = effect.id() + '.';
    if (sampler.resource.substr(0, prefix.size()) != prefix) return;  // another plugin's
    const std::string name = sampler.resource.substr(prefix.size());
    std::vector<std::string> names;
    for (const Readable& readable : readables(manifest)) {
        names.push_back(readable.name);
        if (readable.name != name) continue;
        if (sampler.type != readable.type)
            fail(sampler.file, sampler.line,
                 fmt::format("{}: expected a {} for the {} {} of {}:{} but got a {}", sampler.name,
                             readable.type, readable.what, name, manifest.file.string(),
                             readable.line, sampler.type));
        return;
    }
    if (!manifest.module.empty()) return;
    if (std::ranges::find(manifest.fields, name, &FieldSpec::name) != manifest.fields.end())
        fail(sampler.file, sampler.line,
             fmt::format("{0}: a field has no sampler; remove this line and read it by "
                         "{0}(place_m)",
                         sampler.name));
    if (std::ranges::find(manifest.rasters, name, &RasterSpec::name) != manifest.rasters.end())
        fail(sampler.file, sampler.line,
             fmt::format("{0}: a raster has no sampler; remove this line and read it by {0}(s)",
                         sampler.name));
    const std::optional<std::string> near = nearest(name, names);
    fail(sampler.file, sampler.line,
         fmt::format("{}: {} has no texture {}{}", sampler.name, manifest.file.string(), name,
                     near ? fmt::format("; did you mean {}?", *near) : ""));
}

const shader::PluginPass* find_pass(const Effect& effect, std::string_view name) {
    const auto found = std::ranges::find(effect.manifest.passes, name, &shader::PluginPass::name);
    return found == effect.manifest.passes.end() ? nullptr : &*found;
}

/// "vec4 haze_pass_blur(in Texel t)"
std::string head_of(const shader::PluginPass& pass) {
    std::string head(shader::signature_of(pass.kind));
    return head.replace(head.find("pass"), 4, pass.function);
}

void check_function(const Effect& effect, const shader::PluginPass& pass) {
    const Manifest& manifest = effect.manifest;
    int functions = 0;
    for (const shader::Snippet& snippet : effect.snippets)
        for (const shader::PassFunction& function : snippet.passes) {
            if (function.name != pass.name) continue;
            ++functions;
            if (function.kind != pass.kind)
                fail(snippet.file, function.line,
                     fmt::format("{}: it is the function of a pass of kind {}, but the kind in "
                                 "{}:{} is {}; expected {}",
                                 pass.function, word_of(function.kind), manifest.file.string(),
                                 pass.line, word_of(pass.kind), head_of(pass)));
        }
    if (functions != 1)
        fail(manifest.file.string(), pass.line,
             fmt::format("passes.{}: expected one function {} in the plugin's GLSL but got {}",
                         pass.name, head_of(pass), functions));
}

/// Each pass has one function, and each function of a pass its pass.
void check_passes(const Effect& effect) {
    const Manifest& manifest = effect.manifest;
    const std::vector<shader::Param> params = effect.params();
    for (const shader::PluginPass& pass : manifest.passes) {
        const std::string key = "passes." + pass.name;
        if (std::ranges::find(manifest.textures, pass.name, &TextureSpec::name) !=
            manifest.textures.end())
            fail(manifest.file.string(), pass.line,
                 fmt::format("{}: a texture of \"textures\" has this name too; rename one", key));
        check_function(effect, pass);
        for (const std::string& address : pass.parameters)
            if (std::ranges::find(params, address, &shader::Param::address) == params.end())
                fail(manifest.file.string(), pass.line,
                     fmt::format("{}: parameters: the plugin has no {}", key, address));
    }
    for (const shader::Snippet& snippet : effect.snippets)
        for (const shader::PassFunction& function : snippet.passes)
            if (!find_pass(effect, function.name))
                fail(snippet.file, function.line,
                     fmt::format("{}_pass_{}: {} has no pass {}; add \"passes\": {{\"{}\": {{}}}}",
                                 effect.id(), function.name, manifest.file.string(), function.name,
                                 function.name));
}

/// Each set of instances has one function, and each such function its set.
void check_instances(const Effect& effect) {
    const std::string file = effect.manifest.file.string();
    std::vector<std::string> names;
    for (const shader::InstanceSet& set : effect.manifest.instances) {
        names.push_back(set.name);
        std::ptrdiff_t functions = 0;
        for (const shader::Snippet& snippet : effect.snippets)
            functions += std::ranges::count(snippet.places, set.name, &shader::PlaceFunction::name);
        if (functions != 1)
            fail(
                file, set.line,
                fmt::format("instances.{}: expected one function void {}(in InstanceSite at, inout "
                            "Instance it) in the plugin's GLSL but got {}",
                            set.name, set.function, functions));
        if (find_pass(effect, set.name))
            fail(file, set.line,
                 fmt::format("instances.{}: a pass has this name too; rename one", set.name));
    }
    for (const shader::Snippet& snippet : effect.snippets)
        for (const shader::PlaceFunction& function : snippet.places)
            if (!contains(names, function.name))
                fail(snippet.file, function.line,
                     fmt::format("{0}_place_{1}: {2} has no instances {1}; add \"instances\": "
                                 "{{\"{1}\": {{...}}}}",
                                 effect.id(), function.name, file));
}

void check_textures(const Effect& effect) {
    for (const shader::Snippet& snippet : effect.snippets)
        for (const shader::Sampler& sampler : snippet.source.samplers)
            check_sampler(effect, sampler);
    if (!effect.manifest.module.empty()) return;
    for (const TextureSpec& texture : effect.manifest.textures) {
        const bool read = std::ranges::any_of(effect.snippets, [&](const shader::Snippet& snippet) {
            const auto& samplers = snippet.source.samplers;
            return std::ranges::any_of(samplers, [&](const auto& sampler) {
                return sampler.resource == texture.resource;
            });
        });
        if (!read)
            fail(effect.manifest.file.string(), texture.line,
                 fmt::format("textures.{}: nothing reads it; expected uniform {} {}_{}; in the "
                             "plugin's GLSL",
                             texture.name, sampler_of(texture.kind), effect.id(), texture.name));
    }
}

void check_texts(const Effect& effect) {
    const std::vector<shader::Param> params = effect.params();
    for (const shader::TextParam& text : effect.manifest.texts)
        for (const shader::Param& param : params)
            if (param.address == text.address)
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
            fail(effect.manifest.file.string(), marks.line, fault);
}

/// The parameters that a ramp names must be the plugin's own.
void check_ramps(const Effect& effect) {
    const std::vector<shader::Param> params = effect.params();
    const auto find = [&](const std::string& address) {
        const auto found =
            std::ranges::find_if(params, [&](const auto& p) { return p.address == address; });
        return found == params.end() ? nullptr : &*found;
    };
    for (const shader::ColourRamp& ramp : effect.ramps()) {
        for (const shader::ColourRamp::End& end : {ramp.from, ramp.to}) {
            if (end.of != shader::ColourRamp::End::Of::Param) continue;
            const shader::Param* const param = find(end.address);
            if (!param || param->type != shader::ParamType::Float)
                fail(ramp.file, ramp.line,
                     fmt::format("{}: ramp: expected a number, lowest, highest, floor or a float "
                                 "parameter of the plugin's but got {}",
                                 ramp.name, end.address));
        }
        if (ramp.where.empty()) continue;
        const shader::Param* const param = find(ramp.where);
        if (!param || !contains(param->words, ramp.where_word))
            fail(ramp.file, ramp.line,
                 fmt::format("{}: where: expected an enum parameter of the plugin's and one of its "
                             "words but got {}, {}",
                             ramp.name, ramp.where, ramp.where_word));
    }
}

/// @param key, line  of plugin.json, which name the parameter
void check_named(const Effect& effect, const std::string& address, std::string_view key, int line) {
    const std::vector<shader::Param> params = effect.params();
    const auto param =
        std::ranges::find_if(params, [&](const shader::Param& p) { return p.address == address; });
    // Host parameters are written after the tiles to draw are chosen.
    if (param == params.end() || param->type != shader::ParamType::Float || param->is_host)
        fail(effect.manifest.file.string(), line,
             fmt::format("{}: expected a parameter of type float, not host, but got \"{}\", which "
                         "is {}",
                         key, address,
                         param == params.end() ? "none of the plugin's"
                         : param->is_host      ? "host"
                                               : "of type " + std::string(glsl_name(param->type))));
}

/// A parameter of one number, which users set.
void check_number(const Effect& effect, const std::string& address, std::string_view key,
                  int line) {
    const std::vector<shader::Param> params = effect.params();
    const auto param = std::ranges::find(params, address, &shader::Param::address);
    const bool number =
        param != params.end() && !param->is_host &&
        (param->type == shader::ParamType::Float || param->type == shader::ParamType::Int);
    if (!number)
        fail(effect.manifest.file.string(), line,
             fmt::format("{}: expected a float or int parameter of the plugin's, not host, but "
                         "got \"{}\"",
                         key, address));
}

void check_bound(const Effect& effect, const DisplaceSpec& spec) {
    for (const DisplaceSpec::Length* length : spec.lengths())
        if (!length->address.empty()) check_named(effect, length->address, "displaces", spec.line);
}

/// What windows show first is there, and can be set.
void check_first(const Effect& effect) {
    const std::vector<shader::Param> params = effect.params();
    for (const std::string& address : effect.manifest.first) {
        const bool is_param = std::ranges::any_of(params, [&](const shader::Param& param) {
            return param.address == address && !param.is_host;
        });
        const auto& texts = effect.manifest.texts;
        if (!is_param &&
            std::ranges::find(texts, address, &shader::TextParam::address) == texts.end())
            fail(
                effect.manifest.file.string(), effect.manifest.first_line,
                fmt::format("first: expected parameters and texts of the plugin, not host, but got "
                            "\"{}\"",
                            address.substr(address.find('.') + 1)));
    }
}

/// Without a bound core would cull terrain that is displaced into view.
void check_displace(const Effect& effect) {
    const Manifest& manifest = effect.manifest;
    const std::string function = effect.id() + "_on_displace";
    if (manifest.displaces) check_bound(effect, *manifest.displaces);
    for (const shader::Snippet& snippet : effect.snippets) {
        const shader::HookFunction* const hook = snippet.find("displace");
        if (!hook) continue;
        if (manifest.displaces) return;
        fail(snippet.file, hook->line,
             fmt::format("{}: {} does not say how far it moves the ground; add \"displaces\": "
                         "{{\"down_m\": D, \"up_m\": U}} with the most metres down and up, or "
                         "\"displaces\": {{\"to_m\": H}} where ground ends between its own height "
                         "and H",
                         function, manifest.file.string()));
    }
    if (manifest.displaces)
        fail(manifest.file.string(), manifest.displaces->line,
             fmt::format("displaces: no hook moves the ground; define {}, or remove this",
                         function));
}

void check_hooks(const Effect& effect) {
    for (const shader::Snippet& snippet : effect.snippets) {
        for (const shader::HookFunction& function : snippet.hooks) {
            for (const shader::Snippet& other : effect.snippets) {
                if (&other == &snippet) break;
                if (const shader::HookFunction* first = other.find(function.hook->name))
                    fail(snippet.file, function.line,
                         fmt::format("{}: defined already in {}:{}", function.name, other.file,
                                     first->line));
            }
        }
    }
    const bool any = std::ranges::any_of(effect.snippets,
                                         [](const shader::Snippet& s) { return !s.hooks.empty(); });
    if (!any && effect.manifest.module.empty() && effect.manifest.marks.empty() &&
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
    check_hooks(effect);
    shader::check_growth(effect.snippets);
    check_ramps(effect);
    check_displace(effect);
    if (const auto& invents = effect.manifest.invents)
        check_named(effect, invents->address, "invents", invents->line);
    if (const auto& weather = effect.manifest.weather)
        for (const WeatherSpec::Setting& setting : weather->settings)
            check_number(effect, setting.address, "weather.set", setting.line);
    for (const Rising& rising : effect.manifest.rising)
        for (const std::string& address : rising.addresses)
            check_number(effect, address, "rising", rising.line);
    check_first(effect);
    check_wants(effect);
    check_passes(effect);
    check_instances(effect);
    check_textures(effect);
    check_texts(effect);
    check_marks(effect);
    return effect;
}

}  // namespace relevo::effect
