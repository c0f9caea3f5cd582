#define BONEMILL_CPU_LEVEL_NAMESPACE avx512
#include "haptic_server/core/kernels/kernel_loops.h"
