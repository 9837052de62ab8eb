#include "cli/plane_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"
#include "base/units.h"
#include "cli/sun_options.h"

namespace relevo::cli {
namespace {

using light::SumBy;
using nlohmann::ordered_json;

ordered_json hour_json(const light::PlaneHour& hour, const sun::Zone& zone) {
    return {{"time", sun::to_iso(hour.span.begin, zone)},
            {"up_s", hour.up_s},
            {"lit_s", hour.lit_s},
            {"azimuth_deg", degrees(hour.azimuth_rad)},
            {"elevation_deg", degrees(hour.elevation_rad)},
            {"ghi_w_m2", hour.ghi},
            {"dni_w_m2", hour.dni},
            {"dhi_w_m2", hour.dhi},
            {"beam_w_m2", hour.beam},
            {"diffuse_w_m2", hour.diffuse},
            {"reflected_w_m2", hour.reflected},
            {"global_w_m2", hour.global()},
            {"open_global_w_m2", hour.open_global}};
}

ordered_json sum_json(SumBy by, const light::PlaneSum& sum, bool typical) {
    ordered_json json;
    const std::string date = sun::to_string(sum.date);
    if (by == SumBy::Day) json["date"] = date;
    if (by == SumBy::Month) json["month"] = date.substr(0, 7);
    if (by == SumBy::Year)
        json["year"] = typical ? ordered_json("typical") : ordered_json(sum.date.year);
    if (by == SumBy::HourOfMonth) {
        json["month"] = sum.date.month;
        json["hour"] = sum.hour;
    }
    json["lit_h"] = sum.lit_s / kHour_s;
    json["beam_kwh_m2"] = sum.beam_wh / 1000;
    json["diffuse_kwh_m2"] = sum.diffuse_wh / 1000;
    json["reflected_kwh_m2"] = sum.reflected_wh / 1000;
    json["global_kwh_m2"] = sum.global_wh() / 1000;
    json["open_global_kwh_m2"] = sum.open_global_wh / 1000;
    return json;
}

std::vector<ordered_json> records_of(const PlaneTable& table) {
    std::vector<ordered_json> records;
    if (table.by)
        for (const light::PlaneSum& sum :
             light::sums_by(*table.by, table.hours, table.zone, table.typical))
            records.push_back(sum_json(*table.by, sum, table.typical));
    else
        for (const light::PlaneHour& hour : table.hours)
            records.push_back(hour_json(hour, table.zone));
    return records;
}

std::string row_of(const ordered_json& record) {
    std::string row;
    for (const ordered_json& value : record) {
        if (!row.empty()) row += ',';
        row += value.is_string()           ? value.get<std::string>()
               : value.is_number_integer() ? std::to_string(value.get<int>())
                                           : fmt::format("{:.8g}", value.get<double>());
    }
    return row;
}

}  // namespace

std::string plane_columns(const std::optional<SumBy>& by) {
    const ordered_json record = by ? sum_json(*by, {}, false) : hour_json({}, sun::Zone());
    std::vector<std::string> names;
    for (const auto& item : record.items())
        names.push_back(item.key());
    return fmt::format("{}", fmt::join(names, ","));
}

std::vector<std::string> plane_rows(const PlaneTable& table) {
    std::vector<std::string> rows;
    for (const ordered_json& record : records_of(table))
        rows.push_back(row_of(record));
    return rows;
}

std::string plane_csv(const PlaneTable& table) {
    std::vector<std::string> remarks;
    for (const auto& [key, text] : table.remarks)
        remarks.push_back(text);
    std::string text = csv_remarks(remarks) + plane_columns(table.by) + "\n";
    for (const std::string& row : plane_rows(table))
        text += row + "\n";
    return text;
}

ordered_json plane_json(const PlaneTable& table) {
    ordered_json json;
    json["place"] = report::place_json<ordered_json>(table.place);
    json["zone"] = table.zone.name();
    report::add_assumption(json, table.assumption);
    json["tilt_deg"] = angle_deg(table.plane.tilt_rad);
    json["azimuth_deg"] = angle_deg(table.plane.azimuth_rad);
    for (const auto& [key, text] : table.remarks)
        json[key] = text;
    json["rows"] = records_of(table);
    return json;
}

}  // namespace relevo::cli
