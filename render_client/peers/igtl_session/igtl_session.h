// A session for peers that speak OpenIGTLink, such as 3D Slicer: it watches as a viewer does, shows them
// tool, hand, wrench, bone, scan and events, and takes their orders in the one role that it has itself
// (docs/howto/slicer.md).
//
// For one thread.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "common/igtl_wire/igtl_port.h"
#include "render_client/link/subscribe/scene_subscriber.h"
#include "render_client/peers/igtl_session/bone_pieces.h"
#include "render_client/peers/igtl_session/igtl_guest.h"
#include "render_client/peers/igtl_session/scan_image.h"
#include "render_client/peers/igtl_session/session_news.h"

namespace bonemill::igtl {

struct IgtlOptions {
    SubscriberOptions subscriber;
    std::string address = "127.0.0.1";
    uint16_t port = 18944;  // 0: any
    std::string secret;     // whoever says it may order; empty: nobody
    double bone_mbit_per_s = 64;
    PortBounds bounds = {};
};

class IgtlSession : private LineSink {
  public:
    // Throws UserError.
    explicit IgtlSession(const IgtlOptions& options);

    // Takes and says what is new, or waits some milliseconds for it.
    void step();
    uint16_t port() const { return port_.number(); }
    const SceneSubscriber& subscriber() const { return subscriber_; }

  private:
    using Clock = Line::Clock;
    void came(Line& line) override;
    void heard(Line& line, const Frame& frame) override;
    void gone(const Line& line) override;
    void hearText(IgtlGuest& guest, const Frame& frame);
    void hearSecret(IgtlGuest& guest, const std::string& secret);
    void order(IgtlGuest& guest, const std::string& text);
    std::string whyNot(const IgtlGuest& guest, const std::string& text) const;
    void answer(IgtlGuest& guest, const std::string& text);
    void askForImage(IgtlGuest& guest);
    void showTool();
    void showBone(Clock::time_point now);
    void showImage(Clock::time_point now);
    void showNews(Clock::time_point now);
    void showOutcomes();
    void announce(Clock::time_point now);
    Blob statusNow() const;
    void sayAll(const Blob& frame, void (IgtlGuest::*say)(const Blob&));

    const IgtlOptions options_;
    SceneSubscriber subscriber_;
    Port port_;
    BonePieces bone_;
    ScanImage image_;
    SessionNews news_;
    std::map<uint64_t, IgtlGuest> guests_;      // by the number of their lines
    std::map<uint32_t, uint64_t> whose_order_;  // by its sequence
    uint64_t tick_ = 0;                         // of the pose that was shown last
    Clock::time_point pose_due_, status_due_, announce_due_;
};

}  // namespace bonemill::igtl
