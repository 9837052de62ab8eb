/* Relevo as a library, in C (C99 and later, C++): DEMs, figures of sunlight over them, and
 * pictures.
 *
 *   relevo_session* session;
 *   if (relevo_open("{\"dem\": {\"files\": [\"alps.tif\"]}}", NULL, &session) != RELEVO_RESULT_OK)
 *       fprintf(stderr, "%s\n", relevo_error());
 *
 * Rules of all functions:
 *   - Results are codes. relevo_error() has the sentence, which the program would print.
 *   - Handles are made by functions that open and end with those that close. A handle that is null
 *     or closed is RELEVO_RESULT_BAD_CALL, never a crash. Closing null does nothing.
 *   - Arrays are the caller's. Each comes with its number of elements, which has to be the one that
 *     is needed: another one is RELEVO_RESULT_BAD_CALL, and nothing is written.
 *   - Texts are UTF-8 and end with 0. A text that a function returns through `const char**` is the
 *     library's, and lasts until the same thread calls another function that returns one.
 *   - Every struct begins with `size`, which the caller sets to its sizeof. Later versions add
 *     members at the end; what lies beyond `size` counts as 0.
 *   - Options are JSON, an object with the keys that are listed, or null for none. An unknown key
 *     is an error. Scenes are those of docs/scene.md.
 *   - Functions may be called on any thread, and of one DEM on several at once. Calls on one
 *     session wait for each other; sessions are independent of each other.
 *   - Angles are degrees, azimuths clockwise from true north. Places are WGS 84, longitudes
 *     positive east. Times are seconds since 1970-01-01T00:00Z without leap seconds, 1900 to 2100.
 *     Rasters have the DEM's rows in their order; voids are NaN.
 *
 * Messages are those of the program, also where they name its options: `--crs` is the option `crs`.
 * GDAL is left as the process has it, also its access to the net; the program takes from it what
 * files from others could misuse.
 *
 * Code of effects can end the process: GLSL that never ends on the device, after RELEVO_PATIENCE_S
 * seconds (20), and a native module that crashes, hangs or exits.
 */
#ifndef RELEVO_RELEVO_H
#define RELEVO_RELEVO_H

#include <stddef.h>
#include <stdint.h>

#define RELEVO_VERSION_MAJOR 0
#define RELEVO_VERSION_MINOR 2
#define RELEVO_VERSION_PATCH 0

#if defined(_WIN32)
#define RELEVO_API
#else
#define RELEVO_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef int32_t relevo_result;
#define RELEVO_RESULT_OK 0
#define RELEVO_RESULT_FAILED 1    /* the system or a driver refuses; a callback threw */
#define RELEVO_RESULT_BAD_CALL 2  /* the call itself: null, a closed handle, a wrong size */
#define RELEVO_RESULT_BAD_INPUT 3 /* a file, an option or a value */
#define RELEVO_RESULT_NO_DEVICE 4 /* no GL device that can draw */
#define RELEVO_RESULT_CANCELLED 5 /* by relevo_progress */
#define RELEVO_RESULT_OUT_OF_MEMORY 6

/* Version of the library that is loaded: "0.2.0". */
RELEVO_API const char* relevo_version(void);

/* Why the last call that failed on this thread did; "" before any. Lasts until the next failure. */
RELEVO_API const char* relevo_error(void);

/* Receives messages: assumptions, warnings, and with them what was skipped.
 * Called on any thread, one call at a time. Must not call the library. */
#define RELEVO_MESSAGE_DEBUG 0
#define RELEVO_MESSAGE_INFO 1
#define RELEVO_MESSAGE_WARNING 2 /* the result may not be what the user expects */
typedef void (*relevo_message)(void* user, int32_t level, const char* text);
/* @param message  null: warnings go to standard error, which is so from the beginning */
RELEVO_API relevo_result relevo_set_message(relevo_message message, void* user);

/* Progress of long work. `done` is called with the share that is done, 0 to 1, on any thread, one
 * call at a time. Anything but 0 cancels the work. */
typedef struct relevo_progress {
    size_t size;
    void* user;
    int32_t (*done)(void* user, double share); /* may be null */
    /* Since 0.2, for callers that poll from another thread instead; each may be null. */
    int32_t* cancel; /* anything but 0 in it cancels the work */
    double* share;   /* receives the share */
} relevo_progress;

/* ---- DEMs ---- */

typedef struct relevo_dem relevo_dem;

/* Opens files as one DEM, in any format that the program opens.
 * @param options  as `dem` of a scene, without `files`: crs, band, unit, nodata, encoding, bounds,
 *     crop, memory_mib. Since 0.2 also "surroundings": ["30m.tif"], wider and coarser DEMs in which
 *     this one lies: their ground shades figures, too (not pictures) */
