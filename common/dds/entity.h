// Owns one Cyclone DDS entity. It is not for the tick.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace bonemill::dds {

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

}  // namespace bonemill::dds
