#include "weather/metar.h"

#include <string>

#include "fuzz/fuzz.h"

namespace relevo::fuzz {

const Target kMetar("metar", [](std::string_view bytes) {
    attempt([&] { weather::parse_metar(bytes); });
    attempt([&] { weather::report_of(std::string(bytes)); });
    weather::is_forecast_file(file(bytes, "report.txt"));
    weather::report_of(file(bytes, "report.txt"));
});

}  // namespace relevo::fuzz
