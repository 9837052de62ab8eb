#pragma once

#include <optional>

#include "base/output_file.h"
#include "image/image.h"
#include "session/session.h"

namespace relevo::session {

/// Writes a session's picture to a file, all of it but finish().
/// @param picture  of Session::make_picture(); nullopt: it is too large for memory (needs_bands())
///     and is drawn here, band by band
/// @throws Error as image::write() and Session::make_bands()
void write_picture(Session& session, const std::optional<image::Picture>& picture, OutputFile& file,
                   const image::Metadata& metadata, const image::Encoding& encoding);

}  // namespace relevo::session
