#pragma once

#include <cstddef>
#include <list>
#include <mutex>
#include <unordered_map>

#include "dem/piece.h"

namespace relevo::dem {

/// Open handles that no call is using. A GDAL dataset serves one thread at a time, and a process
/// may have 1024 files open while tiles come in thousands: those not used for longest are closed.
/// Safe on several threads at once.
class DatasetPool {
  public:
    /// Handles kept between reads.
    static constexpr std::size_t kMostIdle = 128;

    /// Calls body(dataset) with a handle of a piece that is this call's alone.
    /// @throws Error (BadInput) as Piece::open(); what the body throws closes the handle
    template <typename Body>
    void borrow(const Piece& piece, const Body& body) {
        Dataset mine = take(piece);
        if (!mine) mine = piece.open();
        body(mine.get());
        give(piece, std::move(mine));
    }

    /// Keeps a handle as by Piece::open().
    void give(const Piece& piece, Dataset dataset);

  private:
    struct Idle {
        const Piece* piece;
        Dataset dataset;
    };
    using Handles = std::list<Idle>;  // the one used last in front

    Dataset take(const Piece& piece);

    std::mutex mutex_;
    Handles handles_;
    std::unordered_multimap<const Piece*, Handles::iterator> by_piece_;
};

}  // namespace relevo::dem
