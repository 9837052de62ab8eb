/* The interface between Relevo and native plugins, in C (C99 and later, C++).
 *
 * A native plugin is a shared library that plugin.json names as its `module`. It exports two
 * symbols: the word `relevo_plugin_abi`, which is read before anything of it is called, and the
 * function `relevo_plugin_register`, which fills a table of the module's functions. The host calls
 * those; the module calls the host through services, which it asks for by name and version.
 *
 * Rules, for both sides:
 *   - The major version has to be equal. Within a major version nothing that is here changes:
 *     structs grow at their end, by members for words that have no room in a reserved one, and
 *     services are added.
 *   - Every struct begins with `size`, which whoever makes the struct sets to its sizeof; a
 * service's table has the host's. The other side reads and writes no member beyond. A function of a
 * table that lies beyond its size is one that the host does not have.
 *   - No struct has padding. Members named `reserved` are 0.
 *   - No argument is null where it is not said that it may be; one that is makes the call fail.
 *   - No exception leaves a function, and what one side has allocated the other does not free.
 *   - Every function is called on the thread that draws. Texts are UTF-8, end with 0 and live only
 *     as long as the call, save where said otherwise.
 *   - Lengths are metres, positions are in the DEM's local frame: x east, y north, z up at its
 *     centre. The Earth is round in it. Matrices are column-major.
 *
 * relevo/plugin.hpp makes all this pleasant in C++. docs/plugin-guide.md has an example.
 */
#ifndef RELEVO_PLUGIN_H
#define RELEVO_PLUGIN_H

#include <stdint.h>

#define RELEVO_ABI_MAJOR 2u
#define RELEVO_ABI_MINOR 1u
#define RELEVO_ABI_VERSION (RELEVO_ABI_MAJOR << 16 | RELEVO_ABI_MINOR)

#if defined(_WIN32)
#define RELEVO_PLUGIN_EXPORT __declspec(dllexport)
#else
#define RELEVO_PLUGIN_EXPORT __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Whether a function did what it was asked to. On RELEVO_FAILED the reason has been given to
 * `relevo_host::fail`, by whichever side failed. */
typedef int32_t relevo_status;
#define RELEVO_OK 0
#define RELEVO_FAILED 1
#define RELEVO_NOTHING 2 /* there is none of what was asked for, which is no fault */

/* What the host offers a module. Lives as long as the module's instance. */
typedef struct relevo_host relevo_host;
struct relevo_host {
    uint32_t size;
    uint32_t abi_version; /* the host's RELEVO_ABI_VERSION */
    /* A service's table, such as relevo_log_1 for "relevo.log", 1; null if this host has none of
     * that name and version. Tables live as long as the host. */
    const void* (*service)(const relevo_host* host, const char* name, uint32_t version);
    /* Keeps the reason why something failed, which the user will read. */
    void (*fail)(const relevo_host* host, const char* reason);
};

/* What a module offers the host. Texts and functions live as long as the library is loaded. */
typedef struct relevo_module {
    uint32_t size; /* the host's; filled members are those below both sizes */
    uint32_t reserved;
    const char* id; /* of the plugin, as in plugin.json */
    /* Makes an instance once a device is there; null `*instance` is allowed. */
    relevo_status (*create)(const relevo_host* host, void** instance);
    void (*destroy)(void* instance);
    /* Called for every frame, before its picture is drawn. May be null. */
    relevo_status (*prepare)(void* instance);
} relevo_module;

/* What a module exports. Every function is called in a process of its own first, where a crash
 * harms nobody: the services there have no device behind them, textures hold zeros, and the DEM is
 * a plain. relevo_plugin_register() is offered no service but "relevo.log". */
extern RELEVO_PLUGIN_EXPORT const uint32_t relevo_plugin_abi;
RELEVO_PLUGIN_EXPORT relevo_status relevo_plugin_register(const relevo_host* host,
                                                          relevo_module* module);

/* ---- services ---- */

/* "relevo.log", 1: messages for people. */
#define RELEVO_LOG_DEBUG 0
#define RELEVO_LOG_INFO 1
#define RELEVO_LOG_WARNING 2
typedef struct relevo_log_1 {
    uint32_t size;
    uint32_t reserved;
    void* self; /* first argument of every function here; so for each service */
    void (*write)(void* self, int32_t level, const char* text);
} relevo_log_1;

