//! provides  parameters of the marks in plugin.json; core draws them

uniform float summits_size_px = 13.0; //@ range(4, 200) unit(px) label("Letters")
uniform vec3 summits_colour = vec3(0.08, 0.09, 0.10); //@ colour(srgb) label("Colour")
uniform vec3 summits_halo = vec3(1.0, 1.0, 1.0); //@ colour(srgb) label("Halo")
uniform int summits_symbol = 2; //@ enum(none, dot, triangle) label("Symbol")
uniform float summits_leader_px = 24.0; //@ range(0, 1000) unit(px) label("Leader") description("Least length of the line up to the name; 0: the name is next to the symbol")
uniform float summits_distance_px = 8.0; //@ range(0, 1000) unit(px) label("Distance") description("Least distance between the names of two summits")
uniform int summits_order = 0; //@ enum(rank, nearest, highest) label("First") description("Which summits are drawn where room is short; by rank, the highest of the DEM")
uniform int summits_most = 40; //@ range(0, 2000) label("Most")
