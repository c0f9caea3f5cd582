#define BONEMILL_CPU_LEVEL_NAMESPACE baseline
#include "haptic_server/kernels/kernel_loops.h"
