#version 450 core
//! computes  the height of the sun's shadow over every post of a DEM: each invocation follows one line of a sweep,
//!           row by row away from the sun, and finds the shadows at the posts that belong to it
//! figures   those of core/light/sweep/shadow_strip.cpp and kernels.cpp, operation by operation. `precise` keeps the
//!           compiler from fusing a product and a sum, so that both round alike
//! tables    core/light/sweep/shadow_tables.h; core/render/device_shadows.cpp uploads them

layout(local_size_x = 64) in;

const float kNothing = -1e30;  // height of holes, and of what has met no ground: kNothing_m
const float kNoGround = -1e20;
const float kFallOrigins = 2048.0;  // ShadowStrip::kFallOrigins_m
const int kNearRows = 4;            // ShadowStrip::kSampling
const int kInRow = 1, kInColumn = 2;

struct Tile {
    int first_row, rows, first_line, end_line, first_crossing;
    int columns;                                    // of the sheet; its rows are counted from its first row on
    int is_transposed, first_index, index_step;     // Orientation, of the first row
    int heights_pitch, found_pitch, found_column;   // of the grid's rows; the column that is found first
    float height_origin_m, floor_m;
    int mixes;                                      // Clearances::DeviceSweep
    float mix_lowest_m, mix_per_m;
    int earth_edges, earth_edge_count, earth_rows, earth_bases, earth_column;  // places in earth[]; rows < 0: none
    float earth_per_post, earth_curvature, earth_lowest_m;
};

struct Row {
    float fall, fall_per_line, post_offset;
    int fall_origin, column;
    int lines_begin, lines_end, posts_begin, posts_end, far_begin, far_end;
    int before_0, behind_0, before_1, behind_1;  // EdgeLines of each set
    int crossings_0, crossings_1, crossings_posts;
};

struct Crossing {
    int row, column, next;
    float weight;
};

layout(std430, binding = 0) readonly buffer Heights { float heights[]; };  // kNothing in holes
layout(std430, binding = 1) buffer Found { float found[]; };
layout(std430, binding = 2) readonly buffer Tiles { Tile tiles[]; };
layout(std430, binding = 3) readonly buffer Rows { Row rows[]; };
layout(std430, binding = 4) readonly buffer Crossings { Crossing crossings[]; };
layout(std430, binding = 5) readonly buffer Earth { float earth[]; };

/// The column (x) and row (y) of the grid at a post of the sheet.
ivec2 grid_post(in Tile tile, in int row, in int column) {
    int index = tile.first_index + row * tile.index_step;
    return tile.is_transposed != 0 ? ivec2(index, column) : ivec2(column, index);
}

float origin_moved(in Tile tile, in int row) {
    int at = tile.first_row + row;
    return kFallOrigins * float(rows[at].fall_origin - rows[at - 1].fall_origin);
}

/// The ground of a post, as RowTilt has it, as seen from row `now`: lowered by each move of the origin since.
float ground(in Tile tile, in int row, in int column, in int now) {
    if (column < 0 || column >= tile.columns) return kNothing;
    Row at = rows[tile.first_row + row];
    ivec2 post = grid_post(tile, row, column);
    precise float fallen = at.fall + at.fall_per_line * (float(column - at.column) + at.post_offset);
    precise float height = (heights[post.y * tile.heights_pitch + post.x] - tile.height_origin_m) + fallen;
    if (rows[tile.first_row + now].fall_origin == at.fall_origin) return height;
    for (int later = row + 1; later <= now; ++later) {
        precise float moved = height - origin_moved(tile, later);
        height = moved;
    }
    return height;
}

/// Raises a line, or the ray of its post, to the ground at crossings [begin, end).
float raise(in float height, in Tile tile, in int begin, in int end, in int line, in int now) {
    for (int i = tile.first_crossing + begin; i < tile.first_crossing + end; ++i) {
        Crossing at = crossings[i];
        int column = at.column + line;
        float p = ground(tile, at.row, column, now), q = p;
        if (at.next == kInRow) q = ground(tile, at.row, column + 1, now);
        if (at.next == kInColumn) q = ground(tile, at.row + 1, column, now);
        precise float met = p + at.weight * (q - p);
        height = max(height, met);
    }
    return height;
}