RELEVO_API relevo_result relevo_dem_open(const char* const* files, size_t count,
                                         const char* options, relevo_dem** dem);

/* Heights in memory as a DEM. They are copied. */
typedef struct relevo_raster {
    size_t size;
    /* Row by row; NaN for voids. Metres, unless `options` or the vertical part of the CRS say
     * another unit. */
    const float* heights_m;
    size_t count;          /* columns * rows */
    int32_t columns, rows; /* at least 2 each */
    /* From corners of cells to coordinates of the CRS, as GDAL's geotransform:
     * x = t[0] + t[1] column + t[2] row, y = t[3] + t[4] column + t[5] row. */
    double transform[6];
    const char* crs; /* "EPSG:32632", WKT or a PROJ string */
    /* As those of relevo_dem_open(), without crs; null: none. Besides:
     * "scale", "offset": height = offset + scale * number, in the unit (1, 0)
     * "voids_known": true: NaN alone marks voids. Else a number far from all heights, such as
     *     -9999, does so too, as in files that declare none; "nodata": "none" keeps it. */
    const char* options;
} relevo_raster;
RELEVO_API relevo_result relevo_dem_from_heights(const relevo_raster* heights, relevo_dem** dem);

/* Sessions and calls under way keep what they need. */
RELEVO_API void relevo_dem_close(relevo_dem* dem);

/* From now on rasters of a DEM are shaded also by the ground of a wider and coarser one around it.
 * Times and zones of the middle are those of the wider one. Since 0.2.
 * @param around  null: none */
RELEVO_API relevo_result relevo_dem_around(relevo_dem* dem, relevo_dem* around);

typedef struct relevo_grid {
    size_t size;
    int32_t columns, rows;
    double transform[6]; /* as in relevo_raster */
    double centre_lat_deg, centre_lon_deg;
    double column_spacing_m, row_spacing_m; /* ground between posts at the centre */
} relevo_grid;
RELEVO_API relevo_result relevo_dem_grid(relevo_dem* dem, relevo_grid* grid);

/* The CRS: its code ("EPSG:32632") where it has one, else WKT 2. */
RELEVO_API relevo_result relevo_dem_crs(relevo_dem* dem, const char** crs);

/* The CRS as WKT 2, on one line. */
RELEVO_API relevo_result relevo_dem_wkt(relevo_dem* dem, const char** wkt);

/* All heights [m]. @param count  columns * rows */
RELEVO_API relevo_result relevo_dem_read(relevo_dem* dem, float* heights_m, size_t count);

/* The height at a place, bilinear between posts; NaN in a void and outside of the DEM. */
RELEVO_API relevo_result relevo_dem_height(relevo_dem* dem, double lat_deg, double lon_deg,
                                           double* height_m);

/* Heights at `count` places. Since 0.2. */
RELEVO_API relevo_result relevo_dem_heights(relevo_dem* dem, const double* lat_deg,
                                            const double* lon_deg, size_t count, double* height_m);

/* ---- the sun ---- */

typedef struct relevo_place {
    size_t size;
    double lat_deg, lon_deg;
    double height_m; /* above the WGS 84 ellipsoid; not used where a DEM has the height */
} relevo_place;

/* Where the sun stands at each of `count` times. Accuracy: docs/accuracy.md (0.1 arcsec from 1962
 * to 2026).
 * @param refraction  "standard", "saemundsson" or "none"; null: "standard"
 * @param azimuth_deg, elevation_deg  without an atmosphere; each may be null
 * @param apparent_deg                elevation with refraction; may be null */
RELEVO_API relevo_result relevo_sun_position(const relevo_place* place, const double* times_s,
                                             size_t count, const char* refraction,
                                             double* azimuth_deg, double* elevation_deg,
                                             double* apparent_deg);

/* Something that the sun does over a level horizon. */
typedef struct relevo_event {
    size_t size;      /* in an array that of the first one counts for all */
    const char* kind; /* "sunrise", "transit", "civil_dusk" ...; lasts as long as the library */
    double time_s;
    double azimuth_deg, elevation_deg; /* of the centre, without refraction */
} relevo_event;
/* Events of a local day in order of time, by the rule of the Naval Observatory.
 * @param date      "2026-06-21"
 * @param zone      "Europe/Zurich", "+02:00"; null: that of the place
 * @param events    `size` of the first one is to be set
 * @param capacity  of `events`; as many as fit are filled
 * @param count     receives how many there are */
