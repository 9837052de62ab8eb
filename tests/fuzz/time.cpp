#include <string>

#include "fuzz/fuzz.h"
#include "sun/posix_rule.h"
#include "sun/zone.h"

namespace relevo::fuzz {

const Target kTime("time", [](std::string_view bytes) {
    static const sun::Zone zurich = sun::Zone::named("Europe/Zurich");
    sun::posix_rule_changes(bytes, 1999, 2001);
    attempt([&] { sun::Zone::named(bytes); });
    attempt([&] { sun::parse_date(bytes); });
    attempt([&] { sun::is_wall_time(bytes); });
    attempt([&] { sun::parse_time(bytes); });
    sun::parse_time(bytes, zurich);
});

}  // namespace relevo::fuzz
