// The interposed heap and lock functions call these before they do their work. The program that links them
// (bonemill::rt_interpose) defines both; they may not allocate or lock.
#pragma once

namespace bonemill::rt_guard {

void onHeapCall(const char* function) noexcept;
void onLockCall(const char* function) noexcept;

}  // namespace bonemill::rt_guard
