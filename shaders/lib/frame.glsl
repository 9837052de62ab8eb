//! provides  frame: values that are the same for every pixel of a frame; names are append-only.
//!           The build makes the host's structs, one of each part: EyeBlock and others.
//! frame     x east, y north, z up at the DEM's centre, metres; radiance 1 is what a white diffuse
//!           surface facing the sun outside the atmosphere reflects

layout(std140, binding = 0) uniform Frame {
    /// Eye: where the picture is seen from, and the rays of its pixels
    mat4 view_projection;     // from eye-relative metres to clip space, reversed depth
    vec4 pixel_ray;           // xyz: ray through the corner of pixel (0, 0), at view depth 1
    vec4 pixel_ray_dx;        // xyz: its change from pixel to pixel, to the right
    vec4 pixel_ray_dy;        // xyz: and up
    vec4 eye_m;               // xyz: the eye from the DEM's centre; w: its height above the DEM's zero
    vec4 eye_up;              // xyz: vertical at the eye; w: sine of the horizon's elevation, 0 or below
    vec4 eye_anchor;          // a point near the eye, for lib/repeats.glsl; xy: east and north of the DEM's centre, in
                              // whole steps of 2048 m; zw: from there to the eye [m]
    vec4 up_at_eye;           // xyz: normal of the ellipsoid below the eye, scaled for up_matrix
    mat4 up_matrix;           // its change with position: up(p) = normalize(up_at_eye + up_matrix p)
    vec4 polar_axis;          // xyz: unit vector along the Earth's axis, northwards
    vec4 eye_post;            // below the eye, column and row of the DEM; xy: whole parts, zw: fractions
    vec4 eye_axes;            // xy: columns and rows to a metre east, zw: north, there; 0 where that is unknown
    vec4 eye_bends[2];        // how that changes with the way: xyz of columns, [0], and of rows, [1], to a square metre east,
                              // east by north, and north; 0 where that is unknown
    float eye_above_ground;   // height of the eye above the posts below it, as drawn [m]; 1e9 where there are none
    /// Sun: the light on the ground, its shadows, and the sky's
    vec4 sun_direction;       // xyz: towards the sun at the DEM's centre, or the moon that lights a night (eye_moon_light),
                              // geometric; w: its elevation [rad]
    vec4 sun_apparent;        // xyz: the same with refraction; w: apparent elevation [rad]
    vec4 sun_light[4];        // [0]: rgb irradiance on a surface that faces the sun, in the middle of the DEM and of its
                              // heights, with refraction; the others are 0. sun_light_at() has it by height
    vec4 sky_irradiance;      // rgb: on level ground from the whole sky, there; light_of_sky_at() has it by height
    vec4 sun_light_domain;    // of sun_light_table; x: where it begins, y: entries of it a unit, on the scale of
                              // sun_light_scale()
    vec4 sun_light_table[128];  // over the DEM, by the sine of the geometric elevation: as sun_light[0] (sun_light())
    vec4 light_heights;       // of light_by_height, for lib/ground.glsl; x: height of its first row [m], y: 1 / (its last - its
                              // first) [1/m]
    vec4 light_grid;          // of render/ground_light.h: texels per post, x: of light_clearance, y: of light_sky; z: of height_means;
                              // w: limit of clearances [m]
    vec4 light_axes;          // xy: columns and rows of the DEM to a metre east, zw: north, at its centre
    vec4 light_map;           // x: 1 where these are so everywhere by the compass, 0 where they are by the frame's x, y;
                              // y: mean slope of the ground as a picture of the whole DEM shows it, where lib/height_means.glsl is read
    vec4 instance_shadow_axes[3];  // of the shadow maps; xyz: across the light, upwards across it, towards the sun
    vec4 instance_shadow_maps[3];  // finest first; xyz: from a map's centre to the eye along these axes [m], w: 1 / half of
                              // its side [1/m]
    vec4 instance_shadow_eye;  // xyz: from the eye to where it was when the last map was drawn [m]
    float instance_shadow_px;     // side of a shadow map of instances
    float instance_shadow_weight; // 1 where there are such maps, else 0
    /// Sky: sun, moon, stars and air before the eye
    vec4 eye_sun;             // xyz: towards the sun as the eye sees it, with refraction; w: its elevation [rad]
    vec4 eye_sun_light;       // rgb: irradiance there on a surface that faces it; a: how much the air at the eye
                              // bends light, 1 is 59.7 arcsec at an elevation of 45 degrees
    vec4 air_mapping;         // lib/air.glsl; x, y: bands above and below the horizon, z: farthest distance [m], w: extinction
                              // of white light at height 0 [1/m]
    vec4 air_colour;          // rgb: extinction, relative to that of green light; w: square of the eye's distance from the
                              // Earth's centre less that of the top of the air [m2]
    float air_scale;          // of distances in the air before the ground: below 1 in aerial views of wide DEMs
    float air_near_m;         // in aerial views: there is no air before this distance [m]
    vec4 celestial[3];        // xyz: rows of the rotation from the local frame to the axes of star catalogues (ICRS);
                              // w: velocity of the place there, over that of light
    vec4 eye_moon;            // xyz: towards the moon as the eye sees it, with refraction; w: its semidiameter [rad], 0: it is
                              // below the horizon, and the moon's other members and the corona are 0
    vec4 eye_moon_light;      // rgb: irradiance there on a surface that faces it; a: 1 where the moon is the direct light of
                              // sun_direction, sun_apparent and sun_light, at night; else 0
    vec4 moon_to_sun;         // xyz: towards the sun from the moon
    vec4 moon_axis;           // xyz: axis of the moon, northwards
    vec4 moon_radiance;       // rgb: of its full disc before the eye; a: that of its dark side, relative
    vec4 corona;              // rgb: in totality, irradiance that the sun would have at the eye; else 0
    /// Ground: the DEM, what lies on it and what is around it
    vec4 height_range;        // x: lowest post [m], y: 1/(highest - lowest) [1/m], z: exaggeration,
                              // w: lowest that effects move ground to [m], before exaggeration
    vec4 ground_extent;       // xy: the DEM's south-west corner, zw: 1/its width and 1/its height, in ground_m
    vec4 posts;               // xy: columns and rows of the DEM, zw: their inverses
    vec4 block;               // of a DEM seen from outside; x: height of its lower side, before exaggeration [m], y: z of
                              // the floor that it stands on, z: depth below its lowest post, both drawn [m]; z 0: none
    vec4 footprint_area;      // of the texture floor_ground; xy: its south-west corner, zw: 1/its sides, in the local frame
    vec4 climate_place;       // lib/climate.glsl: factor and constant from longitudes off the DEM's centre, and from
                              // latitudes [rad], to the table's coordinates
    vec4 climate_height;      // xy: factor and constant from heights [m] to the table, of the ground's half;
                              // zw: its first and last coordinate
    vec4 overlay_texels;        // of an overlay, for lib/overlay.glsl; xy: post of its first texel, zw: texels per post
    vec4 overlay_shape;          // xy: its last texel, z: levels, w: 1 where it is lit
    vec4 land_cover;          // of lib/land.glsl; x: 1 where there is a map of what covers the ground, y: 1 where that is
                              // made of shares, else 0; zw: texels of land_classes to a column and row
    vec4 land_place;          // as climate_place, of land_around
    float normal_texels_per_m;  // of the finest normal pages
    float normal_levels;      // of normal pages
    float sea_floor_share;    // of the DEM's posts that are below a sea and have the height of its floor, 0..1
    float sea_rim_share;      // of the posts along the DEM's edge that are sea, 0..1
    float beyond;             // 1 where ground is made up beyond the DEM (lib/beyond.glsl), else 0
    float beyond_m;           // height of that ground where it is level, before exaggeration [m]
    /// Picture: its pixels, exposure and time
    vec4 viewport;            // width, height [px], and their inverses
    vec4 picture;             // the whole picture; xy: width and height [px], zw: their inverses
    vec4 map_x;               // of an orthographic picture from above: x in clip space, over w, of a column and row of
    vec4 map_y;               // the DEM; x: a column, y: a row, z: of (0, 0); and y. All 0 of other pictures
    float part_left;          // of a frame that is a tile of a large picture: its lower left corner from that of the
    float part_below;         // picture [px]; 0 where the frame is the picture
    float exposure;           // factor on radiance before tone mapping, already in what is stored
    float footprint_limit;    // longest to shortest side of a pixel's footprint that textures resolve
    float seconds;            // of effects that move [s]: --seconds, or the time that the window has been open
    float still_seconds;      // as seconds: a window does not draw on for effects that read only this [s]
    float time_of_year;       // 0 at the beginning of January, 1 at the end of December, UTC
} frame;
