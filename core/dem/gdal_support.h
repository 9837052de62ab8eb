#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace relevo::dem {

/// An open GDALDatasetH, which is a void*; serves one thread at a time.
struct CloseDataset {
    void operator()(void* dataset) const;
};
using Dataset = std::unique_ptr<void, CloseDataset>;

/// A feature of a layer, an OGRFeatureH, which is a void*.
struct DestroyFeature {
    void operator()(void* feature) const;
};
using Feature = std::unique_ptr<void, DestroyFeature>;

/// Registers GDAL's drivers, once, takes from them what files from others could misuse (guard.h),
/// keeps its cache of blocks to 256 MiB or less (unless GDAL_CACHEMAX is set), and keeps GDAL from
/// writing to standard error: what nobody collects goes to the debug log. In a process of another
/// program (is_hosted()) it only registers the drivers. Safe on several threads at once; everything
/// here that uses GDAL calls it first. Takes 3 ms the first time; loading GDAL's own libraries
/// takes 50.
void prepare_gdal();

/// Sets the size of GDAL's cache of blocks, which all datasets share.
void allow_blocks(std::int64_t bytes);

/// Raises it to at least so much: blocks that it cannot hold are decoded for every read.
void hold_blocks(std::int64_t bytes);

/// While it lives, GDAL asks for each file that may lie beside one that it opens, instead of
/// listing the folder, on this thread. By itself it does so where a folder has more than 1000
/// files, after having listed as many, which takes 0.5 ms for each file that is opened.
class WithoutListing {
  public:
    /// @param files  that are opened in all; of no more than 1000, folders are listed
    explicit WithoutListing(std::size_t files);
    ~WithoutListing();
    WithoutListing(const WithoutListing&) = delete;
    WithoutListing& operator=(const WithoutListing&) = delete;

  private:
    bool many_;
};

/// Collects what GDAL says on this thread while it lives, instead of having it printed. What HDF5
/// prints by itself is dropped, but for processes of other programs.
class GdalMessages {
  public:
    GdalMessages();
    ~GdalMessages();
    GdalMessages(const GdalMessages&) = delete;
    GdalMessages& operator=(const GdalMessages&) = delete;

    /// The last failure, on one line, without the name of the file, which our own message has;
    /// empty where there was none. It is the outermost one and says where in the file.
    std::string failure(const std::string& path) const;
    /// Throws the last failure: `path: what, failure; remedy`. @throws Error (BadInput)
    [[noreturn]] void refuse(const std::string& path, std::string_view what) const;
    bool any_failure() const { return !failures_.empty(); }
    void clear() { failures_.clear(); }

  private:
    static void collect(int severity, int number, const char* text);
    std::vector<std::string> failures_;
};

/// The text of an OGRSpatialReferenceH, WKT 2; empty where there is none, or GDAL cannot write it.
std::string wkt_of(void* crs);

}  // namespace relevo::dem
