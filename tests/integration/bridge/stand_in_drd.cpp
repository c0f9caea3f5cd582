// A stand-in for libdrd.so.3 of Force Dimension, written from the calls' published names and types: an
// omega.6 at a fixed pose, with whatever trouble STAND_IN asks for. WITHOUT_OPTIONAL and WITHOUT_REQUIRED
// leave functions out.
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/integration/bridge/stand_in.h"

using stand_in::record;
using stand_in::told;

namespace {

std::atomic<int> reads{0};
std::atomic<int> writes{0};
std::atomic<bool> is_force_on{false};

bool isUnplugged() {
    return stand_in::reached("unplugged_at", reads);
}

int answer() {
    stand_in::trouble();
    if (isUnplugged()) return -1;
    return told("returns_1") ? 1 : told("returns_2") ? 2 : 0;
}

bool failsNow() {
    const int from = int(told("fails_from", -1));
    return from >= 0 && reads >= from && reads < from + int(told("fails_for"));
}

}  // namespace

extern "C" {

void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision) {
    *major = int(told("major", 3));
    *minor = 17;
    *release = 5;
    *revision = 0;
}

int dhdGetDeviceCount() {
    return told("no_device") ? 0 : 1;
}

int dhdOpenID(char id) {
    if (told("open_hangs")) stand_in::blockForEver();
    if (told("open_fails")) return -1;
    stand_in::takeOverProcess();
    record("open %d\n", id);
    return id;
}

int dhdClose(char) {
    record("close\n");
    return 0;
}

int dhdGetSystemType(char) {
    return int(told("type", 34));
}

int dhdGetStatus(int* status, char) {
    const int length = int(told("status_length", 17));
    std::memset(status, 0, size_t(length) * sizeof(int));
    status[0] = status[1] = 1;
    status[3] = told("uncalibrated") != 0;
    if (stand_in::reached("velocity_at", reads)) is_force_on = false;
    status[5] = is_force_on;
    if (length > 14 && !is_force_on) status[14] = 2;
    return answer();
}

int dhdGetPosition(double* x, double* y, double* z, char) {
    *x = told("nan_at", -1) >= 0 && stand_in::reached("nan_at", reads)
             ? std::numeric_limits<double>::quiet_NaN()
             : 0.01;
    *y = 0.02;
    *z = 0.03;
    ++reads;
    stand_in::endAt(reads);
    return failsNow() ? -1 : answer();
}

#ifndef WITHOUT_REQUIRED
int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty, double tz,
                                        double fg, char) {
    record("force %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", fx, fy, fz, tx, ty, tz, fg);
    ++writes;
    return answer();
}
#endif

int dhdEnableForce(unsigned char is_on, char) {
    record("enable %d\n", is_on);
    is_force_on = is_on;
    return answer();
}

int dhdStop(char) {
    record("stop\n");
    if (told("stop_hangs")) stand_in::blockForEver();
    return told("stop_fails") ? -1 : 0;
}

int dhdErrorGetLast() {
    return isUnplugged() ? 6 : 2;
}

const char* dhdErrorGetLastStr() {
    return isUnplugged() ? "device not available" : "communication error";
}

#ifndef WITHOUT_OPTIONAL
int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z, double (*frame)[3], char id) {
    // A third of a right angle about the SDK's z axis, as vendors compute it: not quite orthonormal.
    const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6), skew = told("skewed") ? 1.002 : 1;
    const double turned[3][3] = {{c * skew, -s, 0.001 * (skew - 1)}, {s, c / skew, 0}, {0, 0, 1}};
    std::memcpy(frame, turned, sizeof(turned));
    return dhdGetPosition(x, y, z, id);
}

bool dhdHasWrist(char) {
    return true;
}

bool dhdHasActiveWrist(char) {
    return told("type", 34) == 104;
}

bool dhdHasGripper(char) {
    return false;
}

unsigned dhdGetButtonMask(char) {
    return 1;
}

int dhdGetSerialNumber(unsigned short* serial, char) {
    *serial = 4711;
    return 0;
}

const char* dhdGetSystemName(char) {
    return "omega.6";
}

bool drdIsInitialized(char) {
    return !told("uncalibrated");
}
#endif

}  // extern "C"