RELEVO_API relevo_result relevo_sun_events(const relevo_place* place, const char* date,
                                           const char* zone, relevo_event* events, size_t capacity,
                                           size_t* count);

/* Elevation of the horizon that the ground makes around a place, terrestrial refraction included.
 * Accuracy: 0.0001 degrees for the heights that are given.
 * @param options      "eye_height" [m above the ground] (0), "terrestrial_refraction" (0.13)
 * @param azimuth_deg  `count` directions
 * @param elevation_deg, distance_m  of `count` elements; distance is that of the ground that makes
 *     the horizon, NaN beyond the DEM; may be null */
RELEVO_API relevo_result relevo_horizon(relevo_dem* dem, const relevo_place* place,
                                        const char* options, const double* azimuth_deg,
                                        size_t count, double* elevation_deg, double* distance_m);

/* A figure of a place, as the program says it with --json. Since 0.2.
 * @param dem      null for figures without terrain; the carpet, "when" and "along" need one
 * @param figure   "sun position", "moon position": {"positions": [...]} of "times" (a list)
 *     "sun day", "moon day", "sun eclipses": of "date", or "from" and "to", or "year"; of days
 *     always as {"days": [...]}
 *     "sun carpet": of a "year"; "step" [s] (180)
 *     "sun when", "moon when": of days; "over" ("LAT,LON", "LAT,LON,H"), "summit_radius" [m] (100),
 *     "tolerance" [degrees] (0.5)
 *     "sun along": of a "walk", not of a place: [[lat, lon], ...] with "times" (a list) or without,
 *     or a file (GPX, GeoJSON, CSV) with "track" (from 1) and "points_crs"; "start", "speed" [km/h]
 *     (the walk's own times), "name"; "zone", "eye_height", "terrestrial_refraction", "highest"
 *     "halo": how many "columns" and "rows" a halo of so many km has around a tile, and of how many
 *     posts a side the "means" of ground beyond may be, for relevo_dem_around(); without others
 * @param options  others: "lat", "lon" [degrees], "height" [m above sea level]; all: "refraction"
 *     with days: "zone", "eye_height" [m above the ground], "terrestrial_refraction", "highest";
 *     of risings and light: "limb" ("upper", "center", "lower"), "dip" [degrees] (not the carpet)
 * @param answer   receives JSON */
RELEVO_API relevo_result relevo_answer(relevo_dem* dem, const char* figure, const char* options,
                                       const char** answer);

/* ---- rasters of light ---- */

/* Rasters have a value for each post of the DEM: columns * rows elements, bands one after the
 * other. Values are those that the program writes, to the bit.
 *
 * Options of all: "terrestrial_refraction" (0.13), "refraction" ("standard"), "highest" [m]: what
 * no terrain outside of the DEM exceeds, for "beyond" and its warning (the DEM's highest post);
 * "clip": "W,S,E,N" in the DEM's CRS or "clip_crs": only posts in it, shaded by the whole DEM, NaN
 * elsewhere (since 0.2).
 * `about`, which may be null, receives JSON with "definition", "holes" and "bands" ([{"name",
 * "unit"}], "1" for plain numbers), where ground beyond the DEM could change values "beyond", and
 * "metadata": those of the program's GeoTIFF (since 0.2). `progress` may be null. */

/* Light and shade at a time: 1 lit, 0 in the shadow of the ground.
 * @param options  "time" ("2026-06-21T18:30+02:00", "sunset-30min at 47.2,11.4"), "date", "zone" as
 *     `time` of a scene; or "times", a list of seconds since 1970, a band for each; or "sun", as it
 *     is seen ("AZ,EL", "grid:AZ,EL") (both since 0.2); "soft" (false): the visible fraction of
 *     the sun's disc
 * @param count    columns * rows * number of times */
RELEVO_API relevo_result relevo_shadow(relevo_dem* dem, const char* options, float* lit,
                                       size_t count, const relevo_progress* progress,
                                       const char** about);

/* Hours of direct sun, and what belongs to them.
 * @param options  "date", or "from" and "to" (both included), or "year"; "zone"; "step" [s] (180);
 *     "bands" (["hours"]): hours, first, last [min from the beginning], spells; global, beam,
 *     diffuse, reflected [kWh/m2]; "linke" (3), "albedo" (0.2),
 *     "tilt" and "azimuth" of a plane at each post [degrees, clockwise from true north] (the
 * ground's)
 * @param count    columns * rows * number of bands */
RELEVO_API relevo_result relevo_sun_hours(relevo_dem* dem, const char* options, float* values,
                                          size_t count, const relevo_progress* progress,
                                          const char** about);

