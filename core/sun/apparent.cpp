#include "sun/apparent.h"

#include <cmath>

#include <erfa.h>
#include <erfam.h>

namespace relevo::sun {

SolarEphemeris::SolarEphemeris(double tt_jd1, double tt_jd2) : tt_jd_{tt_jd1, tt_jd2} {
    // TT for TDB: they differ by 2 ms at most, in which the sun moves 0.0001 arcsec. A status other
    // than 0 says only that the date is beyond 1900-2100.
    eraEpv00(tt_jd1, tt_jd2, earth_heliocentric_, earth_barycentric_);
    // IAU 2000B, with 77 terms of nutation for the 1365 of IAU 2006/2000A: half the time, and no
    // difference to be seen against DE431 (worst 0.0165 arcsec with either, of which 0.015 is the
    // Earth's place).
    double npb[3][3];
    eraPnm00b(tt_jd1, tt_jd2, npb);
    double x = 0, y = 0;
    eraBpn2xy(npb, &x, &y);
    const double s = eraS00(tt_jd1, tt_jd2, x, y);
    eraC2ixys(x, y, s, to_cirs_);
    equation_of_origins_rad_ = eraEors(npb, s);
}

glm::dvec3 SolarEphemeris::apparent_au(const glm::dvec3& from_geocenter_m,
                                       const glm::dvec3& velocity_m_s) const {
    double observer[2][3] = {{from_geocenter_m.x, from_geocenter_m.y, from_geocenter_m.z},
                             {velocity_m_s.x, velocity_m_s.y, velocity_m_s.z}};
    eraTrxpv(const_cast<double(*)[3]>(to_cirs_), observer, observer);
    eraASTROM astrom;
    eraApcs(tt_jd_[0], tt_jd_[1], observer, const_cast<double(*)[3]>(earth_barycentric_),
            const_cast<double*>(earth_heliocentric_[0]), &astrom);

    // The sun moves, too (a turn about the barycentre in 12 years): it is seen where it was when
    // the light left. Twice is enough: the correction is 0.01 arcsec.
    const auto& [sun_from_earth, sun_velocity] = earth_heliocentric_;
    double to_sun[3] = {0, 0, 0};
    double distance = 1;
    for (int pass = 0; pass < 2; ++pass) {
        const double days = distance * ERFA_AULT / ERFA_DAYSEC;
        for (int i = 0; i < 3; ++i) {
            const double position = earth_barycentric_[0][i] - sun_from_earth[i];
            const double velocity = earth_barycentric_[1][i] - sun_velocity[i];
            to_sun[i] = position - velocity * days - astrom.eb[i];
        }
        distance = eraPm(to_sun);
    }
    double direction[3], seen[3];
    eraSxp(1 / distance, to_sun, direction);
    eraAb(direction, astrom.v, astrom.em, astrom.bm1, seen);
    double cirs[3];
    eraRxp(const_cast<double(*)[3]>(to_cirs_), seen, cirs);
    return distance * glm::dvec3(cirs[0], cirs[1], cirs[2]);
}

double SolarEphemeris::right_ascension_rad(const glm::dvec3& cirs) const {
    return eraAnp(std::atan2(cirs.y, cirs.x) - equation_of_origins_rad_);
}

double declination_rad(const glm::dvec3& cirs) {
    return std::atan2(cirs.z, std::hypot(cirs.x, cirs.y));
}

glm::dvec3 SolarEphemeris::icrs(const glm::dvec3& cirs) const {
    double in[3] = {cirs.x, cirs.y, cirs.z}, out[3];
    eraTrxp(const_cast<double(*)[3]>(to_cirs_), in, out);
    return {out[0], out[1], out[2]};
}

glm::dvec3 SolarEphemeris::cirs(const glm::dvec3& icrs) const {
    double in[3] = {icrs.x, icrs.y, icrs.z}, out[3];
    eraRxp(const_cast<double(*)[3]>(to_cirs_), in, out);
    return {out[0], out[1], out[2]};
}

glm::dvec3 SolarEphemeris::earth_velocity_m_s() const {
    const double* au_d = earth_barycentric_[1];
    return glm::dvec3(au_d[0], au_d[1], au_d[2]) * (ERFA_DAU / ERFA_DAYSEC);
}

TurnedEarth::TurnedEarth(const Epoch& epoch)
    : angle_rad_(eraEra00(epoch.ut1_jd[0], epoch.ut1_jd[1])),
      pole_x_rad_(epoch.pole_x_rad),
      pole_y_rad_(epoch.pole_y_rad),
      sp_rad_(eraSp00(epoch.tt_jd[0], epoch.tt_jd[1])) {
    double polar[3][3];
    eraIr(to_itrs_);
    eraRz(angle_rad_, to_itrs_);
    eraPom00(pole_x_rad_, pole_y_rad_, sp_rad_, polar);
    eraRxr(polar, to_itrs_, to_itrs_);
}

TurnedEarth::Motion TurnedEarth::motion(const geo::Geodetic& place) const {
    double pv[2][3];
    eraPvtob(place.lon_rad, place.lat_rad, place.height_m, pole_x_rad_, pole_y_rad_, sp_rad_,
             angle_rad_, pv);
    return {{pv[0][0], pv[0][1], pv[0][2]}, {pv[1][0], pv[1][1], pv[1][2]}};
}

glm::dvec3 TurnedEarth::itrs(const glm::dvec3& cirs) const {
    double in[3] = {cirs.x, cirs.y, cirs.z}, out[3];
    eraRxp(const_cast<double(*)[3]>(to_itrs_), in, out);
    return {out[0], out[1], out[2]};
}

glm::dvec3 TurnedEarth::cirs(const glm::dvec3& itrs) const {
    double in[3] = {itrs.x, itrs.y, itrs.z}, out[3];
    eraTrxp(const_cast<double(*)[3]>(to_itrs_), in, out);
    return {out[0], out[1], out[2]};
}

}  // namespace relevo::sun
