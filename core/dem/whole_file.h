#pragma once

#include <cstdint>
#include <filesystem>

namespace relevo::dem {

/// The bytes that a netCDF file in a classic format (CDF-1, CDF-2, CDF-5) must have for all of its
/// variables to be there; 0 for any other file and where the header itself is cut. The netCDF
/// library reads zeros past the end of a file that is shorter, and says nothing.
/// Source: "NetCDF Classic Format Specification", docs.unidata.ucar.edu/netcdf-c.
std::uint64_t classic_netcdf_size(const std::filesystem::path& path);

}  // namespace relevo::dem
