#include "command_tree.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/text.h"
#include "cli/command_line.h"
#include "effect/preset.h"
#include "effect/registry.h"
#include "sun/zone_of_place.h"

namespace relevo::commands {
namespace {

/// What completes the values of options that are neither numbers nor words that the option lists
/// itself. An option that is in none of the rows is an error, so that none is forgotten.
struct Row {
    Kind kind;
    std::vector<std::string> options;
    std::vector<std::string> words{};
};

const std::vector<Row>& rows() {
    static const std::vector<Row> all = {
        {Kind::File,
         {"DEM",         "-o",       "--scene", "--save-scene", "--from",       "--timings",
          "--overlay",   "--points", "--times", "--along",      "--save-job",   "--contact-sheet",
          "JOB",         "A",        "B",       "GOLDEN",       "OUTPUT",       "--slurm",
          "--parallel",  "--stac",   "--tiles", "--weather",    "--land-cover", "--horizon",
          "--irradiance"}},
        {Kind::File, {"--surroundings", "--zones", "RASTER"}},
        {Kind::Text, {"--id"}},
        {Kind::Folder, {"--plugin-path", "--dump-shaders", "--into", "FOLDER", "PATH", "PLUGIN"}},
        {Kind::Effect, {"--enable", "--disable", "--only", "--order", "--ab", "ID"}},
        {Kind::Parameter, {"--set", "--vary"}},
        {Kind::Preset, {"--preset"}},
        {Kind::Zone, {"--tz"}},
        {Kind::Words, {"--device"}, {"auto", "software"}},
        {Kind::Words, {"--unit"}, {"m", "ft", "us-ft", "cm", "mm", "dm", "km"}},
        {Kind::Words,
         {"--view"},
         {"top", "north", "north-east", "east", "south-east", "south", "south-west", "west",
          "north-west", "az=210,el=30"}},
        {Kind::Words,
         {"--overlay-colours"},
         {"sun", "shade", "steel", "viridis", "inferno", "grey"}},
        {Kind::Words, {"--land-cover-classes"}, {"worldcover", "nlcd", "corine"}},
        {Kind::Words, {"--time", "--start"}, {"sunrise", "sunset", "noon", "now"}},
        {Kind::Words, {"--motion"}, {"day", "year", "orbit", "flight"}},
        {Kind::Words, {"--co"}, {"COMPRESS=", "LEVEL=", "BLOCKSIZE=", "OVERVIEWS="}},
        {Kind::Lists,
         {"--stamp"},
         {"title", "scale", "north", "graticule", "date", "sun", "attribution", "all", "none"}},
        {Kind::Lists,
         {"--layers"},
         {"depth", "normal", "position", "shadow", "albedo", "ids", "all"}},
        {Kind::Lists,
         {"--bands"},
         {"hours", "first", "last", "spells", "global", "beam", "diffuse", "reflected"}},
        {Kind::Words, {"--format"}, {"png", "jpg", "webp", "avif", "tif", "exr"}},
        {Kind::Words, {"--nodata"}, {"none"}},
        {Kind::Words, {"--tilt"}, {"ground"}},
        {Kind::Words, {"--interval"}, {"end", "begin", "instant"}},
        {Kind::Words, {"--base"}, {"auto"}},
        {Kind::Words, {"--crs", "--clip-crs", "--points-crs", "--at-crs"}, {"EPSG:"}},
        {Kind::Text, {"--crop",  "--bounds",  "--date",          "--name",          "--to",
                      "--title", "--size",    "--overlay-title", "--overlay-range", "--range",
                      "--scale", "--look-at", "--eye",           "--attribution",   "--at",
                      "--sun",   "--step",    "--span",          "--shard",         "--over",
                      "--clip",  "--azimuth", "--linke",         "--href-base",     "NAME"}},
    };
    return all;
}

/// "a,b" of "TEXT:{a,b}"; nothing of other types.
std::optional<std::vector<std::string>> listed(const std::string& type) {
    const std::size_t open = type.find('{'), close = type.find('}');
    if (open == std::string::npos || close == std::string::npos) return std::nullopt;
    return split(std::string_view(type).substr(open + 1, close - open - 1), ',');
}

/// Of two options of one name: --from is a day of `sun`, a file elsewhere.
bool is_a_day(const std::string& command, const std::string& name) {
    return name == "--from" &&
           (command.starts_with("relevo sun") || command.starts_with("relevo moon") ||
            command.starts_with("relevo plan sun"));
}

bool complete(Option& option, const std::string& type, const std::string& command) {
    if (const auto words = listed(type)) {
        option.kind = Kind::Words;
        option.words = *words;
        return true;
    }
    std::vector<std::string> names = option.names;
    if (names.empty()) names.push_back(option.value);
    for (const std::string& name : names) {
        if (is_a_day(command, name)) return true;
        for (const Row& row : rows())
            if (std::ranges::find(row.options, name) != row.options.end()) {
                option.kind = row.kind;
                option.words = row.words;
                return true;
            }
    }
    return type.starts_with("INT") || type.starts_with("FLOAT");
}

Option option_of(const CLI::Option& from, const std::string& command,
                 std::vector<std::string>& unknown) {
    Option option;
    for (const std::string& name : from.get_lnames())
        option.names.push_back("--" + name);
    for (const std::string& name : from.get_snames())
        option.names.push_back("-" + name);
    if (from.get_positional()) option.names.clear();
    option.text = from.get_description();
    option.group = from.get_group();
    option.needed = from.get_required();
    option.many = from.get_items_expected_max() > 1;
    if (from.get_items_expected_max() == 0) {
        option.kind = Kind::Flag;
        return option;
    }
    const std::string type = from.get_type_name();
    option.value = from.get_positional()                                  ? from.get_name(true)
                   : type.starts_with("TEXT")                             ? "VALUE"
                   : type.starts_with("INT") || type.starts_with("FLOAT") ? "NUMBER"
                                                                          : type;
    if (!complete(option, type, command))
        unknown.push_back(command + " " +
                          (option.names.empty() ? option.value : option.names.front()));
    if (option.kind == Kind::File && !option.names.empty()) option.value = "FILE";
    if (option.kind == Kind::Folder && !option.names.empty()) option.value = "FOLDER";
    return option;
}

Command command_of(const CLI::App& from, const std::string& name,
                   std::vector<std::string>& unknown) {
    Command command{name, from.get_description(), {}, {}, {}};
    for (const CLI::Option* option : from.get_options())
        (option->get_positional() ? command.positionals : command.options)
            .push_back(option_of(*option, name, unknown));
    for (const CLI::App* inner : from.get_subcommands({}))
        command.commands.push_back(command_of(*inner, name + " " + inner->get_name(), unknown));
    return command;
}

}  // namespace

Command all_commands() {
    CLI::App app{"Relevo: shows any DEM in the sunlight of a date", "relevo"};
    cli::add_verbs(app);
    std::vector<std::string> unknown;
    Command all = command_of(app, "relevo", unknown);
    if (!unknown.empty())
        failed(fmt::format("command_tree.cpp: rows() does not say what completes {}",
                           fmt::join(unknown, ", ")));
    return all;
}

Installed installed() {
    Installed values;
    const effect::Registry registry = effect::Registry::load_installed();
    for (const effect::Effect& effect : registry.effects())
        values.effects[effect.manifest.id] = effect.manifest.description;
    for (const shader::Param& param : registry.params())
        values.parameters[param.address] = param.description;
    for (const std::string& name : effect::preset_names())
        values.presets.push_back(name);
    values.zones = sun::ZoneMap::shipped().names();
    std::ranges::sort(values.zones);
    values.zones.insert(values.zones.begin(), {"auto", "solar", "UTC"});
    return values;
}

}  // namespace relevo::commands
