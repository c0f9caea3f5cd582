// Cyclone's own messages go to the program's log, but not more of them than are read.
#pragma once

namespace bonemill::dds {

// From now on ten messages are logged at once, and over a long time one a minute. It may be called again.
void limitCycloneLog();

}  // namespace bonemill::dds
