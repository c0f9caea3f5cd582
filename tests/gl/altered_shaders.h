// This is an OpenGL whose shaders are altered on their way to the compiler, to prove that a test sees what
// is missing.
#pragma once

#include <string>
#include <vector>

#include "render_client/look/gl/gl_api.h"

namespace bonemill::test {

struct Alteration {
    std::string what;  // found in the shaders' text
    std::string by;
};

// Returns `gl` with shaders that have every alteration done. It counts for one thread, until the next call.
GlApi alterShaders(const GlApi& gl, std::vector<Alteration> alterations);

// Returns `gl` that gives no more than one sample per pixel.
GlApi withoutAntialiasing(const GlApi& gl);

// Counts how often one was done since.
int alterationsDone();

}  // namespace bonemill::test
