//! provides  nothing: the depth of the terrain in an orthographic view is all that is wanted

void main() {}
