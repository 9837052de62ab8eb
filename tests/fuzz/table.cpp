#include "effect/table_files.h"
#include "fuzz/fuzz.h"

namespace relevo::fuzz {

const Target kTable("table", [](std::string_view bytes) {
    const std::filesystem::path path = file(bytes, "table");
    attempt([&] { effect::read_table(path); });
    effect::read_cube(path);
});

}  // namespace relevo::fuzz
