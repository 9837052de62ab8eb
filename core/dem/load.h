#pragma once

#include <optional>
#include <span>
#include <string>

#include "dem/collar.h"
#include "dem/heightfield.h"
#include "dem/source.h"
#include "dem/spikes.h"

namespace relevo::dem {

/// Posts along a side beyond which a DEM is neither drawn nor looked over for a horizon: textures
/// have 16384 pages of 256, and no raster of the Earth has so many.
inline constexpr int kMaxPostsASide = 1 << 22;

/// @throws Error (BadInput) where there are more
void refuse_endless_sides(const Source& source);

/// Opens and reads one raster: Source::open(), Source::read(), statistics().
/// @throws Error (BadInput) as they do, for sides of more than kMaxPostsASide, and where not one
///         post has a height
Heightfield load(const std::string& path, const LoadOptions& options = {});

/// The same for the inputs of a command line: one file or more, joined.
/// @throws Error (BadInput) also where there are none, or where they cannot be joined
Heightfield load(std::span<const std::string> paths, const LoadOptions& options = {});

/// The same for what is open already.
/// @param known  means that an earlier load() has returned; empty: they are read
Heightfield load(const Source& source, const MemoryBudget& memory, Array2d<float> known = {});

/// By how many posts each way load() reduces a DEM; 1: it keeps all posts.
int reduction_of(const Grid& full, const MemoryBudget& memory);

/// Means of at most so many posts, which can be shown until load() is through: from overviews, or,
/// where these do not suffice, from a sample of the file's blocks (sample_means()). Says nothing of
/// what looks wrong, see is_refused(). A sample is a DEM of its own: its reduction is 1, because no
/// finer level of it can be read.
/// @param most_posts  that are kept; files are read for up to four times as many cells of
///     overviews, or for an eighth of the posts but no more than 200 million;
///     15 x 15 blocks of a DEM that opens_slowly()
/// @returns none if all posts are few, or no mean has a height
/// @throws Error (BadInput) as Source::read()
std::optional<Heightfield> load_quickly(const Source& source, std::int64_t most_posts);

/// Says what heights look wrong but for those that check_heights() refuses, in the description and
/// with log::info.
/// @param source  they are from
/// @param about   with its statistics
/// @throws Error (BadInput) where not one post has a height
void report_heights(const Source& source, Description& about, const std::optional<Collar>& collar);

/// Refuses heights that no ground of the Earth has, before pictures or figures are made of them.
/// Where the user has said by --unit or --nodata what the heights are, they are only reported.
/// @param about   with its statistics
/// @param spikes  of all posts or nearly so; none where they do not matter
/// @throws Error (BadInput) with the units that fit
void check_heights(Description& about, const Spikes& spikes, const LoadOptions& options);
void check_heights(Heightfield& field, const LoadOptions& options);

/// Whether check_heights() would refuse the field.
bool is_refused(const Heightfield& field, const LoadOptions& options);

}  // namespace relevo::dem
