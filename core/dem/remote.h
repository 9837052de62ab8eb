#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/allowed_name.h"

namespace relevo::dem {

/// What a store says of a name. Hidden is 403: one may not see it, or not know that it is missing.
enum class Presence { There, Missing, Hidden };
/// @throws Error (BadInput) `NAME: cannot be asked for, why` where there is no answer
Presence remote_presence(const AllowedName& name);

/// Refuses a name of a store that gives no answer: GDAL would wait for it several times. Other
/// names, and those that are missing, pass.
/// @throws Error (BadInput) as remote_presence()
void refuse_silent(const AllowedName& name);

/// What GDAL has asked of stores and servers since the process began, and what came of it.
struct NetworkUse {
    std::int64_t requests = 0, read_bytes = 0, written_bytes = 0;
};
/// Nothing where it has not been asked to use the net.
std::optional<NetworkUse> network_use();

/// The files beside a remote GeoTIFF that may belong to it (overviews, mask, statistics, place), as
/// far as they are there. GDAL asks for forty names by itself, each twice.
class RemoteSiblings {
  public:
    /// @throws Error (BadInput) as remote_presence(): without its mask a DEM would be another
    explicit RemoteSiblings(const AllowedName& name);
    /// As GDALOpenEx takes them; null: GDAL is to look.
    const char* const* list() const;

  private:
    std::vector<std::string> names_;
    std::vector<const char*> list_;
};

}  // namespace relevo::dem
