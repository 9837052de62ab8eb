#pragma once

#include <string>

#include "scene/job.h"

/// Which pictures of a job exist already.
namespace relevo::session {

/// State of a shot's files on the disk.
struct OnDisk {
    enum class State {
        Missing,  ///< there are none
        Part,     ///< one of picture and sidecar exists and is current
        Whole,    ///< all exist and are current
        Other,    ///< a file with one of the names has other content
    };
    State state = State::Missing;
    std::string why;  ///< reason for Other: "its overlay has changed"
};

/// What a shot's files must contain to be current.
struct Wanted {
    std::string record;  ///< inputs as SceneInputs::record()
    std::string format;  ///< as format_text()
    bool sidecar = false;
    bool audited = false;  ///< the sidecar has an audit
};

/// Compares recorded contents, not file times: copied or touched files are current, changed ones
/// are not. Reads the whole picture.
OnDisk on_disk(const scene::Shot& shot, const Wanted& wanted);

}  // namespace relevo::session
