#pragma once

namespace relevo::dem {

/// Has GDAL open regular files and folders alone where it opens files of this machine by their
/// names: what lies beside a raster (".aux.xml", ".ovr") is opened without being asked for, and a
/// pipe without a writer would keep the program waiting. Of each that is passed over a warning
/// says so. prepare_gdal() calls it once.
void open_regular_files_only();

}  // namespace relevo::dem
