/* An example of a bridge (docs/howto/bridges.md): plain C99 and sockets, no other file of this project. The device is a mass
 * on a spring, which the host's force moves; put your own device where it says DEVICE.
 *
 *   cc -std=c99 -O2 -o spring_bridge spring_bridge.c -lm && ./spring_bridge 0
 *
 * Frames and units are those of docs/howto/bridges.md; numbers are little-endian, as this machine must be. */
#define _DEFAULT_SOURCE
#include <arpa/inet.h>
#include <math.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { kDescribeRequest = 3, kDescribe = 4, kPoseState = 5, kPoseCommand = 6 };
enum { kGivesForce = 1, kIsSimulated = 16 }; /* DEVICE: an arm with a motor or a hand is not simulated */
enum { kOff = 0x40, kReady = 0x21, kSwitchedOn = 0x23, kEnabled = 0x27, kFault = 0x08 };

static volatile sig_atomic_t shall_end = 0;
static struct sockaddr_in host;
static uint32_t session, sent, newest; /* the session, and the last packet's number of either side */
static uint32_t watchdog_us = 5000;
static uint64_t heard_us, commanded_us; /* when the host was last heard, and commanded last; 0: never */
static unsigned status = kOff, faults, first_fault;
static float wrench[6];
static const double kMaxForce = 10; /* N */
static double share;                /* of the wrench that is given: it comes and goes within 20 ms */

static void onSignal(int number) { (void)number; shall_end = 1; }

static uint64_t nowUs(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u;
}

static uint32_t crc32Of(const uint8_t* bytes, size_t count) { /* that of zlib and Ethernet */
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < count; ++i) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    return ~crc;
}

static uint16_t u16(const uint8_t* at) { uint16_t value; memcpy(&value, at, 2); return value; }
static uint32_t u32(const uint8_t* at) { uint32_t value; memcpy(&value, at, 4); return value; }
static void put16(uint8_t* at, uint16_t value) { memcpy(at, &value, 2); }
static void put32(uint8_t* at, uint32_t value) { memcpy(at, &value, 4); }
static void putF(uint8_t* at, float value) { memcpy(at, &value, 4); }
static void putD(uint8_t* at, double value) { memcpy(at, &value, 8); }

static void sendPacket(int udp, uint8_t* packet, int type, uint16_t length) {
    memcpy(packet, "BCML\1", 5);
    packet[5] = (uint8_t)type;
    put16(packet + 6, length);
    put32(packet + 8, session);
    put32(packet + 12, ++sent);
    put32(packet + length - 4, crc32Of(packet, length - 4u));
    sendto(udp, packet, length, 0, (struct sockaddr*)&host, sizeof host);
}

static void describe(int udp) {
    uint8_t packet[160] = {0};
    put32(packet + 20, kGivesForce | kIsSimulated);
    strcpy((char*)packet + 32, "spring (example in C)");
    putD(packet + 80, kMaxForce);
    putD(packet + 112, 0.1); /* workspace radius, m */
    put32(packet + 144, watchdog_us);
    put32(packet + 148, 1000); /* Hz */
    put32(packet + 152, 5);    /* somebody's own bridge */
    sendPacket(udp, packet, kDescribe, sizeof packet);
}

static void obey(const uint8_t* packet) { /* the state machine of CiA 402, as far as it is needed */
    static unsigned last;
    const unsigned control = u16(packet + 32);
    const int resets = (control & 0x80) && !(last & 0x80);
    last = control;
    memcpy(wrench, packet + 48, sizeof wrench);
    for (int i = 0; i < 6; ++i) if (!isfinite(wrench[i])) memset(wrench, 0, sizeof wrench);
    const double x = wrench[0], y = wrench[1], z = wrench[2], force = sqrt(x * x + y * y + z * z);
    for (int i = 0; i < 3; ++i) if (force > kMaxForce) wrench[i] *= (float)(kMaxForce / force);
    if (status == kFault) {
        if (resets && !faults) { status = kOff; first_fault = 0; }
    } else if (!(control & 2) || !(control & 4)) status = kOff;
    else if ((control & 15) == 6) status = kReady;
    else if ((control & 15) == 7) status = status == kOff ? kOff : kSwitchedOn;
    else if ((control & 15) == 15) status = status == kSwitchedOn || status == kEnabled ? kEnabled : status;
}