/// Raises a line of a set to what it meets at a row and on the way there, and to the ground at the grid's edge.
float raise_line(in float height, in Tile tile, in int set, in int line, in int row, in int now) {
    Row at = rows[tile.first_row + row];
    if (line >= at.lines_begin && line < at.lines_end)
        height = set == 0 ? raise(height, tile, at.crossings_0, at.crossings_1, line, now)
                          : raise(height, tile, at.crossings_1, at.crossings_posts, line, now);
    if (line == (set == 0 ? at.before_0 : at.before_1)) height = max(height, ground(tile, row, 0, now));
    if (line == (set == 0 ? at.behind_0 : at.behind_1))
        height = max(height, ground(tile, row, tile.columns - 1, now));
    return height;
}

/// As look_for_shadows(). @param lines  heights of set 0, of set 1, and of set 0's next line
float shadow(in Tile tile, in int row, in vec3 lines, in int line) {
    Row at = rows[tile.first_row + row];
    int posts_end = rows[tile.first_row + row + 1].crossings_0;
    precise float fallen = at.fall + at.fall_per_line * (float(line) + at.post_offset);
    precise float height = kNothing;
    if (line >= at.far_begin && line < at.far_end) {
        precise float least = (tile.floor_m - tile.height_origin_m) + fallen;
        bool second = at.post_offset >= 0.5;
        float weight = 2.0 * at.post_offset - (second ? 1.0 : 0.0);
        float left = second ? lines.y : lines.x, right = second ? lines.z : lines.y;
        if (weight == 0.0) right = left;
        left = left >= least ? left : kNothing;
        right = right >= least ? right : kNothing;
        height = left + weight * (right - left);
    }
    height = raise(height, tile, at.crossings_posts, posts_end, line, row);
    precise float lowered = (height - fallen) + tile.height_origin_m;
    return height < kNoGround ? tile.floor_m : max(lowered, tile.floor_m);
}

/// As raise_to_earth().
float raise_to_earth(in float shadow_m, in Tile tile, in int row, in int column) {
    int row_at = tile.earth_rows + 2 * row;
    int edge = column - int(earth[row_at + 1]);
    bool has_edge = edge >= 0 && edge < tile.earth_edge_count;
    int edge_at = tile.earth_edges + 2 * (has_edge ? edge : 0);
    precise float edge_m = has_edge ? earth[edge_at] : kNothing;
    precise float edge_at_m = has_edge ? earth[edge_at + 1] - earth[row_at] : kNothing;
    ivec2 post = grid_post(tile, row, column);
    precise float t = earth[tile.earth_bases + post.y] + tile.earth_per_post * float(post.x - tile.earth_column);
    float c = tile.earth_curvature;
    precise float s = max(max(edge_at_m, -t / c), 0.0);
    precise float fallen_m = t * s + c * s * s / 2.0;
    precise float deep_m = t * t / (2.0 * c);
    precise float earth_m = max(edge_m, tile.earth_lowest_m) - (t > 0.0 ? max(deep_m, fallen_m) : fallen_m);
    return max(earth_m, shadow_m);
}

void store(in float shadow_m, in Tile tile, in int row, in int column) {
    if (tile.earth_rows >= 0) shadow_m = raise_to_earth(shadow_m, tile, row, column);
    ivec2 post = grid_post(tile, row, column);
    int at = post.y * tile.found_pitch + post.x - tile.found_column;
    if (tile.mixes != 0) {
        float low_m = found[at], height_m = heights[post.y * tile.heights_pitch + post.x];
        precise float mixed_m = low_m + (height_m - tile.mix_lowest_m) * tile.mix_per_m * (shadow_m - low_m);
        shadow_m = mixed_m;
    }
    found[at] = shadow_m;
}

void main() {
    Tile tile = tiles[gl_WorkGroupID.y];
    int line = tile.first_line + int(gl_GlobalInvocationID.x);
    if (line >= tile.end_line) return;
    vec3 lines = vec3(kNothing);
    for (int row = 0; row < tile.rows; ++row) {
        if (row > 0) {
            precise vec3 lowered = lines - origin_moved(tile, row);
            lines = lowered;
        }
        int far = row - kNearRows - 1;
        if (far >= 0) {
            lines.x = raise_line(lines.x, tile, 0, line, far, row);
            lines.y = raise_line(lines.y, tile, 1, line, far, row);
            lines.z = raise_line(lines.z, tile, 0, line + 1, far, row);
        }
        Row at = rows[tile.first_row + row];
        int column = at.column + line;
        if (column >= at.posts_begin && column < at.posts_end)
            store(shadow(tile, row, lines, line), tile, row, column);
    }
}
