// One contact point from the densities of one block of cells. RT-safe.
#pragma once

#include "haptic_server/contact/point_shell.h"

namespace bonemill {

// `cells` is a non-empty block crossed by the iso-surface. Position and normal in V; key is left to the
// caller.
ShellPoint makeShellPoint(const VoxelVolume& volume, const IndexBox& cells) noexcept;

}  // namespace bonemill
