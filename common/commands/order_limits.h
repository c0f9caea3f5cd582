// Bounds how often a server does what costs its tick, its disk or everyone's network, whoever asks: so many
// orders of a kind at once, and over a long time one in so long. It lives as long as the process; the
// publisher thread asks.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "common/base/units.h"
#include "common/log/log_limit.h"
#include "proto/topics.pb.h"

namespace bonemill {

class OrderLimits {
  public:
    // The refusal is empty if the order may be carried out now.
    std::string refusalOf(const topics::Command& command, int64_t now_ns) {
        for (Kind& kind : kinds_) {
            if (!kind.isOf(command.action_case())) continue;
            if (kind.limit.ask(now_ns) >= 0) return "";
            return "refused: too many orders of this kind; one in " + std::to_string(kind.every_s) +
                   " s is carried out";
        }
        return "";
    }

  private:
    using Action = topics::Command::ActionCase;
    struct Kind {
        std::array<Action, 2> actions;
        int at_once, every_s;
        LogLimit limit{at_once, every_s* kNsPerSecond};
        bool isOf(Action action) const { return action == actions[0] || action == actions[1]; }
    };
    std::array<Kind, 9> kinds_{{{{topics::Command::kSetAccuracy, topics::Command::kSetAccuracy}, 12, 2},
                                {{topics::Command::kSelectTool, topics::Command::kSelectTool}, 12, 1},
                                {{topics::Command::kResetVolume, topics::Command::kRestoreCheckpoint}, 8, 1},
                                {{topics::Command::kSaveCheckpoint, topics::Command::kSaveCheckpoint}, 12, 1},
                                {{topics::Command::kExport, topics::Command::kExport}, 6, 5},
                                {{topics::Command::kChooseScene, topics::Command::kChooseScene}, 6, 5},
                                {{topics::Command::kStartAttempt, topics::Command::kStopAttempt}, 12, 2},
                                {{topics::Command::kAddRemark, topics::Command::kAddRemark}, 20, 1},
                                {{topics::Command::kEraseRemark, topics::Command::kEraseRemark}, 20, 1}}};
};

}  // namespace bonemill
