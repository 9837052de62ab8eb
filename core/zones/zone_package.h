#pragma once

#include <string>
#include <vector>

#include "base/output_file.h"

namespace relevo::zones {

/// A table beside the zones of a file.
struct ZoneTable {
    struct Column {
        std::string name;
        bool is_text = false;
    };
    std::vector<Column> columns;
    /// Fields as texts, "" where there is nothing; zones in the file's order, again and again.
    std::vector<std::vector<std::string>> rows;
};

/// Writes a GeoPackage: a row of the table each, with the polygon of its zone and its CRS.
/// @param zones  the file, as read_zones() reads it
/// @throws Error (BadInput) as read_zones(), (Failed) where it cannot be written
void write_package(OutputFile& file, const std::string& zones, const ZoneTable& table);

}  // namespace relevo::zones