/* "relevo.params", 1: values of the parameters that the plugin's GLSL declares, and of the texts
 * and files that its plugin.json does. Values are as people write them (angles in degrees),
 * components that a type lacks are 0. */
typedef struct relevo_params_1 {
    uint32_t size;
    uint32_t reserved;
    void* self;
    /* @param address  "haze.density" */
    relevo_status (*get)(void* self, const char* address, double value[4]);
    /* Writes one that is marked `host`, for this frame and those after it. */
    relevo_status (*set)(void* self, const char* address, const double value[4]);
    /* A text, or the path of a file; "" where none is given.
     * @param text      filled with as much as fits, and always ended; null to ask for the length
     * @param capacity  of `text`, with the ending 0 [bytes]
     * @param length    filled with that of the whole text, without the 0 [bytes]; may be null */
    relevo_status (*get_text)(void* self, const char* address, char* text, uint64_t capacity,
                              uint64_t* length);
} relevo_params_1;

/* "relevo.frame", 1: what is drawn now. */
typedef struct relevo_frame {
    uint32_t size;
    int32_t width_px, height_px; /* of the picture */
    int32_t software_device;     /* 1: drawn on the processor */
    uint64_t ground;             /* another number: other ground, or another shape of it */
    double unix_s; /* the moment, seconds since 1970-01-01T00:00Z without leap seconds */
    double eye_m[3];
    double right[3], up[3], forward[3]; /* the picture's axes, unit, orthogonal */
    double fov_y_rad;                   /* angle of view from bottom to top */
    double pixel_rad;                   /* angle of a pixel in the middle of the picture */
    /* From positions less `eye_m` to the picture's axes, and from there to clip space, in which
     * depth runs from 1 at the near plane to 0 at infinity. */
    double view[16], projection[16];
    double exposure;            /* factor from radiance to what is tone-mapped */
    double sun[3];              /* towards the sun at the DEM's centre, without refraction, unit */
    double sun_apparent[3];     /* with refraction */
    double exaggeration;        /* factor on heights */
    double lowest_m, highest_m; /* heights of the DEM, not exaggerated */
    double post_spacing_m;      /* of the DEM at its centre */
    uint32_t afresh;            /* 1: the picture must be the same whatever was drawn before */
    uint32_t reserved;
} relevo_frame;
typedef struct relevo_frame_1 {
    uint32_t size;
    uint32_t reserved;
    void* self;
    /* Only inside prepare(). */
    relevo_status (*get)(void* self, relevo_frame* frame);
} relevo_frame_1;

/* "relevo.texture", 1: textures on the device. */
typedef uint32_t relevo_texture; /* 0: none */
#define RELEVO_FORMAT_R32F 1
#define RELEVO_FORMAT_RG32F 2
#define RELEVO_FORMAT_RGBA32F 3
#define RELEVO_FORMAT_RG16F 4
#define RELEVO_FORMAT_RGBA16F 5
#define RELEVO_FORMAT_DEPTH32F 6
#define RELEVO_FORMAT_R16F 7
#define RELEVO_FORMAT_RGBA8 8
#define RELEVO_FILTER_NEAREST 0
#define RELEVO_FILTER_LINEAR 1
#define RELEVO_FILTER_MIPMAP 2
typedef struct relevo_texture_info {
    uint32_t size;
    int32_t format, filter; /* one of those above */
    int32_t width, height;  /* [px] */
    int32_t layers;         /* 0: a sampler2D, else a sampler2DArray */
    int32_t levels;         /* of the mip chain; 0: all of it */
    uint32_t reserved;
    /* The sampler `<id>_<name>` of the plugin's GLSL reads it, and others do with
     * `//@ from(<id>.<name>)`. Null: it is the module's own. */
    const char* name;
} relevo_texture_info;
/* A rectangle of a texture's level, as it is handed over. */
typedef struct relevo_texels {
    uint32_t size;
    relevo_texture texture;
    int32_t layer, level;
    int32_t x, y;          /* of its first texel; y grows with t */
    int32_t width, height; /* [px] */
    const void* texels;    /* as the format has them, halves as halves; rows without gaps */
    uint64_t bytes;        /* of `texels` */
} relevo_texels;
typedef struct relevo_texture_1 {
    uint32_t size;
    uint32_t reserved;
    void* self;
    /* A new texture of a name takes the place of the old one, which is to be destroyed by its
     * maker. Coordinates beyond it repeat its rim. What it holds is not known before it is drawn
     * or written. */
    relevo_status (*create)(void* self, const relevo_texture_info* info, relevo_texture* texture);
    relevo_status (*destroy)(void* self, relevo_texture texture);
    relevo_status (*write)(void* self, const relevo_texels* texels);
    relevo_status (*make_mipmaps)(void* self, relevo_texture texture);
    /* Level 0 of a layer as floats, as many a texel as the format has, the row at t = 0 first.
     * @param count  of floats that `values` has room for; waits for the device */
    relevo_status (*read)(void* self, relevo_texture texture, int32_t layer, float* values,
                          uint64_t count);
} relevo_texture_1;

