#include "dem/rasters.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"
#include "dem/gdal.h"
#include "dem/gdal_support.h"
#include "dem/tile_opening.h"

namespace relevo::dem {
namespace {

constexpr std::size_t kNamed = 3;  // of tiles in a message

/// Leaves what reading needs: of 100 000 open tiles, sentences would take 100 MB.
void forget_sentences(Description& about) {
    about.files = {};
    about.assumptions = {};
    about.guesses = {};
    about.warnings = {};
}

/// Whether a grid's cells are as large as another's, within what is lost in text.
bool same_spacing(const Affine& a, const Affine& b) {
    const auto near = [](double x, double y) { return std::abs(x - y) <= 1e-6 * std::abs(y); };
    return near(a.x_column, b.x_column) && near(a.y_row, b.y_row) && a.x_row == b.x_row &&
           a.y_column == b.y_column;
}

}  // namespace

Rasters::Rasters(OpenRasters opened, Frame frame, const LoadOptions& options)
    : entries_(std::move(opened.entries)),
      indexes_(std::move(opened.indexes)),
      samples_(indexes_.size()),
      frame_(std::move(frame)),
      options_(options),
      slots_(std::make_unique<Slot[]>(entries_.size())) {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const RasterEntry& entry = entries_[i];
        Slot& slot = slots_[i];
        if (entry.piece >= 0) {
            const auto number = static_cast<std::size_t>(entry.piece);
            slot.piece = std::make_unique<Piece>(std::move(opened.pieces[number]));
            slot.state = State::Open;
            slot.reach = slot.piece->place;
            if (opened.handles[number]) pool_.give(*slot.piece, std::move(opened.handles[number]));
        }
        if (entry.index < 0) continue;
        const auto index = static_cast<std::size_t>(entry.index);
        if (slot.piece) samples_[index] = slot.piece.get();
        slot.reach = indexes_[index].reaches[entry.tile];
    }
    for (OpenIndex& index : indexes_)
        index.reaches = {};
    move_origin(0, 0);
}

void Rasters::move_origin(int column, int row) {
    std::vector<Window> reaches;
    for (int i = 0; i < count(); ++i) {
        Slot& slot = at(i);
        slot.reach.column -= column;
        slot.reach.row -= row;
        if (slot.piece) {
            slot.piece->place.column -= column;
            slot.piece->place.row -= row;
        }
        reaches.push_back(slot.reach);
    }
    frame_.origin += glm::ivec2(column, row);
    by_place_ = WindowIndex(reaches);
}

const IndexedTile& Rasters::tile(int number) const {
    const RasterEntry& entry = entries_[static_cast<std::size_t>(number)];
    return indexes_[static_cast<std::size_t>(entry.index)].index.tiles[entry.tile];
}

const Piece& Rasters::sample(int number) const {
    const RasterEntry& entry = entries_[static_cast<std::size_t>(number)];
    return entry.index < 0 ? *at(number).piece : *samples_[static_cast<std::size_t>(entry.index)];
}

bool Rasters::is_void(int number) const {
    const State state = at(number).state.load(std::memory_order_acquire);
    return state == State::Missing || state == State::Broken;
}

const Piece* Rasters::open(int number) const {
    Slot& slot = at(number);
    if (slot.state.load(std::memory_order_acquire) == State::Unopened) {
        const std::lock_guard lock(opening_[static_cast<std::size_t>(number) % opening_.size()]);
        if (slot.state == State::Unopened) open_tile(number, slot);
    }
    return if_open(number);
}

void Rasters::open_tile(int number, Slot& slot) const {
    const RasterEntry& entry = entries_[static_cast<std::size_t>(number)];
    const TileIndex& index = indexes_[static_cast<std::size_t>(entry.index)].index;
    if (!is_there(name_of(index, tile(number)))) return note_missing(number, slot);
    try {
        Dataset dataset;
        auto piece = std::make_unique<Piece>(
            open_tile_piece(index, tile(number), options_, entries_.size(), dataset));
        settle_on(frame_, *piece);
        const std::string differs = difference(number, *piece);
        forget_sentences(piece->about);
        slot.piece = std::move(piece);
        pool_.give(*slot.piece, std::move(dataset));
        if (!differs.empty()) {
            const std::lock_guard lock(noting_);
            differing_.emplace(number, differs);
        }
        slot.state.store(State::Open, std::memory_order_release);
    } catch (const Error& error) {
        note_broken(number, error, /*was_open=*/false);
    }
}

