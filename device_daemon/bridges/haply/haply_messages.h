// The messages of Haply's Inverse Service, as its public documentation describes them: JSON over a WebSocket,
// one state for each message that is sent. A state may leave out what has not changed.
//
// The service's axes are x to the right, y forward, z up. Nothing throws; it allocates.
#pragma once

#include <optional>
#include <string>

#include "common/geometry/pose.h"

namespace bonemill::bridge {

struct HaplyState {
    std::string device_id;               // of the arm that was chosen; empty: none is known yet
    std::string type;                    // "inverse3", "minverse"
    bool is_there = false;               // the last message that lists arms has it
    std::optional<Eigen::Vector3d> p_V;  // m
    std::optional<Eigen::Vector3d> v_V;  // m/s
    bool is_calibrated = false;
    bool has_power = false;
    bool is_ready = false;
    std::string grip_id;    // of a VerseGrip; empty: none
    std::string grip_kind;  // "verse_grip" or "wireless_verse_grip"
    std::optional<Eigen::Quaterniond> R_V;
    bool button_a = false, button_b = false;
};

// Takes over what a message says; what it does not say stays. `wanted` is the id of the arm that is meant, or
// empty for the first. False says that the message makes no sense, and changes nothing.
bool takeMessage(const std::string& message, const std::string& wanted, HaplyState& state);

struct HaplyDialect {
    bool has_session = true;            // services from 3.5 on want to know who speaks
    const char* force_name = "vector";  // older ones say "values"
};
// Of "3.5" or "3.4.1"; nothing if it is no version.
std::optional<HaplyDialect> dialectOf(const std::string& service_version);

// Asks for the state without giving any force; `is_first` says who speaks.
std::string probeMessage(const HaplyState& state, const HaplyDialect& dialect, bool is_first);
// Commands a force (N), zero included, with which the service balances the arm's weight.
std::string forceMessage(const HaplyState& state, const HaplyDialect& dialect, const Eigen::Vector3d& f_V);

}  // namespace bonemill::bridge
