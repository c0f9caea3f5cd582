// BONEMILL_ASSERT(condition) says what a caller has to make sure of. A broken one ends the program with its
// file and line; it is a mistake in our code, never in a file or a message, which are checked and answered
// with an error. It is on in the presets dev, asan and tsan, as Eigen's own assertions; in release it costs
// nothing and its condition is not evaluated. Real-time code may use it: it takes no lock and no memory as
// long as it holds.
#pragma once

#include <cassert>

#ifdef NDEBUG
#define BONEMILL_ASSERT(condition) static_cast<void>(sizeof(!(condition)))
#else
#define BONEMILL_ASSERT(condition) assert(condition)
#endif
