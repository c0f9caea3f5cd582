// Quality of service is built step by step: Qos().reliable(...).transientLocal().keepLast(1). It is not
// for the tick.
#pragma once

#include <chrono>
#include <memory>
#include <string>

struct dds_qos;

namespace bonemill::dds {

class Qos {
  public:
    Qos();

    // A writer waits at most `max_blocking` for slow readers; only keepAll() writers ever wait.
    Qos& reliable(std::chrono::milliseconds max_blocking);
    Qos& bestEffort();
    // Late joiners get the newest sample of every key, and only that.
    Qos& transientLocal();
    Qos& keepLast(int depth);
    // A reader holds at most `max_samples`; beyond them the writer waits.
    Qos& keepAll(int max_samples);
    // A reader knows at most N keys whose writers live, and drops samples of others. For best effort
    // only: a reliable writer's sample would be tried again without end, and hold up all other readers.
    Qos& atMostKeys(int max_keys);
    // A writer that leaves disposes nothing: clients keep what they have.
    Qos& disposeOnRequestOnly();
    Qos& property(const std::string& name, const std::string& value);

    const dds_qos* get() const noexcept { return qos_.get(); }

  private:
    struct Deleter {
        void operator()(dds_qos* qos) const noexcept;
    };
    std::unique_ptr<dds_qos, Deleter> qos_;
};

}  // namespace bonemill::dds
