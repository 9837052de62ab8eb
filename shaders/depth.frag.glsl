//! provides  nothing: the depth of the terrain in parallel light is all that is wanted

void main() {}