void Rasters::note_missing(int number, Slot& slot) const {
    const std::lock_guard lock(noting_);
    check_allowed(number, "is missing");
    ++voids_;
    slot.state.store(State::Missing, std::memory_order_release);
}

void Rasters::note_broken(int number, const Error& error, bool was_open) const {
    if (is_no_fault_of_a_file(error)) throw error;
    const std::lock_guard lock(noting_);
    if (broken_.contains(number)) return;
    check_allowed(number, error.what());
    ++voids_;
    broken_.emplace(number, error.what());
    at(number).state.store(State::Broken, std::memory_order_release);
    if (was_open) ++broken_while_read_;
}

/// With the lock of what is noted.
void Rasters::check_allowed(int number, const std::string& why) const {
    if (most_voids_ && voids_ >= *most_voids_)
        refuse(
            printable(
                indexes_[static_cast<std::size_t>(entries_[static_cast<std::size_t>(number)].index)]
                    .index.path),
            fmt::format("the tile {} can no longer be read, {}; put it back and try again",
                        printable(tile(number).name), why));
}

void Rasters::allow_voids(std::int64_t tiles) const {
    const std::lock_guard lock(noting_);
    most_voids_ = tiles;
}

std::string Rasters::difference(int number, const Piece& piece) const {
    const Piece& expected = sample(number);
    std::vector<std::string> words;
    if (piece.about.unit.name != expected.about.unit.name)
        words.push_back("heights in " + piece.about.unit.name);
    if (piece.about.nodata_text() != expected.about.nodata_text())
        words.push_back("nodata " + (piece.about.nodata ? piece.about.nodata_text() : "none"));
    if (piece.grid.crs().text() != expected.grid.crs().text())
        words.push_back("CRS " + (piece.grid.crs().code().empty() ? piece.grid.crs().name()
                                                                  : piece.grid.crs().code()));
    else if (!same_spacing(piece.grid.affine(), expected.grid.affine()))
        words.push_back(fmt::format("cells of {:.6g} x {:.6g}",
                                    std::abs(piece.grid.affine().x_column),
                                    std::abs(piece.grid.affine().y_row)));
    const Window& reach = at(number).reach;
    if (common(piece.place, reach).is_empty())
        words.emplace_back("lies elsewhere than the index says, so it is a void");
    else if (!piece.resampling && common(piece.place, reach) != piece.place)
        words.emplace_back("reaches beyond its outline in the index, where it is not read");
    return fmt::format("{}", fmt::join(words, ", "));
}

void Rasters::note_step(int number, float most_m) const {
    constexpr float kAlike_m = 1;  // two surveys of one ground
    if (!(most_m > kAlike_m) || entries_[static_cast<std::size_t>(number)].index < 0) return;
    const std::lock_guard lock(noting_);
    float& known_m = steps_m_[number];
    known_m = std::max(known_m, most_m);
}

TileReport Rasters::report() const {
    TileReport report;
    for (int i = 0; i < count(); ++i) {
        if (entries_[static_cast<std::size_t>(i)].index < 0) continue;
        ++report.tiles;
        const State state = at(i).state.load(std::memory_order_acquire);
        report.opened += state == State::Open;
        if (state == State::Missing) report.missing.add(tile(i).name, kNamed);
    }
    const std::lock_guard lock(noting_);
    for (const auto& [number, why] : broken_)
        report.broken.add(fmt::format("{} ({})", tile(number).name, why), kNamed);
    for (const auto& [number, what] : differing_)
        report.differing.add(fmt::format("{} ({})", tile(number).name, what), kNamed);
    for (const auto& [number, step_m] : steps_m_)
        report.stepped.add(fmt::format("{} (by up to {:.0f} m)", tile(number).name, step_m),
                           kNamed);
    return report;
}

}  // namespace relevo::dem
