#include "device_daemon/bridges/touch/hd_library.h"

#include <cstdio>

namespace bonemill::bridge {

// The driver fails when it is loaded a second time, and its own parts look for symbols of this one.
HdLibrary::HdLibrary(const std::string& chosen, const Tell& tell)
    : library_({"libHD.so", "OpenHaptics and the Touch driver of 3D Systems", chosen, true, {}}) {
    tell("library: " + library_.path());
#define REQUIRE(function) library_.require(function, #function)
    REQUIRE(hdInitDevice);
    REQUIRE(hdDisableDevice);
    REQUIRE(hdMakeCurrentDevice);
    REQUIRE(hdBeginFrame);
    REQUIRE(hdEndFrame);
    REQUIRE(hdEnable);
    REQUIRE(hdDisable);
    REQUIRE(hdGetIntegerv);
    REQUIRE(hdGetDoublev);
    REQUIRE(hdSetDoublev);
    REQUIRE(hdGetString);
    REQUIRE(hdGetError);
    REQUIRE(hdGetErrorString);
    REQUIRE(hdCheckCalibration);
    REQUIRE(hdStartScheduler);
    REQUIRE(hdStopScheduler);
    REQUIRE(hdScheduleAsynchronous);
    REQUIRE(hdUnschedule);
#undef REQUIRE
    library_.allow(hdUpdateCalibration, "hdUpdateCalibration");
    if (!library_.missingOptional().empty())
        tell("the library lacks, and the bridge goes without: " + joined(library_.missingOptional()));
    library_.checkRequired();
}

unsigned HdLibrary::takeErrors() noexcept {
    constexpr int kDeepest = 64;  // a library that never runs out of errors must not hold its own thread
    unsigned oldest = 0;
    for (int i = 0; i < kDeepest; ++i) {
        const HdErrorInfo error = hdGetError();
        if (error.code == 0) break;
        oldest = error.code;
    }
    return oldest;
}

std::string HdLibrary::textOf(unsigned error) const {
    char number[16];
    std::snprintf(number, sizeof(number), "0x%04x", error);
    const char* text = hdGetErrorString(error);
    return std::string("error ") + number + ", " + (text ? text : "no text");
}

}  // namespace bonemill::bridge
