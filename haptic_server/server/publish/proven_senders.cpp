#include "haptic_server/server/publish/proven_senders.h"

namespace bonemill {
namespace {

// Far more than a classroom has. Only people of the session fill it, and beyond it only new sender ids are
// refused.
constexpr size_t kMaxProvenSenders = 4096;

}  // namespace

bool ProvenSenders::mayUse(uint64_t sender, const GuidPrefix& participant) {
    const auto found = senders_.find(sender);
    if (found != senders_.end()) return found->second.participant == participant;
    if (senders_.size() >= kMaxProvenSenders) return false;
    senders_.emplace(sender, Sender{participant, "unknown"});
    return true;
}

void ProvenSenders::identify(topics::Command& command, const GuidPrefix& participant) {
    const std::optional<Identity> identity = find_(participant);
    std::string& proof = senders_[command.sender()].proof;
    if (identity && identity->role == "gateway") {
        proof = "says gateway " + identity->name;
        return;
    }
    command.set_role(identity ? roleOfIdentity(identity->role) : topics::Viewer::VIEWER);
    command.set_name(identity ? identity->name : "");
    proof = identity ? "proven" : "not in people.pem";
}

std::string ProvenSenders::proofOf(const topics::Command& command) const {
    const auto found = senders_.find(command.sender());
    return found == senders_.end() ? "" : found->second.proof;
}

topics::Viewer::Role roleOfIdentity(const std::string& role) {
    if (role == "operator") return topics::Viewer::OPERATOR;
    if (role == "instructor") return topics::Viewer::INSTRUCTOR;
    if (role == "examiner") return topics::Viewer::EXAMINER;
    return topics::Viewer::VIEWER;
}

}  // namespace bonemill
