// Brings the densities that a viewer wants from the server into its DensityStore, and keeps them up to date.
//
// One thread, that of the store. A viewer that wants none has no reader, sends nothing and hears nothing: all
// begins with the first wish, and ends some time after the last.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "common/density_codec/density_codec.h"
#include "proto/topics.pb.h"
#include "render_client/link/density_store/density_store.h"
#include "render_client/link/subscribe/wire.h"

namespace bonemill {

// The run of the server that is shown.
struct DensityRun {
    const std::optional<topics::SceneInfo>& info;  // the newest
    uint64_t epoch;                                // 0: none
    // Says whether a writer of this participant (dds::Reader::participantOf) is that server's: nobody else's
    // bricks are taken.
    std::function<bool(uint64_t participant, uint64_t writer)> is_its;
};

class DensityFeed {
  public:
    static constexpr int64_t kWishPeriod_ns = 100'000'000;   // while what it says changes
    static constexpr int64_t kRepeat_ns = 1'000'000'000;     // it is said again
    static constexpr int64_t kFarewell_ns = 10'000'000'000;  // with nothing wanted for so long it stops

    // What the wire names must outlive this object.
    DensityFeed(const Wire& wire, uint32_t session, uint64_t sender)
        : wire_(wire), session_(session), sender_(sender) {}

    // Takes what has arrived, and says what the store wants; another run empties the store. `drop` is told of
    // what makes no sense. It never waits.
    void update(DensityStore& store, const DensityRun& run, int64_t now_ns,
                const std::function<void(const std::string&)>& drop);

    bool isListening() const { return reader_.has_value(); }
    uint64_t takenBricks() const { return taken_bricks_; }

  private:
    void follow(DensityStore& store, const DensityRun& run);
    void take(DensityStore& store, const DensityRun& run,
              const std::function<void(const std::string&)>& drop);
    bool apply(DensityStore& store, uint32_t brick, const topics::DensityBrick& message);
    bool isAir(uint32_t brick) const;
    topics::DensityWish wishOf(DensityStore& store);
    void say(DensityStore& store, int64_t now_ns);

    const Wire wire_;
    uint32_t session_;
    uint64_t sender_;
    uint64_t epoch_ = 0;
    std::string air_;  // DensityGrid.air
    DensityDecoder decoder_;
    std::vector<uint32_t> wished_;  // as said last, ascending
    std::string said_;
    int64_t said_ns_ = 0;
    int64_t wanted_ns_ = 0;  // when anything was wanted last
    uint64_t taken_bricks_ = 0;
    std::optional<Inlet<dds::DensityBrickSample>> reader_;
    std::optional<Outlet<dds::DensityWishSample>> writer_;
};

}  // namespace bonemill
