//! provides  parameters of the marks in plugin.json; core draws them

uniform float labels_size_px = 13.0; //@ range(4, 200) unit(px) label("Letters")
uniform vec3 labels_colour = vec3(0.08, 0.09, 0.10); //@ colour(srgb) label("Colour")
uniform vec3 labels_halo = vec3(1.0, 1.0, 1.0); //@ colour(srgb) label("Halo")
uniform int labels_symbol = 2; //@ enum(none, dot, triangle) label("Symbol")
uniform float labels_leader_px = 24.0; //@ range(0, 1000) unit(px) label("Leader") description("Least length of the line up to the name; 0: the name is next to the symbol")
uniform float labels_above_m = 0.0; //@ range(0, 10000) unit(m) label("Above the ground")
uniform float labels_distance_px = 4.0; //@ range(0, 1000) unit(px) label("Distance") description("Least distance between the names of two places")
uniform int labels_order = 0; //@ enum(rank, nearest, highest) label("First") description("Which places are drawn where room is short")
uniform int labels_most = 100; //@ range(0, 2000) label("Most")
