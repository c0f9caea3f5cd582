// Keeps a SessionState equal to what the session's server shows by DDS. Bytes that do not make sense are
// dropped and counted. Which server counts, and what of nodes is shown together, is decided as in a viewer
// (subscribe/server_choice.h, scene_model.h). For one thread; nothing waits.
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "common/dds/endpoint.h"
#include "render_client/link/subscribe/scene_model.h"
#include "render_client/link/subscribe/server_choice.h"
#include "render_client/link/subscribe/server_numbers.h"
#include "render_client/link/subscribe/server_readers.h"
#include "render_client/link/subscribe/viewer_list.h"
#include "render_client/web/gateway/session_state.h"

namespace bonemill::gateway {

class SessionMirror {
  public:
    using Clock = std::chrono::steady_clock;

    // It has joined no domain yet.
    explicit SessionMirror(uint32_t session) : session_(session) {}

    // Hears what comes there from now on, and keeps what it has. The participant must outlive the mirror, or
    // leave() comes before. Throws UserError.
    void join(const dds::Participant& participant);
    void leave();

    // Takes what has arrived, if a domain is joined.
    SessionChanges poll();
    // When our server was heard last.
    std::optional<Clock::time_point> lastHeard() const { return last_heard_; }
    // The caller has slept for so long: silence in its sleep says nothing.
    void forgive(Clock::duration slept) {
        if (last_heard_) *last_heard_ += slept;
    }
    const SessionState& state() const noexcept { return state_; }
    // From now on bricks of the scan's densities are taken, too, or no longer.
    void hearBricks(bool should_hear);
    // The whole model of the newest status is here.
    bool isComplete() const;
    uint64_t malformedSamples() const noexcept { return malformed_count_; }

  private:
    void takeAll();
    void takeStatus();
    void takeSceneInfo();
    void takeLesson();
    void takePictures();
    void takeStructures();
    void takeToolState();
    void takeNodes();
    void releaseNodes();
    void takeViewers();
    void showViewers();
    void takeRemarks();
    void takeBricks();
    void placeTool();
    // Returns whether a message of this epoch from this writer, as `reader` knows it, is our server's.
    template <class Sample>
    bool accept(uint64_t epoch, const Inlet<Sample>& reader, uint64_t writer);
    void beginRun();
    void readAnewIfDue();
    bool isHeard() const;
    bool isServerAlive() const;
    void noteEnd();
    void keep(Topic topic, uint64_t key, std::string payload);
    void forget(Topic topic, uint64_t key);
    void dropMalformed(const char* what);

    struct ArrivedNode {
        Payload payload;
        Eigen::Vector3f place_V;
    };

    // What it hears the domain by.
    struct Ears {
        explicit Ears(const dds::Participant& participant);
        void readAnew();

        const dds::Participant& participant;
        Inlet<dds::ViewerSample> viewers;
        std::optional<Inlet<dds::DensityBrickSample>> bricks;
        std::unique_ptr<ServerReaders> servers;
    };

    const uint32_t session_;
    SessionState state_;
    SessionChanges changes_;
    SceneModel model_;
    ServerChoice choice_;
    std::map<std::pair<uint32_t, uint32_t>, ArrivedNode> arrived_;  // by leaf and revision, not shown yet
    uint32_t scene_revision_ = 0;
    Eigen::Vector3d p_WV_ = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_WV_ = Eigen::Quaterniond::Identity();
    uint64_t status_writer_ = 0;
    std::optional<Clock::time_point> last_heard_;
    bool is_matched_ = false;
    ServerNumbers server_numbers_;
    std::optional<Clock::time_point> read_anew_;
    ViewerList viewers_;
    Clock::time_point listed_;  // the viewers
    uint64_t malformed_count_ = 0;
    std::optional<Ears> ears_;  // none: no domain is joined
};

}  // namespace bonemill::gateway
