// The two programs at the ends of a device link.
#pragma once

namespace bonemill {

enum class LinkSide { kServer, kDaemon };

inline LinkSide peerOf(LinkSide side) noexcept {
    return side == LinkSide::kServer ? LinkSide::kDaemon : LinkSide::kServer;
}

inline const char* programOf(LinkSide side) noexcept {
    return side == LinkSide::kServer ? "haptic_server" : "device_daemon";
}

}  // namespace bonemill
