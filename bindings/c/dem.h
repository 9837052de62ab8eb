#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "dem/memory_raster.h"
#include "dem/posts.h"
#include "handles.h"
#include "scene/scene.h"
#include "session/session.h"
#include "sun/time.h"

namespace relevo::c {

/// A DEM behind a handle. What is made of its heights is made when it is first asked for.
class Dem {
  public:
    /// @param named  the DEM's names and how it is read
    /// @param held   what a name of GDAL's memory stands for
    /// @throws Error as dem::Source::open()
    explicit Dem(scene::Scene named, std::optional<dem::MemoryRaster> held = {});

    const scene::Scene& named() const { return named_; }
    bool is_of_memory() const { return held_.has_value(); }
    const dem::Grid& grid() const { return source_->grid(); }
    const dem::Source& source() const { return *source_; }
    /// All posts, for figures. @throws Error as dem::Posts::load()
    const dem::Posts& posts();
    /// A wider and coarser DEM that shades its rasters, too; null: none.
    std::shared_ptr<Dem> around();
    void set_around(std::shared_ptr<Dem> around);
    /// Heights as sessions draw them. @throws Error as session::load_dem()
    std::shared_ptr<const session::LoadedDem> loaded(const scene::Scene& scene);

  private:
    std::optional<dem::MemoryRaster> held_;
    scene::Scene named_;
    std::shared_ptr<const dem::Source> source_;
    std::mutex mutex_;
    std::optional<dem::Posts> posts_;
    std::shared_ptr<Dem> around_;
    std::shared_ptr<const session::LoadedDem> loaded_;
    dem::Holes loaded_holes_ = dem::Holes::Fill;
};

Handles<relevo_dem, Dem>& dems();

/// A place of the caller's. @throws BadCall, Error (BadInput) for what is no place
geo::Geodetic place_of(const relevo_place* place);

/// @throws Error (BadInput) for what no instant holds
sun::Instant instant_of(double time_s);

}  // namespace relevo::c
