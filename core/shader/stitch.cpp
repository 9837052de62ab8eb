#include "shader/stitch.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/error.h"
#include "shader/stage.h"
#include "shader/stored_varyings.h"
#include "shader/text_builder.h"
#include "shader/texture_units.h"

namespace relevo::shader {
namespace {

std::string zero_of(const std::string& type) {
    if (type == "float") return "0.0";
    if (type == "int") return "0";
    if (type == "uint") return "0u";
    if (type[0] == 'i') return type + "(0)";
    if (type[0] == 'u') return type + "(0u)";
    return type + "(0.0)";
}

std::string define_text(const Define& define) {
    return define.value.empty() ? fmt::format("#define {}", define.name)
                                : fmt::format("#define {} {}", define.name, define.value);
}

class Stitcher {
  public:
    Stitcher(const CoreTexts& core, const ProgramRecipe& program, const StitchInput& input)
        : program_(program), input_(input), library_(core) {
        if (!program.compute_main.empty()) {
            compute_.emplace(library_, program, input, StageKind::Compute);
            return;
        }
        vertex_.emplace(library_, program, input, StageKind::Vertex);
        fragment_.emplace(library_, program, input, StageKind::Fragment);
        if (!program.shaded_by.empty()) {
            shading_recipe_ = program;
            shading_recipe_.fragment_main = program.shaded_by;
            shading_.emplace(library_, shading_recipe_, input, StageKind::Fragment);
        }
    }

    Stitched run() {
        if (compute_)
            compute_->reach({});
        else
            reach_drawn();
        read_params();
        assign_units();
        if (compute_) result_.compute = write(*compute_);
        if (vertex_) result_.vertex = write(*vertex_);
        if (fragment_) result_.fragment = write(*fragment_);
        for (const Stage* stage : stages()) {
            for (const Hook& hook : hooks())
                note_use(*stage, hook);
            note_plugins(*stage);
        }
        add_names();
        return std::move(result_);
    }

  private:
    std::vector<const Stage*> stages() const {
        std::vector<const Stage*> all;
        for (const std::optional<Stage>* stage : {&vertex_, &fragment_, &compute_})
            if (*stage) all.push_back(&**stage);
        return all;
    }

    /// Finds what the stages of a program that draws need.
    void reach_drawn() {
        // The fragment stage first: the varyings that it reads decide which vertex hooks are
        // called.
        fragment_->reach({});
        std::vector<const Stage*> readers{&*fragment_};
        if (shading_) {
            shading_->reach({});
            readers.push_back(&*shading_);
        }
        vertex_->reach(readers);
        for (const Stage* reader : readers)
            check_varyings(*reader);
        if (shading_) stored_ = StoredVaryings(*shading_, program_name());
        if (loads()) stored_ = StoredVaryings(*fragment_, program_name());
        result_.varying_targets = stored_.targets();
    }

    ParamValue value_of(const Param& param) const {
        const Param* const known = input_.values ? input_.values->find(param.address) : nullptr;
        return known && known->type == param.type ? input_.values->value(param.address)
                                                  : param.initial;
    }

    bool is_constant(const Param& param) const {
        if (param.is_static || param.is_host || !input_.constants) return param.is_static;
        const bool divides = param.type != ParamType::Bool && param.words.empty();
        const ParamValue value = value_of(param);
        return !divides || std::none_of(value.begin(), value.begin() + component_count(param.type),
                                        [](double component) { return component == 0; });
    }

    void read_params() {
        std::vector<Param> params;
        for (const Snippet* snippet : input_.snippets)
            std::ranges::copy_if(snippet->source.params, std::back_inserter(params),
                                 [&](const Param& param) { return !is_constant(param); });
        result_.params = block_layout(params);
    }

    void assign_units() {
        units_ = TextureUnits(stages(), input_);
        if (loads() && stored_.targets() > 0)
            units_.add_core(StoredVaryings::kTexture, "sampler2DArray");
        units_.check(program_name(), input_.max_texture_units);
        result_.textures = units_.units();
    }

    std::string program_name() const {
        return compute_ ? program_.compute_main
                        : program_.vertex_main + " + " + program_.fragment_main;
    }

    /// Whether this is a shading program, which loads the varyings of a geometry program.
    bool loads() const { return !program_.geometry_of.empty(); }

    // ---- varyings

