// The fields of a scene that may be tuned while the session runs: those of scene::Tuning with the option
// (live) in proto/scene.proto. Server and viewers ask here which these are, what they may be, and how a scene
// file says them. Thread-safe; nothing throws.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proto/scene.pb.h"

namespace bonemill {

struct LiveField {
    const google::protobuf::FieldDescriptor* part;   // of scene::Tuning: coupling
    const google::protobuf::FieldDescriptor* field;  // of that: damping_time_ms

    std::string path() const;  // "coupling.damping_time_ms"
    std::string unit() const;  // for people: "ms"; empty if it has none
    const scene::Range& range() const;
};

// In the order of the schema.
const std::vector<LiveField>& liveFields();

// Returns nothing where the tuning says nothing of the field.
std::optional<double> valueOf(const scene::Tuning& tuning, const LiveField& field);
void setValue(scene::Tuning& tuning, const LiveField& field, double value);

// What the field may be, where this is what the scene file says: what the hand may feel is only lowered.
scene::Range boundsOf(const LiveField& field, const scene::Tuning& of_scene);

// What the scene says of all live fields, its defaults included.
scene::Tuning tunableOf(const scene::Scene& scene);
// The scene with what is tuned in it.
scene::Scene tunedScene(scene::Scene scene, const scene::Tuning& tuning);

// A sentence on the first thing in the tuning that no scene may say or no session may change while it runs;
// empty if there is none.
std::string tuningProblem(const scene::Tuning& tuning, const scene::Tuning& of_scene);

// As a scene file says it, a part a line: "coupling { damping_time_ms: 2 max_force_n: 10 }".
std::string tuningText(const scene::Tuning& tuning);
// Reads such text; nothing if it is none, or says another field of a scene.
std::optional<scene::Tuning> tuningOfText(const std::string& text);

}  // namespace bonemill