/* "relevo.draw", 1: programs of the plugin's own that fill a texture, texel by texel. */
typedef uint32_t relevo_program; /* 0: none */
typedef struct relevo_draw {
    uint32_t size;
    relevo_program program;
    relevo_texture target;
    int32_t layer, level;
    int32_t input_count;
    int32_t value_count;
    uint32_t reserved;
    /* Bound to units 0, 1, ...; null where there are none. One for each sampler of the program, of
     * its kind, and not the target. */
    const relevo_texture* inputs;
    const float* values; /* vec4s of the program's `values`, four floats each; null likewise */
} relevo_draw;
#define RELEVO_MAX_VALUES 16
#define RELEVO_MAX_INPUTS 8
typedef struct relevo_draw_1 {
    uint32_t size;
    uint32_t reserved;
    void* self;
    /* @param file  of the plugin's folder: the fragment side in GLSL 4.50 without `#version`. What
     *              it reads is declared with its unit, `layout(binding = 0) uniform sampler2D t;`.
     *              The host declares `uniform vec4 values[16]` in front of it. */
    relevo_status (*program)(void* self, const char* file, relevo_program* program);
    relevo_status (*destroy_program)(void* self, relevo_program program);
    /* Runs the program for every texel of a layer's level; gl_FragCoord.xy is the texel's middle.
     */
    relevo_status (*draw)(void* self, const relevo_draw* draw);
} relevo_draw_1;

/* "relevo.terrain", 1: the ground as parallel light sees it. All only inside prepare(). */
typedef struct relevo_box {
    uint32_t size;
    uint32_t reserved;
    /* Unit vectors, orthogonal: to the right, up, and towards the light. */
    double right[3], up[3], towards[3];
    /* Least and greatest of a point's products with those three [m]. */
    double low[3], high[3];
} relevo_box;
typedef struct relevo_terrain_1 {
    uint32_t size;
    uint32_t reserved;
    void* self;
    /* The box along the given axes around all ground of the DEM. */
    relevo_status (*bounds)(void* self, relevo_box* box);
    /* The same around the ground that the picture shows nearer to the eye than a distance: a box
     * around whole tiles, so that it holds a little more. RELEVO_NOTHING where there is none. */
    relevo_status (*visible_bounds)(void* self, double nearer_than_m, relevo_box* box);
    /* Draws the ground inside the first two sides of a box, and all of it that lies towards the
     * light or away from it, into a texture of RELEVO_FORMAT_DEPTH32F: 1 is box.high[2], 0 is
     * box.low[2] and is also where there is none. The nearest to the light counts; holes are holes.
     * Effects that displace the ground displace it here.
     * @param tolerance_m  by how much the surface may be wrong
     * @param level        filled with the level of detail that was drawn, 0 being every post; may
     *                     be null */
    relevo_status (*draw_depth)(void* self, const relevo_box* box, double tolerance_m,
                                relevo_texture target, int32_t* level);
} relevo_terrain_1;

/* "relevo.heights", 1: the DEM's heights on the processor. All only inside prepare().
 * Node (i, k) of level n lies on post (i << n, k << n), or on the last post where that is beyond;
 * its height is a weighted mean of the posts around. Level 0 is the posts. */
