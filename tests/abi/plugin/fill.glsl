out vec4 colour;
void main() { colour = values[0]; }
