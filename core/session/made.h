#pragma once

#include <string>

#include "scene/job.h"

/// Which pictures of a job exist already.
namespace relevo::session {

/// What a shot's files on the disk are.
struct OnDisk {
    enum class State {
        Missing,  ///< there is none
        Part,     ///< of picture and sidecar one is there, and is what it would be
        Whole,    ///< all are there, and are what they would be
        Other,    ///< something else has a name of theirs
    };
    State state = State::Missing;
    std::string why;  ///< of Other, for people: "its overlay has changed"
};

/// The picture of a shot, and its sidecar.
struct Wanted {
    std::string record;  ///< what it is made from, as SceneInputs::record()
    bool sidecar = false;
    bool audited = false;  ///< with an audit in the sidecar
};

/// Compares what the files carry, never their times: a file that was copied or touched is the same,
/// and one whose content changed is not, whatever the clocks say. Reads the whole picture.
OnDisk on_disk(const scene::Shot& shot, const Wanted& wanted);

}  // namespace relevo::session
