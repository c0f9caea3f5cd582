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
#include "render_client/gateway/session_state.h"
#include "render_client/subscribe/scene_model.h"
#include "render_client/subscribe/server_choice.h"
#include "render_client/subscribe/server_numbers.h"
#include "render_client/subscribe/server_readers.h"
#include "render_client/subscribe/viewer_list.h"

namespace bonemill::gateway {

class SessionMirror {
  public:
    using Clock = std::chrono::steady_clock;

    // The participant must outlive the mirror. Throws UserError.
    SessionMirror(const dds::Participant& participant, uint32_t session);

    // Takes what has arrived.
    SessionChanges poll();
    const SessionState& state() const noexcept { return state_; }
    // From now on bricks of the scan's densities are taken, too, or no longer.
    void hearBricks(bool should_hear);
    // The whole model of the newest status is here.
    bool isComplete() const;
    uint64_t malformedSamples() const noexcept { return malformed_count_; }

  private:
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

    const dds::Participant& participant_;
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

    Inlet<dds::ViewerSample> viewer_reader_;
    std::optional<Inlet<dds::DensityBrickSample>> brick_reader_;
    std::unique_ptr<ServerReaders> servers_;
};

}  // namespace bonemill::gateway
