// Makes a journal of a session that never was.
#pragma once

#include "haptic_server/recording/journal/journal.h"
#include "tests/unit/haptic_server/core/bone/milled_ball.h"
#include "tests/unit/haptic_server/recording/journal/recorded_ticks.h"

namespace bonemill::test {

// 2.5 s with a groove now and then, a checkpoint and an order to put the bone back. Returns the ticks.
inline std::vector<TickRecord> recordSession(Journal& journal, MilledBall& ball) {
    auto records = recordedTicks(2500);
    journal::PutBack put_back;
    put_back.set_bone_order(1);
    put_back.set_checkpoint(3);
    for (const TickRecord& record : records) {
        journal.add(record);
        if (record.tick % 4 == 0) journal.round();
        if (record.tick % 200 == 0) {
            ball.groove(4e-3 + double(record.tick) * 4e-6);
            journal.putBone(ball.history.snapshot(ball.bone), 0);
        }
        if (record.tick != 900) continue;
        journal.putCheckpoint(ball.history.snapshot(ball.bone), 3, 0.9);
        journal.put(JournalTopic::kPutBack, put_back);
    }
    return records;
}

}  // namespace bonemill::test
