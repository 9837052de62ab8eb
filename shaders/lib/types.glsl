//! provides  VertexFrame, Surface, Pixel, Texel, Voxel, Invocation, InstanceSite, Instance: what hooks and passes get. Append-only: plugins rely on every member.
//!
//! What tells the ground's kind is the DEM's own, whatever --exaggerate: height_m, height_unit,
//! ground_m, ground_normal and the steps of these. What light needs is of the ground as it is drawn:
//! position_m, distance_m, drawn_height_m, geometric_normal, normal, tangent, bitangent.

/// A vertex of the terrain, before and while plugins displace it.
struct VertexFrame {
    vec3 position_m;    // relative to the eye, x east, y north, z up [m]
    vec3 ground_m;      // coordinates for ground textures: east, north, height [m]
    float height_m;     // orthometric, as in the file [m]
    float height_unit;  // 0 at the DEM's lowest post, 1 at its highest
    vec3 up;            // normal of the ellipsoid, unit
    float distance_m;   // from the eye [m]; in `vertex` of the displaced position
    float drawn_height_m;  // above the DEM's zero, exaggerated; in `vertex` also displaced [m]
    vec2 post;             // column and row of the DEM
    vec2 anchored_m;       // ground_m.xy from a point near the eye, exact there: for lib/repeats.glsl [m]
};

/// A visible point of the terrain.
struct Surface {
    vec3 position_m;          // relative to the eye, x east, y north, z up [m]
    vec3 ground_m;            // coordinates for ground textures: east, north, height [m]
    float height_m;           // orthometric, as in the file [m]
    float height_unit;        // 0 at the DEM's lowest post, 1 at its highest
    vec3 up;                  // normal of the ellipsoid, unit
    vec3 geometric_normal;    // of the DEM's surface as drawn, exaggerated, not displaced; unit
    vec3 tangent, bitangent;  // of the ground textures, unit, orthogonal to geometric_normal
    vec3 normal;              // that light sees; hooks of `normal` perturb it, unit
    ivec2 material;           // at most two materials ...
    vec2 material_weight;     // ... and their weights, sum 1
    vec3 diffuse;             // reflectance for direct light, 0..1, linear sRGB
    vec3 specular;            // reflectance of highlights, 0..1
    vec3 ambient;             // reflectance for the light of the sky, 0..1
    vec3 emissive;            // radiance of its own
    float shininess;          // exponent of the highlight
    float distance_m;         // from the eye [m]
    vec3 ground_dx_m;         // how ground_m changes from this pixel to the next one right ...
    vec3 ground_dy_m;         // ... and up [m/px], no longer at a slant than filters resolve: for textureGrad
    vec2 texture_at;          // coordinates that the materials' textures are read at, but for whole numbers ...
    vec2 texture_dx;          // ... and their gradients, right
    vec2 texture_dy;          // ... and up
    float gloss;              // of the materials, 0..1: how much of their highlight this point has
    vec3 ground_normal;       // of the DEM's surface, not exaggerated: true slope and aspect, unit
    float height_dx_m;        // how height_m changes from this pixel to the next one right ...
    float height_dy_m;        // ... and up [m/px], on the drawn surface
    vec2 post;                // column and row of the DEM, with fractions
    float pixel_posts;        // posts along a side of the pixel on the ground
    vec2 anchored_m;          // ground_m.xy from a point near the eye, exact there: for lib/repeats.glsl [m]
    float above_ground_m;     // of a cut side: above the DEM's ground, in water that effects have raised it by; else 0 or below
    float dem_height_m;       // of the DEM's posts, also where coarser ground is drawn; with dem_step_m for contours [m]
    float dem_step_m;         // how dem_height_m changes from a pixel to the next one uphill [m/px]; 0 on level ground
    float forest;             // share of the ground that is wooded, 0..1, where the provider of `materials` knows; else below 0
};

/// A pixel of the picture, whatever it shows.
struct Pixel {
    vec2 at_px;        // its centre, from the picture's lower left corner, right and up [px]
    vec2 at;           // the same as shares of the picture's width and height, 0..1
    vec3 direction;    // of its ray in the local frame, unit
    float distance_m;  // from the eye to the ground or a wall; 1e9 in the sky [m]
    vec2 in_picture;   // as `at`, of the whole picture; differs where `at` is of a tile of a large picture, 0..1
};

/// A candidate site of an instance on the ground.
struct InstanceSite {
    VertexFrame ground;  // below its foot, as drawn
    vec3 normal;         // of the drawn ground there, not exaggerated, unit
    vec4 random;         // of this site, the same from every eye, 0..1
};

/// An instance as the function of its plugin places it. At first it is not there: height_m is 0.
struct Instance {
    float density;   // share of sites like this one that have an instance, 0..1
    float height_m;  // of the mesh above its foot, at most `height_m` of plugin.json
    float width_m;   // of the mesh along its longer horizontal side
    float turn;      // about the vertical, counter-clockwise as seen from above [rad]
    vec3 colour;     // mean reflectance, linear; meshes vary it
    int kind;        // which of the meshes, from 0
    float taper;     // of its sprite and its shadow: 0 an ellipse, 1 a cone
    float sun;       // share of the sun's light that passes the instances whose shadows are not drawn, 0..1; at first 1
    float ragged;    // how far its surface and the edge of its sprite are broken into clumps, as of leaves, 0..1
};

/// A texel of a plugin's pass.
struct Texel {
    vec2 at_px;    // its centre, from the texture's lower left corner, right and up [texels]
    vec2 at;       // the same as shares of the texture's width and height, 0..1
    vec2 size_px;  // of the texture [texels]
};

/// A texel of a 3-D texture that a pass of a plugin computes.
struct Voxel {
    vec3 at_px;    // its centre, from the corner of texel (0, 0, 0) [texels]
    vec3 at;       // the same as shares of the texture's width, height and depth, 0..1
    vec3 size_px;  // of the texture [texels]
};

/// An invocation of a compute pass. Work groups are whole: some invocations are beyond `size`.
struct Invocation {
    ivec3 at;    // its number along each axis, from 0; of a texture its texel, of a buffer in x its element
    ivec3 size;  // how many are wanted along each axis
};
