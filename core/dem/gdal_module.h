#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace relevo::dem {

/// What the module lib/relevo/gdal.so (geo/gdal_library.h) does with GDAL's C++ classes, which only
/// what is linked with GDAL can use.
struct GdalModule {
    /// disarm_gdal() of guard.h.
    /// @param may_ask_net  whether the name that this thread opens was allowed to ask the net
    void (*disarm)(bool (*is_local_file_system)(std::string_view name), bool (*may_ask_net)());
    /// allow_remote() of guard.h.
    void (*allow_remote)();
    /// Names of the drivers that open nothing but allowed names.
    std::vector<std::string> (*disarmed_drivers)();
    /// open_regular_files_only() of regular_files.h.
    /// @param skipped  is called with the name of each file that is not opened, on any thread
    void (*open_regular_files_only)(void (*skipped)(const std::string& name));
    /// Keeps HDF5 from printing its errors on this thread, where a file has been opened with it.
    void (*silence_hdf5)();
};

/// The module's only symbol: const GdalModule* relevo_gdal_module().
inline constexpr const char* kGdalModuleEntry = "relevo_gdal_module";

/// Loads the module, once. Safe on several threads at once.
/// @throws Error (Failed) where it, or GDAL, cannot be loaded
const GdalModule& gdal_module();

}  // namespace relevo::dem
