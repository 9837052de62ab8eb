#include <string>

#include "effect/table_files.h"
#include "fuzz/fuzz.h"

void relevo::fuzz::read(std::string_view bytes) {
    effect::read_cube(file(bytes, "grade.cube"));
}
