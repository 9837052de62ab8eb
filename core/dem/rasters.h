#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "dem/dataset_pool.h"
#include "dem/mosaic.h"
#include "dem/open_rasters.h"
#include "dem/window_index.h"

// The rasters of a DEM. Inside of the layer only.

namespace relevo::dem {

/// The rasters of a DEM, in their order: where they overlap, the later is on top. Files are open
/// from the beginning; a tile of an index is opened when heights of it are first read, and has no
/// heights if it is missing or broken. Const functions are safe on several threads at once.
class Rasters {
  public:
    Rasters(OpenRasters opened, Frame frame, const LoadOptions& options);

    /// Makes another post the first; rasters may then begin outside.
    void move_origin(int column, int row);

    int count() const { return static_cast<int>(entries_.size()); }
    /// A single file, which has all posts of the DEM.
    bool is_one_file() const { return count() == 1 && entries_.front().index < 0; }

    /// Numbers of the rasters that may have posts of a window, ascending.
    std::vector<int> within(const Window& window) const { return by_place_.within(window); }

    /// The posts that a raster may have: of a tile of an index, those that the index says.
    const Window& reach(int number) const { return at(number).reach; }

    /// Opens a raster if it is not open yet; null for a tile that is missing or broken.
    const Piece* open(int number) const;
    /// The piece of a raster if it is open; null for a void, or for one that is not yet known.
    const Piece* if_open(int number) const {
        const Slot& slot = at(number);
        return slot.state.load(std::memory_order_acquire) == State::Open ? slot.piece.get()
                                                                         : nullptr;
    }
    /// A tile that is known to have no heights.
    bool is_void(int number) const;
    /// Of a tile that is not open: the piece that it is expected to be like.
    const Piece& sample(int number) const;

    /// Calls body(dataset) with a handle of a raster. Where the body throws for a tile of an index,
    /// that tile is broken from then on, and this returns false.
    /// @throws Error (BadInput) for files of their own, and as allow_voids() has it
    template <typename Body>
    bool read(int number, const Piece& piece, const Body& body) const {
        if (entries_[static_cast<std::size_t>(number)].index < 0) {
            pool_.borrow(piece, body);
            return true;
        }
        try {
            pool_.borrow(piece, body);
            return true;
        } catch (const Error& error) {
            note_broken(number, error, /*was_open=*/true);
            return false;
        }
    }

    /// Reads heights of a window of a level, in posts of Piece::place: as Piece::read(), resampled
    /// where the raster's grid is not the DEM's. Opens rasters beside it.
    /// @throws Error (BadInput) where they cannot all be read
    void read_level(const Piece& piece, void* dataset, const Resolution& level,
                    const Window& window, float* height_m) const;

    /// Notes by how much a tile of an index differs from what it lies over [m].
    void note_step(int number, float most_m) const;

    /// How many tiles have broken while they were read: what was read before is then of no use.
    std::int64_t broken_while_read() const { return broken_while_read_; }

    /// From now on no more tiles than these may be missing or broken: what is known of the DEM
    /// would be wrong. One that is more is an error.
    void allow_voids(std::int64_t tiles) const;

    /// As Source::tiles().
    TileReport report() const;

  private:
    enum class State : std::uint8_t { Unopened, Open, Missing, Broken };
    struct Slot {
        Window reach;
        std::unique_ptr<Piece> piece;
        std::atomic<State> state = State::Unopened;
    };
    Slot& at(int number) const { return slots_[static_cast<std::size_t>(number)]; }
    const IndexedTile& tile(int number) const;
    void open_tile(int number, Slot& slot) const;
    void note_missing(int number, Slot& slot) const;
    void note_broken(int number, const Error& error, bool was_open) const;
    void check_allowed(int number, const std::string& why) const;
    std::string difference(int number, const Piece& piece) const;
    struct Beyond;  // rasters_resampled.cpp
    std::vector<float> heights_beyond(const Piece& piece, const Window& posts) const;
    void add_beyond(int number, Beyond& beyond) const;

    std::vector<RasterEntry> entries_;
    std::vector<OpenIndex> indexes_;
    std::vector<const Piece*> samples_;  // of the indexes
    Frame frame_;
    LoadOptions options_;
    std::unique_ptr<Slot[]> slots_;
    WindowIndex by_place_;
    mutable DatasetPool pool_;
    mutable std::array<std::mutex, 64> opening_;
    mutable std::mutex noting_;
    mutable std::map<int, std::string> broken_, differing_;  // by number, why
    mutable std::map<int, float> steps_m_;                   // by number
    mutable std::int64_t voids_ = 0;
    mutable std::optional<std::int64_t> most_voids_;
    mutable std::atomic<std::int64_t> broken_while_read_ = 0;
};

}  // namespace relevo::dem
