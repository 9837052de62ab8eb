#pragma once

#include <proj.h>

namespace relevo::geo {

/// Has a context open regular files alone: a grid of `+nadgrids` may be named by anybody, and a
/// pipe without a writer would keep whoever opens it waiting. PROJ takes others for missing.
void open_regular_files_only(PJ_CONTEXT* context);

}  // namespace relevo::geo
