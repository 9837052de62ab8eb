#pragma once

#include <string>
#include <vector>

#include "cli/day_verb.h"
#include "report/days.h"
#include "sun/events.h"

/// What `sun day` and `moon day` say of a day, in each of their forms.
namespace relevo::cli {

using report::DayResult;
using report::DayWords;
using report::not_known_of;

/// What of a day's light ends its row of CSV.
std::string light_columns(const DayResult& result, std::size_t day, bool holes);
/// Place and dates.
void print_head(const DayResult& result);
/// Sentences on what the figures mean.
void print_definitions(const DayResult& result);
std::string table_of(const DayResult& result, const std::vector<std::string>& rows);
/// Computes days for --at or for all of --points, and delivers them.
/// @param forms  as DayFigure
void run_days(const DayArguments& arguments, const DayWords& words,
              decltype(DayFigure::forms) forms);

/// A field of CSV: "begin/end;begin/end", in local time.
std::string spans_of(const std::vector<sun::TimeSpan>& spans, const sun::Zone& zone);

/// "05:25:12 to 06:10:00, ..."; "none".
std::string spans_text(const std::vector<sun::TimeSpan>& spans, const sun::Zone& zone);
/// ", of it 0:01:17 not known"; empty where all is known.
std::string not_known_text(const light::LightDay& day);

/// Where voids of the DEM leave the light open.
/// @param light  "direct sun"
std::string not_known_text(const light::Doubt& doubt, const char* light);

/// An azimuth in degrees as two decimals show it: 359.996 is 0.00.
double printed_azimuth_deg(double azimuth_rad);
/// A line for each event.
void print_events(const std::vector<sun::Event>& events, const sun::Zone& zone);
/// A line for each interval, and their sum.
/// @param light  "direct sun"
void print_lit(const light::LightDay& day, const char* light, const sun::Zone& zone);

}  // namespace relevo::cli
