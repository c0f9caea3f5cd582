#include "common/dds/wait_set.h"

#include <dds/dds.h>

#include <utility>

namespace bonemill::dds {

WaitSet::WaitSet(const Participant& participant)
    : set_(requireEntity(dds_create_waitset(participant.handle()), "DDS wait set")) {}

void WaitSet::add(std::function<int32_t()> handle) {
    watched_.push_back({std::move(handle), 0, Entity()});
    watch(watched_.back());
}

// The condition of a reader that is gone went with it.
void WaitSet::watch(Watched& watched) {
    const int32_t reader = watched.handle();
    if (reader == watched.reader) return;
    watched.reader = reader;
    watched.condition = Entity();
    if (reader == 0) return;
    watched.condition = requireEntity(dds_create_readcondition(reader, DDS_ANY_STATE), "DDS read condition");
    dds_waitset_attach(set_.handle(), watched.condition.handle(), watched.condition.handle());
}

bool WaitSet::wait(std::chrono::nanoseconds timeout) {
    for (Watched& watched : watched_) watch(watched);
    return dds_waitset_wait(set_.handle(), nullptr, 0, timeout.count()) > 0;
}

}  // namespace bonemill::dds
