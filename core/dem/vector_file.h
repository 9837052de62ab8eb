#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

// GPX and GeoJSON by GDAL. Inside of the layer only.

namespace relevo::dem {

/// A vertex as a file has it, not checked: NaN and 1e9 may be among them.
struct VectorPoint {
    double lat_deg = 0, lon_deg = 0;
    std::string name;  ///< of a point that is none of a line
    std::string time;  ///< UTC as ISO 8601; empty where the file has none
};

/// A GPX or a GeoJSON file that is open, on the thread that opened it. No other driver of GDAL sees
/// it, whatever it holds, and its name is a file's, whatever it looks like.
class VectorFile {
  public:
    /// @param path  of a file that is there, as InputFile has found
    /// @param who  what errors begin with
    /// @throws Error (BadInput) for what is none of the two
    VectorFile(const std::string& path, std::string_view who, bool gpx);
    ~VectorFile();
    VectorFile(const VectorFile&) = delete;
    VectorFile& operator=(const VectorFile&) = delete;

    /// Waypoints, or points of features. @throws Error (BadInput) for a damaged file
    void points(const std::function<void(VectorPoint&&)>& visit);

    /// Vertices of tracks, where there are none of routes, or of line features, in their order.
    /// @param visit  gets the line's number, from 1
    /// @returns the names of all lines, empty where the file has none
    /// @throws Error (BadInput) for a damaged file
    std::vector<std::string> lines(const std::function<void(int, VectorPoint&&)>& visit);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::dem
