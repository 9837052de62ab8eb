#pragma once

#include <string>
#include <string_view>

#include "weather/metar.h"

namespace relevo::weather {

/// Reads the groups of a report one after the other, each by the first function that knows it.
/// Functions return false for groups that are not theirs; they throw a sentence, without subject,
/// for groups that are but have impossible numbers.
namespace groups {

struct Impossible {
    std::string why;
};

/// A word of the date that archives have before a report: "2024-01-05", "2026/06/01", "12:50",
/// "12:50:00", "2024-01-05T12:50Z", "202401051250".
bool archive_date(std::string_view word);
/// "011150Z" @throws Impossible
bool time(std::string_view group, Metar& to);
/// "24009KT", "VRB02KT", "24009G21MPS", "/////KT" @throws Impossible
bool wind(std::string_view group, Metar& to);
/// "9999", "0800", "4000NDV", "20KM", "CAVOK", "10SM", "P6SM", "M1/4SM", "1/2SM"; not the whole
/// miles of "1 1/2SM", which is_whole_miles() tells. @throws Impossible
bool visibility(std::string_view group, Metar& to);
/// Whole miles that another group goes on from: "1" before "1/2SM".
bool is_whole_miles(std::string_view group, std::string_view next);
/// "-SHRA", "+TSRA", "FZFG", "BCFG", "VCSH", "//"
bool present_weather(std::string_view group, Metar& to);
/// "FEW015", "BKN040CB", "OVC///", "NSC", "VV002", "//////CB" @throws Impossible
bool clouds(std::string_view group, Metar& to);
/// "17/13", "M02/M05", "05///" @throws Impossible
bool temperatures(std::string_view group, Metar& to);
/// "Q1014", "A2992" @throws Impossible
bool pressure(std::string_view group, Metar& to);
/// Groups without a use: runway visual range, wind sectors, recent weather, runway and sea states.
bool skipped(std::string_view group);

}  // namespace groups

}  // namespace relevo::weather