static void take(int udp, const uint8_t* packet, size_t length, struct sockaddr_in from) {
    if (length < 20 || memcmp(packet, "BCML\1", 5) || u16(packet + 6) != length ||
        u32(packet + length - 4) != crc32Of(packet, length - 4)) return;
    const uint32_t number = u32(packet + 12);
    const int is_host = from.sin_port == host.sin_port && from.sin_addr.s_addr == host.sin_addr.s_addr;
    const int is_ours = heard_us && is_host && u32(packet + 8) == session;
    const int is_new = number != newest && number - newest < 0x80000000u;
    if (packet[5] == kDescribeRequest && length == 40) {
        const uint64_t keeps_place_us = is_host ? watchdog_us : 1000000;
        if (!is_ours && heard_us && nowUs() - heard_us <= keeps_place_us) return; /* there is another host */
        if (is_ours && !is_new) return;
        if (!is_ours && status != kFault) status = kOff;
        const uint32_t wish_us = u32(packet + 24) ? u32(packet + 24) : 5000;
        watchdog_us = wish_us < 2000 ? 2000 : wish_us > 30000 ? 30000 : wish_us;
        host = from;
        session = u32(packet + 8);
        if (!is_ours) commanded_us = 0;
        describe(udp);
    } else if (packet[5] == kPoseCommand && length == 80 && is_ours && is_new) {
        obey(packet);
        commanded_us = nowUs();
    } else return;
    newest = number;
    heard_us = nowUs();
}

static void sendState(int udp, const double position[3]) {
    uint8_t packet[168] = {0};
    put32(packet + 16, newest);
    put32(packet + 20, 1u | 2u | 4u | (shall_end ? 32u : 0)); /* chain closed, enabled, homed; it leaves */
    const uint64_t now_ns = nowUs() * 1000u;
    memcpy(packet + 24, &now_ns, 8);
    put16(packet + 32, (uint16_t)(status | 0x210)); /* it has power, and obeys the network */
    packet[34] = status == kEnabled ? 10 : 0;       /* mode: torque, or none */
    put32(packet + 36, first_fault);
    put32(packet + 40, faults);
    const uint64_t age_10us = (nowUs() - commanded_us) / 10;
    put16(packet + 44, commanded_us && age_10us < 65535 ? (uint16_t)age_10us : 65535);
    for (int i = 0; i < 3; ++i) putD(packet + 48 + 8 * i, position[i]);
    putD(packet + 72, 1); /* it does not turn */
    for (int i = 0; i < 6; ++i) putF(packet + 104 + 4 * i, NAN); /* the host differentiates */
    for (int i = 0; i < 6; ++i) putF(packet + 136 + 4 * i, NAN); /* the force is not measured */
    sendPacket(udp, packet, kPoseState, sizeof packet);
}

int main(int argc, char** argv) {
    const int udp = socket(AF_INET, SOCK_DGRAM, 0);
    struct sockaddr_in own = {0};
    socklen_t size = sizeof own;
    own.sin_family = AF_INET;
    own.sin_port = htons((uint16_t)(argc > 1 ? atoi(argv[1]) : 0));
    own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (bind(udp, (struct sockaddr*)&own, sizeof own) != 0) { perror("bind"); return 2; }
    getsockname(udp, (struct sockaddr*)&own, &size);
    printf("listening on 127.0.0.1:%d\n", ntohs(own.sin_port));
    fflush(stdout);
    signal(SIGTERM, onSignal);
    signal(SIGINT, onSignal);
    double position[3] = {0, 0, 0}, velocity[3] = {0, 0, 0};
    int farewells = 0;
    for (uint64_t next_us = nowUs();; next_us += 1000) {
        const uint64_t now_us = nowUs();
        if (now_us < next_us) usleep((useconds_t)(next_us - now_us));
        uint8_t packet[256];
        struct sockaddr_in from;
        for (ssize_t length; size = sizeof from, (length = recvfrom(udp, packet, sizeof packet, MSG_DONTWAIT,
                                                                     (struct sockaddr*)&from, &size)) > 0;)
            take(udp, packet, (size_t)length, from);
        const int is_silent = !heard_us || nowUs() - heard_us > watchdog_us;
        faults = is_silent && (faults || (status != kOff && status != kFault)) ? 1 : 0;
        if (faults && status != kFault) { status = kFault; first_fault = faults; }
        share = status == kEnabled ? fmin(1, share + 0.05) : fmax(0, share - 0.05);
        for (int i = 0; i < 3; ++i) { /* DEVICE: read the pose, give the share of the force */
            const double force = share * wrench[i];
            velocity[i] += 0.001 * (force - 200 * position[i] - 2 * velocity[i]) / 0.1;
            position[i] += 0.001 * velocity[i];
        }
        if (heard_us) sendState(udp, position);
        if (shall_end && ++farewells > 20) return 0; /* the host hears it, also when a packet is lost */
    }
}
