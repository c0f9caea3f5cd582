#include "render_client/web/gateway/guest_voice.h"

#include "common/commands/role_rules.h"

namespace bonemill::gateway {
namespace {

template <class Sample, class Message>
void say(dds::Writer<Sample>& writer, uint32_t session, const Message& message) {
    const std::string bytes = message.SerializeAsString();
    Sample sample{};
    sample.session = session;
    sample.sender = message.sender();
    dds::setPayload(sample, bytes);
    writer.write(sample);
}

}  // namespace

void GuestVoice::announce(const Speaker& speaker, topics::Viewer viewer) {
    viewer.set_sender(speaker.sender);
    viewer.set_name(speaker.name);
    viewer.set_role(speaker.role);
    viewer.set_link(speaker.link);
    if (!mayPoint(speaker.role)) viewer.clear_pointer_m();
    if (!mayHoldTool(speaker.role)) viewer.clear_is_holding();
    viewer.clear_eye(), viewer.clear_is_trainee();  // the trainee is in the building
    if (mouth_) say(mouth_->viewers, session_, viewer);
}

void GuestVoice::command(const Speaker& speaker, topics::Command command) {
    command.set_sender(speaker.sender);
    command.set_role(speaker.role);
    command.set_name(speaker.name);
    if (mouth_) say(mouth_->commands, session_, command);
}

void GuestVoice::hand(const Speaker& speaker, topics::HandPointer hand) {
    hand.set_sender(speaker.sender);
    hand.set_role(speaker.role);
    if (mouth_) say(mouth_->hands, session_, hand);
}

void GuestVoice::wish(const Speaker& speaker, topics::DensityWish wish) {
    wish.set_sender(speaker.sender);
    if (mouth_) say(mouth_->wishes, session_, wish);
}

}  // namespace bonemill::gateway