    void check_varyings(const Stage& reader) const {
        for (const Varying* read : reader.varyings()) {
            // The shading program loads them from textures. The geometry program checks them.
            if (loads() && reader.owner_of(read->name) != "core") continue;
            const Varying* const written = vertex_->find_varying(read->name);
            const std::string where =
                fmt::format("shader: {}:{}: {}", read->file, read->line, read->name);
            if (!written || !vertex_->reaches(read->name))
                throw AuthorError(
                    reader.owner_of(read->name),
                    fmt::format("{}: the fragment stage reads it ({}), but nothing that {} "
                                "calls writes it",
                                where, reader.trail(read->name), program_.vertex_main));
            if (qualified(*written) != qualified(*read))
                failed(fmt::format("{}: expected {} as in {}:{} but got {}", where,
                                   qualified(*written), written->file, written->line,
                                   qualified(*read)));
        }
    }

    /// "flat int"
    static std::string qualified(const Varying& varying) {
        return varying.interpolation.empty() ? varying.type
                                             : varying.interpolation + ' ' + varying.type;
    }

    // ---- text

    StageText write(Stage& stage) {
        TextBuilder out;
        out.line("#version 450 core");
        for (const Define& define : program_.defines)
            out.line(define_text(define));
        for (const Define& define : stage.has_macros())
            out.line(define_text(define));
        write_unit(out, stage.unit(UnitRole::Types));
        write_unit(out, stage.unit(UnitRole::Frame));
        write_params(out, stage);
        units_.write(out, stage);
        write_varyings(out, stage);
        // Before its readers: Mesa warns if a global is read above the line that sets it.
        if (stage.kind() == StageKind::Fragment && loads()) stored_.write_load(out);
        write_prototypes(out, stage);
        write_declarations(out);
        for (const Unit& unit : stage.units())
            if (unit.role == UnitRole::Lib) write_unit(out, unit);
        write_unit(out, stage.unit(UnitRole::Defaults));
        write_snippets(out, stage);
        out.heading("hooks");
        for (const Hook& hook : hooks())
            if (stage.calls(hook)) write_hook(out, stage, hook);
        if (stage.kind() == StageKind::Fragment && shading_) stored_.write_store(out);
        write_unit(out, stage.unit(UnitRole::Main));
        return out.take();
    }

    static void write_unit(TextBuilder& out, const Unit& unit) {
        out.heading(fmt::format("{}: {}", unit.source->owner, unit.title));
        for (std::size_t i = 0; i < unit.source->items.size(); ++i)
            if (unit.kept[i]) out.item(*unit.source, unit.source->items[i]);
        out.heading("");
    }

    static LineOrigin origin(const Stage& stage, const std::string& name, const std::string& file,
                             int line) {
        return {stage.owner_of(name), file, line};
    }

    void write_params(TextBuilder& out, const Stage& stage) {
        out.heading("parameters");
        const bool block = std::ranges::any_of(
            result_.params.members,
            [&](const BlockMember& member) { return stage.reaches(member.param.name); });
        if (block) {
            result_.uses_params = true;
            out.line("layout(std140, binding = 1) uniform Params {");
            for (const auto& [param, offset] : result_.params.members)
                out.line(fmt::format("    {} {};", glsl_name(param.type), param.name),
                         origin(stage, param.name, param.file, param.line));
            out.line("};");
        }
        for (const Snippet* snippet : input_.snippets) {
            for (const Param& param : snippet->source.params) {
                if (!is_constant(param) || !stage.reaches(param.name)) continue;
                out.line(fmt::format("const {} {} = {};", glsl_name(param.type), param.name,
                                     glsl_value(param, value_of(param))),
                         origin(stage, param.name, param.file, param.line));
            }
        }
        out.heading("");
    }

    /// Whether a fragment stage reads a varying of the vertex stage.
    bool is_handed_on(const Varying& varying) const {
        return fragment_->reaches(varying.name) || stored_.holds(varying);
    }

    void write_varyings(TextBuilder& out, const Stage& stage) {
        out.heading("varyings");
        const bool fragment = stage.kind() == StageKind::Fragment;
        const auto write_one = [&](const Varying& varying, const Stage& declared_in) {
            const LineOrigin from = origin(declared_in, varying.name, varying.file, varying.line);
            const bool plain =
                fragment && loads() ? stored_.holds(varying) : !fragment && !is_handed_on(varying);
            // A plain global: it is loaded from a texture, or no one reads it. An output would be
            // interpolated in vain.
            if (plain)
                out.line(fmt::format("{} {};", varying.type, varying.name), from);
            else
                out.line(
                    fmt::format("{}{} {} {};",
                                varying.interpolation.empty() ? "" : varying.interpolation + ' ',
                                fragment ? "in" : "out", varying.type, varying.name),
                    from);
        };
        for (const Varying* varying : stage.varyings())
            write_one(*varying, stage);
        if (fragment && shading_)
            for (const StoredVaryings::Stored& stored : stored_.all())
                if (!stage.reaches(stored.varying->name)) write_one(*stored.varying, *shading_);
        out.heading("");
    }

