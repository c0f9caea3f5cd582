// People write commands so: reset, pause, resume, tool NAME (or its number), checkpoint, restore N (or last),
// accuracy NAME, export NAME, reset-device, scene ID, start TRAINEE, stop, note TEXT, erase N (or
// all), shutdown; of a replay also seek SECONDS, speed FACTOR, next, previous, when X Y Z (mm, in W).
#pragma once

#include <string>

#include "proto/topics.pb.h"

namespace bonemill {

// Returns why this is no command, as far as can be said without a server; empty when it may be one.
std::string commandProblem(const std::string& text);

// Returns what it means in the session that shows these. Throws UserError for what is no command, and for
// names and checkpoints that this session does not have.
topics::Command commandOf(const std::string& text, const topics::SceneInfo& scene,
                          const topics::Status& status);

}  // namespace bonemill
