// This is a program's membership in one DDS domain. It is not for the tick.
//
// common/dds/network.h chooses the network. Endpoints that do not match because of their QoS or
// type are logged.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "common/security/security_folder.h"

namespace bonemill::dds {

// Owns one Cyclone DDS entity.
class Entity {
  public:
    Entity() noexcept = default;
    explicit Entity(int32_t handle) noexcept : handle_(handle) {}
    Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
    Entity& operator=(Entity&& other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~Entity();

    int32_t handle() const noexcept { return handle_; }

  private:
    int32_t handle_ = 0;
};

// Makes the entity of a create call's result; throws UserError "cannot create <what>: <reason>"
// when it failed.
Entity requireEntity(int32_t result, const std::string& what);

// Ports of higher domain ids do not fit in 16 bits.
inline constexpr uint32_t kMaxDomain = 230;

class Domain;

class Participant {
  public:
    // Throws UserError when the domain cannot be joined, or when security was asked for and is not in force.
    explicit Participant(uint32_t domain);
    // Joins a domain of others than bonemill, by this configuration of Cyclone and without DDS Security,
    // whatever is set below. It may have the number of a domain of ours: they share nothing.
    static Participant ofForeigners(uint32_t domain, const std::string& configuration);
    Participant(Participant&&) noexcept;

    ~Participant();

    // It holds for domains joined from now on; see setNetwork().
    static void setConfiguration(std::string configuration);

    // Participants made from now on prove who they are, with this folder; without one they prove nothing.
    static void setSecurity(std::optional<SecurityFolder> security);

    int32_t handle() const noexcept { return entity_.handle(); }

  private:
    Participant(std::shared_ptr<Domain> domain, Entity entity) noexcept;

    std::shared_ptr<Domain> domain_;  // outlives entity_
    Entity entity_;
};

}  // namespace bonemill::dds
