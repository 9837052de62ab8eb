#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "light/point/direct_light.h"
#include "light/point/doubt.h"
#include "sun/events.h"

/// What `sun day` and `moon day` say of a day, in each of their forms.
namespace relevo::cli {

/// [{kind, utc, local, azimuth_deg, elevation_deg}].
nlohmann::ordered_json events_json(const std::vector<sun::Event>& events, const sun::Zone& zone);
nlohmann::ordered_json lit_json(const std::vector<light::LitInterval>& lit);

/// A field of CSV: "begin/end;begin/end", in local time.
std::string spans_of(const std::vector<sun::TimeSpan>& spans, const sun::Zone& zone);
std::string spans_of(const std::vector<light::LitInterval>& lit, const sun::Zone& zone);
/// Of all that is lit, what is not known for voids of the DEM.
std::vector<sun::TimeSpan> not_known_of(const std::vector<light::LitInterval>& lit);

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