/* The sky-view factor of each post, 0 to 1.
 * @param options  "directions" (36), "level" (false): of a level plane instead of the ground as it
 *     is inclined. No "refraction". */
RELEVO_API relevo_result relevo_sky_view(relevo_dem* dem, const char* options, float* share,
                                         size_t count, const relevo_progress* progress,
                                         const char** about);

/* The horizon of each post [degrees], a band for each direction, evenly spread from north. Since
 * 0.2.
 * @param options  "directions" (36). No "refraction".
 * @param count    columns * rows * directions */
RELEVO_API relevo_result relevo_horizons(relevo_dem* dem, const char* options, float* elevation_deg,
                                         size_t count, const relevo_progress* progress,
                                         const char** about);

/* A raster of light as tiles in a folder, GeoTIFFs of the program's kind, or what it would take.
 * Since 0.2.
 * @param figure   "shadow", "sun_hours", "sky_view", "horizons"
 * @param options  of that figure
 * @param files    "folder"; with it "tiles", posts a side (512), "halo" [km], "resume" and
 *     "overwrite" (false). Null: one raster is estimated from a small part, and nothing is written
 * @param answer   may be null; receives JSON. Of tiles: "made" and "there", how many. Else:
 * "posts", "parts", "memory_mib", "computing_s", "sampled_share", "threads", "bands",
 * "result_bytes" */
RELEVO_API relevo_result relevo_tiles(relevo_dem* dem, const char* figure, const char* options,
                                      const char* files, const relevo_progress* progress,
                                      const char** answer);

/* ---- pictures ---- */

/* A scene on a device: what the program draws. It has a thread of its own. */
typedef struct relevo_session relevo_session;

typedef struct relevo_open_options {
    size_t size;
    const char* device; /* "auto", "gpu", "software" ...; null: "auto" */
    const char* folder; /* from which relative file names count; null: the working folder */
    relevo_dem* dem;    /* the scene's DEM, which then needs no `dem`; null: opened from `dem` */
} relevo_open_options;

/* Opens a scene: its DEM, its effects and a device.
 * @param scene    JSON; `format` may be missing. Null: that of the DEM in the options with all
 *     defaults. File names in it are used as those of the caller's
 * @param options  may be null */
RELEVO_API relevo_result relevo_open(const char* scene, const relevo_open_options* options,
                                     relevo_session** session);
RELEVO_API void relevo_close(relevo_session* session);

/* Changes a scene by a part of one, such as {"time": {"at": "2026-12-21T15:00Z"}}, as `shots` of a
 * job do (docs/jobs.md): a camera replaces the one before, effects are added, other members take
 * the place of the scene's. After an error the scene is as it was.
 * @param change  JSON. Another `dem` is an error: open another session */
RELEVO_API relevo_result relevo_set(relevo_session* session, const char* change);

/* Size of pictures [px]. As relevo_set() of {"picture": {"size": [columns, rows]}}. */
RELEVO_API relevo_result relevo_resize(relevo_session* session, int32_t columns, int32_t rows);

/* The scene with what was chosen for it: JSON, the time in UTC, absolute paths. */
RELEVO_API relevo_result relevo_scene(relevo_session* session, const char** scene);

/* Size of the scene's picture [px]: of a map, a panorama or a picture with a margin not what
 * relevo_resize() was given. */
RELEVO_API relevo_result relevo_picture_size(relevo_session* session, int32_t* columns,
                                             int32_t* rows);

/* What relevo_draw_picture() fills: rows from the top. Null: not wanted. Counts are numbers of
 * elements. */
typedef struct relevo_picture {
    size_t size;
    uint8_t* rgba; /* 4 a pixel: sRGB, and alpha, which is 255 unless the scene is transparent */
    size_t rgba_count;
    /* The rest is of the middle of a pixel, without marks and stamps. Not of stereo pairs,
     * panoramas and pictures with a margin. */
    float* depth_m; /* from the eye along the optical axis; infinite without ground */
    size_t depth_count;
    float* position_m; /* 3 a pixel: east, north, up of the scene's origin; NaN without ground */
    size_t position_count;
    float* normal; /* 3 a pixel: unit normal of the ground, east, north, up; 0 without ground */
    size_t normal_count;
    /* Filled: the origin of positions, a place on the ellipsoid. */
    double origin_lat_deg, origin_lon_deg, origin_height_m;
} relevo_picture;
/* Draws the scene, the same bytes whatever was drawn before. The first picture with depth,
 * positions or normals takes a second set of the device's buffers. */
RELEVO_API relevo_result relevo_draw_picture(relevo_session* session, relevo_picture* picture);

#ifdef __cplusplus
}
#endif

#endif
