// Sanitizers map terabytes themselves, and ask the kernel for things of their own.
#pragma once

namespace bonemill {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif

}  // namespace bonemill
