#pragma once

namespace relevo::geo {

/// A function of GDAL or of PROJ, by its name. The program is not linked with these libraries, but
/// loads the module lib/relevo/gdal.so, which is, when it first needs one: of the 55 ms that any
/// command took at least, 45 were for loading them and the 100 libraries that they need.
/// Safe on several threads at once.
/// @throws Error (Failed) where the module, a library or the function is missing
void* gdal_function(const char* name);

/// Loads both now, for what has to come after. @throws Error (Failed) where one is missing
void load_gdal();

}  // namespace relevo::geo