    void write_prototypes(TextBuilder& out, const Stage& stage) {
        out.heading("prototypes");
        for (const Hook& hook : hooks())
            if (stage.needs_prototype(hook)) out.line(stage.head(hook) + ';');
        out.heading("");
    }

    void write_declarations(TextBuilder& out) {
        out.heading("work group and output");
        for (const std::string& line : program_.declarations)
            out.line(line);
        out.heading("");
    }

    void write_snippets(TextBuilder& out, const Stage& stage) {
        std::vector<std::string> macros;
        const std::vector<Unit>& units = stage.units();
        for (std::size_t i = 0; i < units.size(); ++i) {
            if (units[i].role != UnitRole::Snippet) continue;
            write_unit(out, units[i]);
            const std::vector<Item>& items = units[i].source->items;
            for (std::size_t k = 0; k < items.size(); ++k)
                if (units[i].kept[k] && items[k].kind == Item::Kind::Macro &&
                    !contains(macros, items[k].names[0]))
                    macros.push_back(items[k].names[0]);
            if (i + 1 < units.size() && units[i + 1].source->owner == units[i].source->owner)
                continue;
            for (const std::string& macro : macros)
                out.line("#undef " + macro);
            macros.clear();
        }
    }

    void write_hook(TextBuilder& out, const Stage& stage, const Hook& hook) {
        const Signature signature = parse_signature(hook.signature);
        std::vector<std::string> names;
        for (const Argument& argument : signature.arguments)
            names.push_back(argument.name);
        const std::string arguments = fmt::format("({});", fmt::join(names, ", "));
        const std::string answer = signature.type == "void" ? "    " : "    return ";

        out.line(stage.head(hook) + " {");
        if (const Hook* const chain = stage.chain_after(hook))
            return write_with_chain(out, stage.called_functions(hook).front(), *chain);
        if (hook.name == "vertex")
            for (const Varying* varying : stage.varyings())
                if (stage.owner_of(varying->name) != "core" && is_handed_on(*varying))
                    out.line(fmt::format("    {} = {};", varying->name, zero_of(varying->type)));
        for (const std::string& function : stage.called_functions(hook))
            out.line(answer + function + arguments);
        out.line("}");
    }

    /// Body of background_radiance(): the chain gets the sky without disc and stars, and dims these
    /// by the transmittance.
    static void write_with_chain(TextBuilder& out, const std::string& provider, const Hook& chain) {
        out.line(fmt::format("    vec3 radiance = {}(direction, false);", provider));
        out.line("    vec3 transmittance = vec3(1.0);");
        out.line(
            fmt::format("    vec3 behind = with_disc ? {}(direction, true) - radiance : "
                        "vec3(0.0);",
                        provider));
        out.line(fmt::format("    hook_{}(direction, radiance, transmittance);", chain.name));
        out.line("    return radiance + transmittance * behind;");
        out.line("}");
    }

    void note_use(const Stage& stage, const Hook& hook) {
        if (!stage.calls(hook)) return;
        const auto known = std::ranges::find_if(
            result_.hooks, [&](const HookUse& use) { return use.hook->name == hook.name; });
        if (known == result_.hooks.end())
            result_.hooks.push_back({find_hook(hook.name), stage.providers(hook)});
    }

    void note_plugins(const Stage& stage) {
        for (const Unit& unit : stage.units())
            if (unit.role == UnitRole::Snippet && contains(unit.kept, true) &&
                !contains(result_.plugins, unit.source->owner))
                result_.plugins.push_back(unit.source->owner);
    }

    void add_names() {
        for (const Snippet* snippet : input_.snippets) {
            for (const Item& item : snippet->source.items)
                result_.names.insert(result_.names.end(), item.names.begin(), item.names.end());
            for (const Lifted& lifted : snippet->source.lifted())
                result_.names.push_back(lifted.name);
            for (const Param& param : snippet->source.params)
                if (!is_constant(param)) result_.values.push_back(param.name);
        }
    }

    const ProgramRecipe& program_;
    const StitchInput& input_;
    CoreLibrary library_;
    std::optional<Stage> vertex_, fragment_;  // of a program that draws
    std::optional<Stage> compute_;            // of a compute program
    ProgramRecipe shading_recipe_;
    std::optional<Stage> shading_;
    StoredVaryings stored_;
    TextureUnits units_;
    Stitched result_;
};

}  // namespace

Stitched stitch(const CoreTexts& core, const ProgramRecipe& program, const StitchInput& input) {
    return Stitcher(core, program, input).run();
}

}  // namespace relevo::shader
