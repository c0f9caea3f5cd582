#include "common/dds/qos.h"

#include <dds/dds.h>

namespace bonemill::dds {

void Qos::Deleter::operator()(dds_qos* qos) const noexcept {
    dds_delete_qos(qos);
}

Qos::Qos() : qos_(dds_create_qos()) {}

Qos& Qos::reliable(std::chrono::milliseconds max_blocking) {
    dds_qset_reliability(qos_.get(), DDS_RELIABILITY_RELIABLE,
                         std::chrono::nanoseconds(max_blocking).count());
    return *this;
}

Qos& Qos::bestEffort() {
    dds_qset_reliability(qos_.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
    return *this;
}

Qos& Qos::transientLocal() {
    dds_qset_durability(qos_.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_durability_service(qos_.get(), 0, DDS_HISTORY_KEEP_LAST, 1, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
    return *this;
}

Qos& Qos::keepLast(int depth) {
    dds_qset_history(qos_.get(), DDS_HISTORY_KEEP_LAST, depth);
    return *this;
}

Qos& Qos::keepAll(int max_samples) {
    dds_qset_history(qos_.get(), DDS_HISTORY_KEEP_ALL, 0);
    dds_qset_resource_limits(qos_.get(), max_samples, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
    return *this;
}

Qos& Qos::atMostKeys(int max_keys) {
    dds_qset_resource_limits(qos_.get(), DDS_LENGTH_UNLIMITED, max_keys, DDS_LENGTH_UNLIMITED);
    return *this;
}

Qos& Qos::property(const std::string& name, const std::string& value) {
    dds_qset_prop(qos_.get(), name.c_str(), value.c_str());
    return *this;
}

Qos& Qos::disposeOnRequestOnly() {
    dds_qset_writer_data_lifecycle(qos_.get(), false);
    return *this;
}

}  // namespace bonemill::dds
