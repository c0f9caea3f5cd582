// SIGINT and SIGTERM as a question that the render loop asks.
#pragma once

namespace bonemill {

// From now on the signals only make stopRequested() true. Once, from main().
void catchStopSignals();
bool stopRequested() noexcept;

}  // namespace bonemill
