// Has what another thread works on come? Pure; any thread may call it.
#pragma once

#include <chrono>
#include <future>

namespace bonemill {

// Takes std::future or std::shared_future.
template <class Future>
bool isReady(const Future& future) {
    return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace bonemill
