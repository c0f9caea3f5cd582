// Makes contacts by hand, as an effect sees them.
#pragma once

#include <random>
#include <vector>

#include "haptic_server/core/effects/burr_speed.h"
#include "haptic_server/core/effects/effect_host.h"
#include "tests/support/random_direction.h"

namespace bonemill::test {

struct ContactSet {
    // The contact is on the burr or the shaft, at r_V from the tool point; the bone pushes along push_V.
    void add(const Eigen::Vector3d& r_V, const Eigen::Vector3d& push_V, double force, double area = 0,
             bool is_on_burr = true) {
        contacts.push_back(
            {r_V.cast<float>(), push_V.cast<float>(), 1e-5f, float(force), uint32_t(contacts.size())});
        on_burr.push_back(is_on_burr);
        areas.push_back(float(area));
    }
    // The contacts are anywhere on a ball.
    void addOnBall(std::mt19937& random, double radius, int count) {
        std::uniform_real_distribution<double> uniform(0.1, 1);
        for (int n = 0; n < count; ++n) {
            const Eigen::Vector3d out = randomDirection(random);
            add(radius * out, -out, uniform(random), 1e-9 * uniform(random));
        }
    }
    // The tick starts with these as the last one's contacts.
    void giveTo(EffectTick& tick) {
        const Eigen::Vector3d axis = tick.X_VT.rotation * Eigen::Vector3d::UnitY();
        rubbing_radii.clear();
        for (size_t n = 0; n < contacts.size(); ++n)
            rubbing_radii.push_back(rubbingRadius(contacts[n].r_V.cast<double>(), axis, double(areas[n])));
        tick.contacts = contacts;
        tick.is_on_burr = on_burr;
        tick.rubbing_radius = rubbing_radii;
        tick.place_area = areas;
        tick.burr_load = burrLoadOf(tick);
    }

    std::vector<SurfaceContact> contacts;
    std::vector<uint8_t> on_burr;
    std::vector<double> rubbing_radii;
    std::vector<float> areas;
};

// An effect that asks for nothing but its config, as a scene makes it.
template <class Config>
std::unique_ptr<HapticEffect> effectOf(const Config& config) {
    static const BoneModel no_bone(VoxelVolume({Eigen::Vector3i::Ones(), Eigen::Vector3d::Ones(), {}}, 1),
                                   Eigen::Vector3i::Ones(), {.spare_points = 0});
    return config.make({{}, no_bone, {}});
}

// This is a tick of a spinning ball burr of 1 mm radius, with friction 0.5 at 40,000 rpm.
struct BurrTick {
    BurrTick() {
        tool.burr.friction = 0.5;
        tool.burr.speed = 40'000 * 2 * M_PI / 60;
        tick.tool = &tool;
        tick.is_pedal_down = true;
        tick.spin_speed = tool.burr.speed;
    }
    BurrTick(const BurrTick&) = delete;
    BurrTick& operator=(const BurrTick&) = delete;

    SpoTool tool{nullptr, {}, 10};
    EffectTick tick;
};

}  // namespace bonemill::test
