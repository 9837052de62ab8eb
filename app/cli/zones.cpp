#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files_in_use.h"
#include "base/log.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/shared.h"
#include "zones/zone_package.h"
#include "zones/zone_sums.h"

namespace relevo::cli {
namespace {

using zones::ZoneRow;

struct ZonesArguments {
    std::vector<std::string> rasters;
    std::string zones, id, weights;
    std::optional<double> above;
    ResultArguments output;
    bool json = false;
};

struct Figure {
    const char* name;
    double ZoneRow::*value;
};
constexpr Figure kFigures[] = {{"cells", &ZoneRow::cells},
                               {"area_m2", &ZoneRow::area_m2},
                               {"area_valid_m2", &ZoneRow::area_valid_m2},
                               {"mean", &ZoneRow::mean},
                               {"integral", &ZoneRow::integral},
                               {"min", &ZoneRow::min},
                               {"max", &ZoneRow::max},
                               {"share_above", &ZoneRow::share_above}};

/// A zone over a band of a raster.
struct Line {
    std::string raster, id;
    std::size_t band = 1;
    ZoneRow row;
};

struct Lines {
    std::vector<Line> lines;
    bool of_rasters = false, of_bands = false;  ///< columns that tell them apart are needed
};

Lines lines_of(const ZonesArguments& arguments, const zones::ZoneFile& file) {
    zones::SumOptions options{.weights = {}, .above = arguments.above};
    if (!arguments.weights.empty())
        options.weights =
            arguments.weights == "crs" ? zones::Weights::Crs : zones::Weights::Ellipsoid;
    Lines result{.lines = {}, .of_rasters = arguments.rasters.size() > 1, .of_bands = false};
    for (const std::string& raster : arguments.rasters) {
        auto bands = zones::sum_zones(file, raster, options);
        result.of_bands = result.of_bands || bands.size() > 1;
        for (std::size_t band = 0; band < bands.size(); ++band)
            for (std::size_t i = 0; i < bands[band].size(); ++i)
                result.lines.push_back(
                    {raster, file.zones[i].id, band + 1, std::move(bands[band][i])});
    }
    return result;
}

zones::ZoneTable table_of(const Lines& result) {
    zones::ZoneTable table;
    if (result.of_rasters) table.columns.push_back({"raster", true});
    if (result.of_bands) table.columns.push_back({"band", false});
    table.columns.push_back({"zone", true});
    for (const Figure& figure : kFigures)
        table.columns.push_back({figure.name, false});
    table.columns.push_back({"error", true});
    for (const Line& line : result.lines) {
        std::vector<std::string>& row = table.rows.emplace_back();
        if (result.of_rasters) row.push_back(line.raster);
        if (result.of_bands) row.push_back(fmt::format("{}", line.band));
        row.push_back(line.id);
        for (const Figure& figure : kFigures) {
            const double value = line.row.*figure.value;
            row.push_back(std::isnan(value) ? "" : fmt::format("{:.12g}", value));
        }
        row.push_back(line.row.fault);
    }
    return table;
}

/// RFC 4180.
std::string quoted(const std::string& field) {
    if (field.find_first_of("\",\r\n") == std::string::npos) return field;
    std::string text = "\"";
    for (const char c : field)
        text += c == '"' ? std::string("\"\"") : std::string(1, c);
    return text + '"';
}

std::string csv_of(const zones::ZoneTable& table) {
    std::string text;
    for (const auto& column : table.columns)
        text += (text.empty() ? "" : ",") + column.name;
    text += '\n';
    for (const std::vector<std::string>& row : table.rows) {
        for (std::size_t i = 0; i < row.size(); ++i)
            text += (i > 0 ? "," : "") + quoted(row[i]);
        text += '\n';
    }
    return text;
}

nlohmann::ordered_json json_of(const Lines& result) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const Line& line : result.lines) {
        nlohmann::ordered_json& row = rows.emplace_back();
        if (result.of_rasters) row["raster"] = line.raster;
        if (result.of_bands) row["band"] = line.band;
        row["zone"] = line.id;
        for (const Figure& figure : kFigures)
            row[figure.name] = line.row.*figure.value;  // NaN becomes null
        row["error"] = nullptr;
        if (!line.row.fault.empty()) row["error"] = line.row.fault;
    }
    return {{"schema", "relevo-zones-1"}, {"zones", std::move(rows)}};
}

/// Names the zones that have no figures, a few of them one by one.
void say_faults(const Lines& result) {
    constexpr std::size_t kMostNamed = 10;
    std::size_t faults = 0;
    for (const Line& line : result.lines)
        if (!line.row.fault.empty() && faults++ < kMostNamed)
            log::warning(fmt::format("zone {}: {}", printable(line.id), line.row.fault));
    if (faults > kMostNamed)
        log::warning(fmt::format("{} more zones have no figures; column error says why",
                                 faults - kMostNamed));
    if (faults == result.lines.size()) bad_input("--zones: no zone has a figure");
}

void run_zones(const ZonesArguments& arguments) {
    FilesInUse files;
    OutputFile* file = nullptr;
    if (!arguments.output.path.empty()) {
        arguments.output.check_ending();
        files.add_input(arguments.zones, "the zones");
        for (const std::string& raster : arguments.rasters)
            files.add_input(raster, "a raster");
        file = &files.open_output(arguments.output.path, arguments.output.overwrite, "-o");
    }
    const zones::ZoneFile zones = zones::read_zones(arguments.zones, arguments.id);
    if (!zones.crs)
        log::info(fmt::format("{}: no CRS; that of the raster is assumed", arguments.zones));
    const Lines result = lines_of(arguments, zones);
    const std::string ending = arguments.output.ending();
    if (ending == "gpkg")
        zones::write_package(*file, arguments.zones, table_of(result));
    else if (file)
        file->write(ending == "json" ? json_text(json_of(result)) : csv_of(table_of(result)));
    if (file) files.finish_outputs();
    if (arguments.json)
        fmt::print("{}", json_text(json_of(result)));
    else if (!file)
        fmt::print("{}", csv_of(table_of(result)));
    say_faults(result);
}

}  // namespace

void add_zones(Verb app) {
    const auto arguments = std::make_shared<ZonesArguments>();
    const Verb verb =
        app.add_verb("zones", "Tables what rasters come to by zone: mean, sum, range, share");
    verb.add_option("RASTER", arguments->rasters, "RASTER...: of figures or of anything else")
        .required();
    verb.add_option("--zones", arguments->zones,
                    "Polygons: GeoPackage, GeoJSON, FlatGeobuf or Shapefile, in any CRS")
        .required();
    verb.add_option("--id", arguments->id,
                    "Field that names a zone (default: the feature's number in the file)");
    verb.add_option("--above", arguments->above,
                    "Share of a zone's values that are greater, as share_above")
        .check(any_number());
    verb.add_option("--weights", arguments->weights,
                    "What a cell weighs: crs, all the same; ellipsoid, its area on WGS 84 "
                    "(ellipsoid for rasters in degrees, else crs)")
        .check(one_of({"crs", "ellipsoid"}));
    arguments->output.endings = {"csv", "json", "gpkg"};
    verb.add_option("-o,--output", arguments->output.path, "Write csv, json, gpkg");
    verb.add_flag("--overwrite", arguments->output.overwrite, "Replace an existing file");
    verb.add_flag("--json", arguments->json, "One JSON object on standard output");
    verb.callback([arguments] { run_zones(*arguments); });
}

}  // namespace relevo::cli
