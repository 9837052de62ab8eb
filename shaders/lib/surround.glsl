//! provides  surround_sea, surround_sea_albedo: the sea around a DEM that is mostly sea
//! reads     share of the DEM's posts that are floor of a sea

/// Albedo of a deep sea as overviews show it, chosen by eye.
const vec3 surround_sea_albedo = vec3(0.007, 0.043, 0.133);

/// How far what lies beyond the DEM is sea, 0 to 1: nobody knows it, but around a DEM that is mostly sea it is likely.
float surround_sea() {
    return smoothstep(0.5, 0.7, frame.sea_floor_share);
}
