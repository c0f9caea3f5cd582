// Turns SIGINT and SIGTERM into a question that the render loop asks.
#pragma once

namespace bonemill {

// From now on the signals only make stopRequested() true. It is called once, from main().
void catchStopSignals();
bool stopRequested() noexcept;

}  // namespace bonemill
