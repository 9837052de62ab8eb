#include "effect/table_files.h"
#include "fuzz/fuzz.h"

void relevo::fuzz::read(std::string_view bytes) {
    const std::filesystem::path path = file(bytes, "table");
    attempt([&] { effect::read_table(path); });
    effect::read_cube(path);
}
