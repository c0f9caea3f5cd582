#include "render_client/peers/igtl_session/session_news.h"

#include <utility>

namespace bonemill::igtl {
namespace {

using topics::EffectState;

constexpr std::pair<EffectState::Event, const char*> kEffects[] = {
    {EffectState::SPINDLE_STALLED, "the spindle stalls"},
    {EffectState::NEAR_PROTECTED, "the burr is near a protected structure"},
    {EffectState::PROTECTED_TOUCHED, "a protected structure is touched"},
    {EffectState::PROTECTED_DAMAGED, "a protected structure is damaged"},
    {EffectState::TOO_HOT, "bone is too hot"},
};

}  // namespace

std::vector<std::string> SessionNews::take(const SceneSubscriber& subscriber) {
    std::vector<std::string> news;
    const bool has_server = subscriber.hasServer() && subscriber.status();
    if (has_server != std::exchange(has_server_, has_server)) {
        if (!has_server)
            news.push_back(subscriber.hasEnded() ? "the session has ended" : "no session is heard");
        scene_.reset();
    }
    if (!has_server) return news;
    takeStatus(*subscriber.status(), news);
    takeRemarks(subscriber, news);
    if (subscriber.toolState()) takeEffects(*subscriber.toolState(), news);
    return news;
}

void SessionNews::takeStatus(const topics::Status& status, std::vector<std::string>& news) {
    if (scene_ != status.scene()) news.push_back("session: " + status.scene());
    scene_ = status.scene();
    const bool paused = status.is_milling_paused();
    if (is_paused_.value_or(false) != paused) news.push_back(paused ? "milling pauses" : "milling goes on");
    is_paused_ = paused;
    const uint32_t newest = status.checkpoints().empty() ? 0 : status.checkpoints().rbegin()->id();
    if (checkpoint_ && newest > *checkpoint_) news.push_back("checkpoint " + std::to_string(newest));
    checkpoint_ = newest;
    if (status.fault_text() != fault_ && !status.fault_text().empty())
        news.push_back("fault: " + status.fault_text());
    fault_ = status.fault_text();
    const auto& warnings = status.training().warnings();
    for (const std::string& warning : warnings)
        if (!warnings_.contains(warning)) news.push_back("warning: " + warning);
    warnings_ = {warnings.begin(), warnings.end()};
}

void SessionNews::takeRemarks(const SceneSubscriber& subscriber, std::vector<std::string>& news) {
    if (std::exchange(remark_changes_, subscriber.remarkChanges()) == subscriber.remarkChanges()) return;
    std::set<uint32_t> numbers;
    for (const auto& [place, remark] : subscriber.remarks()) {
        numbers.insert(remark.number());
        if (!remark.note().empty() && !remarks_.contains(remark.number()))
            news.push_back(remark.author() + ": " + remark.note());
    }
    remarks_ = std::move(numbers);
}

void SessionNews::takeEffects(const topics::ToolState& state, std::vector<std::string>& news) {
    if (std::exchange(tick_, state.tick()) == state.tick()) return;
    const uint32_t before = std::exchange(effects_, state.effects().events());
    for (const auto& [bit, words] : kEffects)
        if (effects_ & ~before & uint32_t(bit)) news.emplace_back(words);
}

}  // namespace bonemill::igtl
