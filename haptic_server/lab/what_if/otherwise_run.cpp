#include "haptic_server/lab/what_if/otherwise_run.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "common/base/user_error.h"
#include "haptic_server/recording/journal/build_facts.h"
#include "haptic_server/recording/journal/journal.h"
#include "haptic_server/recording/rerun/rerun.h"
#include "haptic_server/scene/setup/scene_materials.h"
#include "haptic_server/scene/setup/scene_setup.h"

namespace bonemill {
namespace {

// The bone is noted so often, ticks: a replay finds its way from there.
constexpr uint64_t kBoneEvery = 1000;

using AnyMessage = std::shared_ptr<const google::protobuf::MessageLite>;

// All that the ticks of a recording rest on, and what happened in it up to a tick.
struct Heritage {
    std::vector<std::pair<JournalTopic, AnyMessage>> messages;
    std::map<uint32_t, double> checkpoint_times_s;
};

template <typename Message>
std::shared_ptr<Message> parsed(const mcap::Message& message) {
    auto out = std::make_shared<Message>();
    return parse(message, *out) ? out : nullptr;
}

bool isPast(const journal::Event& event, uint64_t first) {
    return event.tick() <= first && !event.has_end() && !event.has_incomplete();
}

AnyMessage inherited(JournalTopic topic, const mcap::Message& message, uint64_t first) {
    switch (topic) {
        case JournalTopic::kPutBack:
            return parsed<journal::PutBack>(message);
        case JournalTopic::kTuned:
            return parsed<journal::Tuned>(message);
        case JournalTopic::kCamera:
            return parsed<journal::Camera>(message);
        case JournalTopic::kOrder: {
            const auto order = parsed<journal::Order>(message);
            return order && order->tick() < first ? order : nullptr;
        }
        case JournalTopic::kEvent: {
            const auto event = parsed<journal::Event>(message);
            return event && isPast(*event, first) ? event : nullptr;
        }
        default:
            return nullptr;
    }
}

Heritage heritageOf(const Recording& recording, uint64_t first) {
    Heritage heritage;
    readJournal(recording.path(), [&](JournalTopic topic, const mcap::Message& message) {
        if (const AnyMessage kept = inherited(topic, message, first))
            heritage.messages.emplace_back(topic, kept);
        if (topic != JournalTopic::kBone) return;
        const auto bone = parsed<journal::Bone>(message);
        if (bone && bone->checkpoint() != 0)
            heritage.checkpoint_times_s[bone->checkpoint()] = bone->checkpoint_session_s();
    });
    return heritage;
}

JournalConfig configOf(const Recording& recording, const OtherwiseRun& run, const LoadedScene& scene,
                       const std::filesystem::path& path) {
    JournalConfig config;
    config.path = path;
    config.manifest = recording.manifest();
    config.recorded = recordedEffectsOf(scene.scene.effects());
    config.rate_hz = scene.scene.loop().rate_hz();
    journal::Manifest& manifest = config.manifest;
    manifest.set_journal_id(newJournalId());
    *manifest.mutable_build() = buildFacts(run.version);
    journal::WhatIf& what_if = *manifest.mutable_what_if();
    what_if.set_journal_id(recording.manifest().journal_id());
    what_if.set_tick(run.first);
    what_if.set_change(run.change);
    return config;
}

class Recorder {
  public:
    Recorder(const Recording& recording, const OtherwiseRun& run, const std::filesystem::path& path)
        : recording_(recording),
          run_(run),
          loaded_(recording.scene()),
          simulation_(setUpScene(loaded_)),
          bones_(recording.readBones(*simulation_.bone)),
          rerun_(recording, simulation_, bones_.checkpoints, *simulation_.bone, bones_.keyframes.front()),
          journal_(configOf(recording, run, loaded_, path),
                   {rerun_.history().scanned(), simulation_.bone->lattice}) {
        if (!bones_.problem.empty()) throw UserError(recording.path().string() + ": " + bones_.problem);
    }

    RecordedAttempt run() {
        inherit();
        RecordedTicks ticks(recording_);
        while (rerun_.next() < run_.first) {
            const JournalTick& tick = ticks.at(rerun_.next());
            add(tick, rerun_.step());
        }
        const TickSpan span{run_.attempt.begin, std::min(run_.attempt.end, recording_.ticks())};
        OtherHand hand(recording_, run_.otherwise, span, run_.first, simulation_.tick.dt);
        uint64_t count = 0;
        while (const std::optional<JournalTick> tick = hand.tick(count)) {
            add(*tick, rerun_.stepOtherwise(*tick));
            ++count;
        }
        return finish(span, count);
    }

  private:
    void inherit() {
        const Heritage heritage = heritageOf(recording_, run_.first);
        noteBone(orderBefore());
        for (const auto& [number, state] : bones_.checkpoints) {
            const auto time = heritage.checkpoint_times_s.find(number);
            journal_.putCheckpoint(state, number,
                                   time == heritage.checkpoint_times_s.end() ? 0 : time->second);
        }
        for (const auto& [topic, message] : heritage.messages) journal_.put(topic, *message);
        journal_.flush();
    }
    // That no tick has taken up: done in the bone with which the session began.
    uint64_t orderBefore() const {
        const uint64_t first = RecordedTicks(recording_).at(0).input.decisions.bone_order;
        return recording_.content().put_backs.contains(first) ? 0 : first;
    }
    void noteBone(uint64_t order) {
        journal_.putBone(rerun_.history().snapshot(*simulation_.bone), order);
        journal_.round();
    }
    // Times, orders and tunings as the recording counts them.
    void add(const JournalTick& tick, TickRecord record) {
        record.start_ns = tick.start_ns;
        record.input.decisions = tick.input.decisions;
        journal_.add(record);
        if ((record.tick + 1) % kBoneEvery == 0 && !rerun_.history().isRestoring())
            noteBone(record.bone_order);
    }
    RecordedAttempt finish(const TickSpan& span, uint64_t count) {
        RecordedAttempt attempt = run_.attempt;
        if (attempt.time_s) {
            attempt.end = run_.first + count;
            const double longer = double(attempt.end) - double(span.end);
            attempt.time_s = *attempt.time_s + longer * simulation_.tick.dt;
            noteEnd(attempt);
        }
        journal_.finish();
        if (const std::string problem = journal_.problem(); !problem.empty())
            throw UserError(journal_.path().string() + ": " + problem);
        return attempt;
    }
    void noteEnd(const RecordedAttempt& attempt) {
        journal::Event event;
        event.set_tick(attempt.end);
        topics::Attempt& ended = *event.mutable_attempt_ended();
        ended.set_trainee(attempt.trainee);
        ended.set_time_s(*attempt.time_s);
        journal_.put(JournalTopic::kEvent, event);
    }

    const Recording& recording_;
    const OtherwiseRun& run_;
    LoadedScene loaded_;
    SceneSetup simulation_;
    Recording::Bones bones_;
    Rerun rerun_;
    Journal journal_;
};

}  // namespace

RecordedAttempt recordOtherwise(const Recording& recording, const OtherwiseRun& run,
                                const std::filesystem::path& journal) {
    return Recorder(recording, run, journal).run();
}

uint64_t sameTicks(const Recording& happened, const Recording& otherwise, uint64_t first) {
    RecordedTicks then(happened), now(otherwise);
    uint64_t tick = 0;
    while (tick < first && then.at(tick).check == now.at(tick).check) ++tick;
    return tick;
}

}  // namespace bonemill
