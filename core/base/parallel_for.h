#pragma once

#include <functional>

namespace relevo {

/// Threads that parallel_for uses, the calling one included: those of allocation().
int thread_count();

/// Calls `body(first, last)` for pieces of [begin, end) on several threads, which are the process's
/// own and stay, and waits for all of them. May be called from inside of `body` and from several
/// threads at once. Pieces are contiguous and disjoint; the result must not depend on how they are
/// cut. After an exception of `body` no further piece begins; it is thrown again here once those
/// under way have ended. Where the system gives no further thread, fewer do the same.
/// @param grain  the least size of a piece; ranges no longer than this run on the calling thread
void parallel_for(int begin, int end, int grain, const std::function<void(int, int)>& body);

/// Whether the system gives so many threads more, and some memory beside them, at this moment. For
/// libraries that wait for ever where it does not.
bool can_start_threads(int count);

}  // namespace relevo
