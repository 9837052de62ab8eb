#include <string>

#include "fuzz/fuzz.h"
#include "session/record_reader.h"

namespace relevo::fuzz {

// Pictures are told apart by the endings of their names. What no picture begins like is a sidecar.
const Target kRecord("record", [](std::string_view bytes) {
    if (bytes.starts_with("\x89PNG"))
        session::read_record(file(bytes, "picture.png"));
    else if (bytes.starts_with("\xff\xd8"))
        session::read_record(file(bytes, "picture.jpg"));
    else
        session::shallow_json(std::string(bytes));
});

}  // namespace relevo::fuzz
