#pragma once

namespace relevo {

/// Declares that the process belongs to another program, which has loaded Relevo as a library. What
/// all of the process shares, such as GDAL's drivers, handlers of signals and the way it exits, is
/// then left as it is. Call it before all else.
void set_hosted();
bool is_hosted();

}  // namespace relevo
