#include "tests/support/rt_guard/rt_probe.h"

#include "common/rt/rt_interpose.h"

namespace bonemill {
namespace {

constinit thread_local RtProbe* probe_of_thread = nullptr;

}  // namespace

RtProbe::RtProbe() noexcept {
    probe_of_thread = this;
}

void RtProbe::stop() noexcept {
    if (probe_of_thread == this) probe_of_thread = nullptr;
}

void RtProbe::countHeapCall(const char* function) noexcept {
    noteFirst(function);
    ++heap_calls_;
}

void RtProbe::countLockCall(const char* function) noexcept {
    noteFirst(function);
    ++lock_calls_;
}

void RtProbe::noteFirst(const char* function) noexcept {
    if (heap_calls_ + lock_calls_ == 0) first_call_ = function;
}

namespace rt_guard {

void onHeapCall(const char* function) noexcept {
    if (probe_of_thread) probe_of_thread->countHeapCall(function);
}

void onLockCall(const char* function) noexcept {
    if (probe_of_thread) probe_of_thread->countLockCall(function);
}

}  // namespace rt_guard
}  // namespace bonemill
