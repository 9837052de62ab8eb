#pragma once

#include <string>
#include <vector>

#include "chart/stamps.h"
#include "image/image.h"
#include "session/session.h"

namespace relevo::session {

/// Puts what a scene wants on a picture of it.
/// @param legends  of what colours mean
/// @returns what could not be stamped and why: whole sentences
std::vector<std::string> add_stamps(const Session& session,
                                    const std::vector<chart::Legend>& legends,
                                    image::Image8& picture);

}  // namespace relevo::session
