// How a command ended: as a value for programs and as a text for people, logs and recordings. It is for any
// thread.
#pragma once

#include <string>

#include "proto/topics.pb.h"

namespace bonemill {

struct Answer {
    topics::Outcome outcome = topics::UNSAID;
    std::string text;  // "done", "refused: <why>", "failed: <why>"

    static Answer done() { return {topics::DONE, "done"}; }
    static Answer refused(const std::string& why) { return {topics::REFUSED, "refused: " + why}; }
    static Answer failed(const std::string& why) { return {topics::FAILED, "failed: " + why}; }
};

}  // namespace bonemill
