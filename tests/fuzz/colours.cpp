#include <string>

#include "chart/ramp.h"
#include "fuzz/fuzz.h"

void relevo::fuzz::read(std::string_view bytes) {
    chart::read_ramp(file(bytes, "colours.txt"), 0, 100);
}