typedef struct relevo_heights {
    uint32_t size;
    int32_t columns, rows; /* of posts */
    int32_t levels;
} relevo_heights;
typedef struct relevo_nodes {
    uint32_t size;
    int32_t level;
    int32_t column, row; /* of the first node; nodes beyond the rim repeat it */
    int32_t columns, rows;
} relevo_nodes;
typedef struct relevo_heights_1 {
    uint32_t size;
    uint32_t reserved;
    void* self;
    relevo_status (*describe)(void* self, relevo_heights* heights);
    /* Heights of a rectangle of nodes [m], row by row as the DEM's rows run; NaN in holes. May read
     * a file.
     * @param count  of floats that `heights_m` has room for */
    relevo_status (*read)(void* self, const relevo_nodes* nodes, float* heights_m, uint64_t count);
} relevo_heights_1;

/* "relevo.geo", 1: where things lie. All only inside prepare(). Latitudes and longitudes are WGS 84
 * degrees, heights are above the zero of the DEM's and not exaggerated. */
typedef struct relevo_geo_1 {
    uint32_t size;
    uint32_t reserved;
    void* self;
    /* @param lat_lon_height  degrees, degrees, metres */
    relevo_status (*to_local)(void* self, const double lat_lon_height[3], double local_m[3]);
    relevo_status (*from_local)(void* self, const double local_m[3], double lat_lon_height[3]);
    /* Column and row of the DEM, which need not be whole nor on it. RELEVO_NOTHING where the DEM's
     * map has no such place. */
    relevo_status (*to_post)(void* self, const double lat_lon[2], double column_row[2]);
    relevo_status (*from_post)(void* self, const double column_row[2], double lat_lon[2]);
} relevo_geo_1;

/* "relevo.marks", 1, since 2.1: names and symbols at places, which the host draws over the picture.
 * The lists are those of plugin.json's "marks" that have no "from"; their looks are there. */
#define RELEVO_ON_GROUND 0    /* height_m is not read */
#define RELEVO_ABOVE_GROUND 1 /* height_m is above the ground */
#define RELEVO_ABOVE_ZERO 2   /* height_m is above the zero of the DEM's heights */
#define RELEVO_ON_KNOWN_GROUND                                                             \
    3                           /* on the ground, whose height the module knows: height_m; \
                                   hidden also just behind a crest */
#define RELEVO_SYMBOL_OF_LIST 0 /* the "symbol" in plugin.json */
#define RELEVO_SYMBOL_NONE 1
#define RELEVO_SYMBOL_DOT 2
#define RELEVO_SYMBOL_TRIANGLE 3
#define RELEVO_UPRIGHT 0
#define RELEVO_ALONG_AZIMUTH 1
#define RELEVO_MAX_MARKS 1000000u  /* of a list */
#define RELEVO_MAX_MARK_TEXT 1024u /* of a mark [bytes] */
typedef struct relevo_mark {
    uint32_t size;
    int32_t height_of;       /* RELEVO_ON_GROUND, ... */
    double lat_deg, lon_deg; /* WGS 84 */
    double height_m;         /* not exaggerated */
    double rank;             /* marks of a lower rank have room first; 1 where all are equal */
    int32_t symbol;          /* RELEVO_SYMBOL_... */
    /* RELEVO_ALONG_AZIMUTH: the text is centred on the place, without a symbol and a leader, and
     * runs along azimuth_deg or against it, so that it is never upside down. */
    int32_t direction;
    double azimuth_deg; /* clockwise from north, on level ground; not read for RELEVO_UPRIGHT */
    const char* text;   /* may be empty, for a symbol alone */
} relevo_mark;
typedef struct relevo_marks_1 {
    uint32_t size;
    uint32_t reserved;
    void* self;
    /* Sets all marks of a list, which replace those before. They are copied. Inside prepare() they
     * are those of that frame and of later ones.
     * @param list   its name in plugin.json, "buoys"
     * @param marks  one after the other, each of the size in its `size`; may be null if there are
     *               none */
    relevo_status (*set)(void* self, const char* list, const relevo_mark* marks, uint64_t count);
} relevo_marks_1;

#ifdef __cplusplus
}
#endif

#endif
