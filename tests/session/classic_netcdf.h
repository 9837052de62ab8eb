#pragma once

#include <functional>
#include <string>
#include <vector>

namespace relevo::test {

/// A variable of time, latitude and longitude; each time has one value.
struct NetcdfVariable {
    std::string name;
    std::string unit;
    std::vector<double> at_times;
    std::function<bool(double lon_deg)> is_void{};  ///< has no value there
};

/// Writes a classic NetCDF file from 44.75 to 49.25 degrees north and 6.25 to 11.75 degrees east,
/// as ECMWF's Climate Data Store does: coordinates without a CRS, several variables. GDAL writes
/// one variable only. Source: NetCDF User's Guide, File Format Specifications.
void write_netcdf(const std::string& path, const std::string& time_unit,
                  const std::vector<double>& times, const std::vector<NetcdfVariable>& variables);

}  // namespace relevo::test
