#include "common/dds/wait_set.h"

#include <dds/dds.h>

namespace bonemill::dds {

WaitSet::WaitSet(const Participant& participant)
    : set_(requireEntity(dds_create_waitset(participant.handle()), "DDS wait set")) {}

void WaitSet::add(int32_t reader) {
    Entity condition = requireEntity(dds_create_readcondition(reader, DDS_ANY_STATE), "DDS read condition");
    dds_waitset_attach(set_.handle(), condition.handle(), condition.handle());
    conditions_.push_back(std::move(condition));
}

bool WaitSet::wait(std::chrono::nanoseconds timeout) const {
    return dds_waitset_wait(set_.handle(), nullptr, 0, timeout.count()) > 0;
}

}  // namespace bonemill::dds
