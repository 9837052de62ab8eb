#include "sun/celestial.h"

#include <erfam.h>
#include <glm/matrix.hpp>

#include "sun/apparent.h"
#include "sun/observer.h"

namespace relevo::sun {

CelestialFrame celestial_frame(const Epoch& epoch, const geo::Geodetic& place) {
    const Observer observer(place);
    const SolarEphemeris ephemeris(epoch.tt_jd[0], epoch.tt_jd[1]);
    const TurnedEarth earth(epoch);

    // Columns: what the three Earth-fixed axes are in ICRS and in ENU, both rotations.
    glm::dmat3 icrs(1), enu(1);
    for (int i = 0; i < 3; ++i) {
        glm::dvec3 axis(0);
        axis[i] = 1;
        icrs[i] = ephemeris.icrs(earth.cirs(axis));
        enu[i] = observer.enu(axis);
    }
    CelestialFrame frame;
    frame.axes = icrs * glm::transpose(enu);
    frame.velocity =
        (ephemeris.earth_velocity_m_s() + ephemeris.icrs(earth.motion(place).velocity_m_s)) /
        ERFA_CMPS;
    return frame;
}

}  // namespace relevo::sun
