#define BONEMILL_CPU_LEVEL_NAMESPACE avx512
#include "haptic_server/kernels/kernel_loops.h"
