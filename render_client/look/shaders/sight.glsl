uniform vec2 tangents;  // of the half field of view, x and y
uniform float shift;    // x / depth of the picture's middle

// Returns where the line of sight through a place of the picture (0 to 1, right and up) is at a depth of 1; C.
vec3 sightThrough(vec2 place) { return vec3((place * 2.0 - 1.0) * tangents + vec2(shift, 0.0), -1.0); }
