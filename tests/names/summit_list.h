#pragma once

#include <filesystem>
#include <string>

#include <zlib.h>

#include "names/gazetteer.h"
#include "support/support.h"

namespace relevo::test {

/// A gzip file of a test's own.
inline std::filesystem::path packed(const char* name, const std::string& text) {
    const std::filesystem::path path = scratch_dir(name) / name;
    const gzFile file = gzopen(path.c_str(), "wb");
    gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
    gzclose(file);
    return path;
}

/// Summits as rows "name\talt\tcc\tlat\tlon\tele\tsrc\n".
inline names::Gazetteer summit_list(const std::string& rows) {
    return {{}, packed("summits", "name\talt\tcc\tlat\tlon\tele\tsrc\n" + rows)};
}

}  // namespace relevo::test
