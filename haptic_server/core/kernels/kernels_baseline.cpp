#define BONEMILL_CPU_LEVEL_NAMESPACE baseline
#include "haptic_server/core/kernels/kernel_loops.h"
