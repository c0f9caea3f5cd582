#include "device_daemon/ares/ares_device/wired_ares.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr double kSameShare = 1e-3;

// What the controller describes and the scene says, too.
struct SharedFigure {
    const char* name;
    const char* field;  // of the scene
    double per_unit;    // of the field
    double described;   // SI
    double wanted;

    bool isSame() const noexcept { return std::abs(described - wanted) <= kSameShare * std::abs(wanted); }
};

std::array<SharedFigure, 5> sharedFigures(const wire::Describe& said,
                                          const AresDeviceConfig& scene) noexcept {
    return {{{"stroke", "stroke_mm", kPerMillimetre, said.stroke, scene.geometry.stroke},
             {"encoder step", "encoder_step_um", kPerMicrometre, said.encoder_step, scene.guard.encoder_step},
             {"largest actuator force", "max_actuator_force_n", 1, said.max_actuator_force,
              scene.max_actuator_force},
             {"largest force", "max_force_n", 1, said.max_force, scene.max_force},
             {"largest torque", "max_torque_nmm", kPerMilli, said.max_torque, scene.max_torque}}};
}

}  // namespace

WiredAres::WiredAres(const AresDeviceConfig& config, UdpDeviceConfig wire)
    : config_(config), controller_(wire.controller), joints_(std::move(wire)), ares_(joints_, config) {}

DeviceCapabilities WiredAres::capabilities() const noexcept {
    DeviceCapabilities device = ares_.capabilities();
    if (const wire::Describe* said = joints_.description())
        device.abilities |= said->abilities & kAbilityEnablingSwitch;
    return device;
}

bool WiredAres::read(double elapsed, DeviceReading& reading) noexcept {
    const bool is_believed = ares_.read(elapsed, reading);
    checkDescription();
    if (!is_refused_.load(std::memory_order_relaxed)) return is_believed;
    reading.fault = StopCause::kDeviceFault;
    reading.fault_code = kAresIsAnother;
    return false;
}

void WiredAres::write(const DeviceOrder& order) noexcept {
    ares_.write(is_refused_.load(std::memory_order_relaxed) ? DeviceOrder{} : order);
}

void WiredAres::checkDescription() noexcept {
    if (joints_.descriptionCount() == checked_description_) return;
    checked_description_ = joints_.descriptionCount();
    const auto figures = sharedFigures(*joints_.description(), config_);
    const bool is_ours =
        std::all_of(figures.begin(), figures.end(), [](const SharedFigure& f) { return f.isSame(); });
    if (is_ours || is_refused_.load(std::memory_order_relaxed)) return;
    refused_ = *joints_.description();
    is_refused_.store(true, std::memory_order_release);
}

std::string WiredAres::refusal() const {
    if (!is_refused_.load(std::memory_order_acquire)) return {};
    std::ostringstream text;
    text << "the controller at " << wire::textOf(controller_) << " has not the ARES of the scene:";
    for (const SharedFigure& figure : sharedFigures(refused_, config_)) {
        if (figure.isSame()) continue;
        text << " its " << figure.name << " is " << figure.described * figure.per_unit << ", field `device."
             << figure.field << "` says " << figure.wanted * figure.per_unit << ';';
    }
    text << " correct what is wrong, in the scene or in the controller";
    return text.str();
}

}  // namespace bonemill
