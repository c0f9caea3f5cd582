// A stand-in for libHD.so of 3D Systems, written from the calls' published names and types: its own thread
// calls back about 1000 times a second and moves the stylus up and down, with whatever trouble STAND_IN asks
// for.
#include <pthread.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <thread>
#include <vector>

#include "tests/integration/bridge/stand_in.h"

using stand_in::record;
using stand_in::told;

namespace {

struct ErrorInfo {
    unsigned code;
    int internal;
    unsigned device;
};

std::atomic<int> ticks{0};
std::atomic<bool> is_running{false};
std::thread servo;
unsigned (*callback)(void*) = nullptr;
void* callback_data = nullptr;
bool is_enabled = false;
bool is_in_frame = false;
std::mutex errors_mutex;  // the caller's thread pops them, the servo thread pushes them
std::vector<unsigned> errors;
double written_force[3] = {};

void pushError(unsigned code) {
    const std::lock_guard lock(errors_mutex);
    errors.push_back(code);
}

// "loses_at": from then on, the arm's cable is out.
void pushErrors() {
    if (stand_in::reached("loses_at", ticks))
        for (const unsigned code : {0x0302u, 0x0300u, 0x0204u}) pushError(code);
    if (told("warm_at", -1) == ticks) pushError(0x0200);
}

void pace() {
    usleep(800);
    if (told("jitter")) usleep(useconds_t(ticks * 7919 % 700));
    if (told("stalls") && ticks % 200 == 199) usleep(60'000);
}

void serve() {
    while (is_running) {
        pace();
        ++ticks;
        stand_in::endAt(ticks);
        pushErrors();
        if (callback) callback(callback_data);
    }
}

bool isCalibrated() {
    return !stand_in::told("calibrates_at") || ticks >= told("calibrates_at");
}

}  // namespace

extern "C" {

unsigned hdInitDevice(const char* name) {
    const bool is_refused =
        told("no_device") || (told("only_named") && (!name || std::strcmp(name, "Default PHANToM")));
    record("init\n");
    if (is_refused) {
        pushError(0x0300);
        pushError(0x0303);
        return 0xffffffffu;
    }
    stand_in::takeOverProcess();
    return 0;
}

void hdDisableDevice(unsigned) {
    record("close\n");
}

void hdMakeCurrentDevice(unsigned) {}

void hdBeginFrame(unsigned) {
    if (is_in_frame) pushError(0x0400);
    is_in_frame = true;
}

void hdEndFrame(unsigned) {
    stand_in::trouble();
    is_in_frame = false;
    record("force %.9g %.9g %.9g 0 0 0\n", written_force[0], written_force[1], written_force[2]);
}

void hdEnable(unsigned what) {
    if (what == 0x4000) record("enable 1\n");
    is_enabled |= what == 0x4000;
}

void hdDisable(unsigned what) {
    if (what == 0x4000 && is_enabled) record("enable 0\n");
    if (what == 0x4000) is_enabled = false;
}

void hdGetIntegerv(unsigned what, int* value) {
    *value = what == 0x2000 ? 2 : what == 0x2553 ? 6 : 1;
}

void hdGetDoublev(unsigned what, double* value) {
    const double usable_mm[6] = {-80, -60, -35, 80, 100, 35};
    switch (what) {
        case 0x2551:
            std::memcpy(value, usable_mm, sizeof(usable_mm));
            return;
        case 0x2603:
            *value = told("no_limit") ? std::numeric_limits<double>::quiet_NaN() : 3.3;
            return;
        case 0x2605:
            value[0] = value[1] = value[2] = 0.25;
            return;
        case 0x2052: {
            const bool moves = isCalibrated();
            const double skew = told("skewed") ? 1.003 : 1;
            const double frame[16] = {skew,
                                      0.001 * (skew - 1),
                                      0,
                                      0,
                                      0,
                                      1,
                                      0,
                                      0,
                                      0,
                                      0,
                                      1,
                                      0,
                                      10,
                                      20,
                                      moves ? 30 + 5 * std::sin(ticks * 0.01) : 30,
                                      1};
            std::memcpy(value, frame, sizeof(frame));
            if (stand_in::reached("nan_at", ticks)) value[12] = std::numeric_limits<double>::quiet_NaN();
            return;
        }
    }
}

void hdSetDoublev(unsigned what, const double* value) {
    if (what == 0x2700)
        std::memcpy(written_force, value, sizeof(written_force));
    else
        record("torque_written\n");
}

const char* hdGetString(unsigned what) {
    return what == 0x2501 ? "Touch" : what == 0x2504 ? "815" : "2023.11.15";
}

ErrorInfo hdGetError() {
    if (told("errors_never_end")) return {0x0302, 0, 0};
    const std::lock_guard lock(errors_mutex);
    if (errors.empty()) return {0, 0, 0};
    const unsigned code = errors.back();
    errors.pop_back();
    return {code, 0, 0};
}

const char* hdGetErrorString(unsigned) {
    return "stand-in error";
}

unsigned hdCheckCalibration() {
    return isCalibrated() ? 0x5000 : told("by_hand") ? 0x5002 : 0x5001;
}

void hdUpdateCalibration(unsigned style) {
    record("calibrate %u\n", style);
}

void hdStartScheduler() {
    record("start\n");
    is_running = true;
    servo = std::thread(serve);
}

void hdStopScheduler() {
    record("stop\n");
    is_running = false;
    if (told("stop_hangs")) stand_in::blockForEver();
    servo.join();
}

unsigned long hdScheduleAsynchronous(unsigned (*function)(void*), void* data, unsigned short) {
    callback = function;
    callback_data = data;
    return 7;
}

void hdUnschedule(unsigned long) {
    record("unschedule\n");
    callback = nullptr;
}

}  // extern "C"

namespace {

// The driver is never to be unloaded: it fails when it is loaded again.
struct Unloading {
    ~Unloading() { record("unloaded\n"); }
} unloading;

}  // namespace
