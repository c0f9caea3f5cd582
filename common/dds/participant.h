// This is a program's membership in one DDS domain. It is not for the tick.
//
// common/dds/network.h chooses the network. Endpoints that do not match because of their QoS or
// type are logged.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/dds/entity.h"
#include "common/security/security_folder.h"

namespace bonemill::dds {

// Ports of higher domain ids do not fit in 16 bits.
inline constexpr uint32_t kMaxDomain = 230;

class Domain;

class Participant {
  public:
    // Throws UserError when the domain cannot be joined, or when security was asked for and is not in force.
    explicit Participant(uint32_t domain);
    Participant(Participant&&) noexcept;

    ~Participant();

    // It holds for domains joined from now on; see setNetwork().
    static void setConfiguration(std::string configuration);

    // Participants made from now on prove who they are, with this folder; without one they prove nothing.
    static void setSecurity(std::optional<SecurityFolder> security);

    int32_t handle() const noexcept { return entity_.handle(); }

  private:
    std::shared_ptr<Domain> domain_;  // outlives entity_
    Entity entity_;
};

}  // namespace bonemill::dds
