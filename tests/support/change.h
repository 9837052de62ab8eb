#pragma once

#include <string>

#include "session/session.h"

/// Changes what a session shows, a member at a time, as a window does.
namespace relevo::test {

template <typename Change>
void change(session::Session& session, const Change& change, session::Hints hints = {}) {
    hints.exact = false;
    scene::Scene scene = session.scene();
    change(scene);
    session.show(scene, session.time(), hints);
}

inline void look(session::Session& session, const scene::View& view) {
    change(session, [&](scene::Scene& scene) { scene.view = view; });
}

inline void set_time(session::Session& session, sun::Instant utc) {
    session.show(session.scene(), utc, {.exact = false});
}

/// Changed files are read again.
inline void set_effects(session::Session& session, const scene::Effects& effects) {
    change(session, [&](scene::Scene& scene) { scene.effects = effects; },
           {.reload_effects = true});
}

inline void set(session::Session& session, const std::string& address, const std::string& value) {
    scene::Effects one;
    one.settings = {{address, value}};
    change(session, [&](scene::Scene& scene) { scene.effects = scene::merge(scene.effects, one); });
}

inline void resize(session::Session& session, int width_px, int height_px) {
    change(session, [&](scene::Scene& scene) {
        scene.width_px = width_px;
        scene.height_px = height_px;
    });
}

}  // namespace relevo::test
