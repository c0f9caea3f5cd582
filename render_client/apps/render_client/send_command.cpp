#include "render_client/apps/render_client/send_command.h"

#include <iostream>
#include <stdexcept>

#include "render_client/apps/render_client/stop_signal.h"
#include "render_client/link/subscribe/command_words.h"

namespace bonemill {
namespace {

using Clock = std::chrono::steady_clock;

// Returns true when `condition` held in time, false after `end` or a stop signal.
template <class Condition>
bool pollUntil(SceneSubscriber& subscriber, Clock::time_point end, Condition&& condition) {
    constexpr std::chrono::milliseconds kSlice{20};  // also how often a command that waits is looked after
    while (!stopRequested() && Clock::now() < end) {
        subscriber.poll();
        if (condition()) return true;
        subscriber.waitForData(kSlice);
    }
    return false;
}

}  // namespace

int runSendCommand(const ClientOptions& options) {
    const CommandOptions& wish = *options.command;
    SceneSubscriber subscriber(options.subscriber);
    // A server takes commands as soon as it shows a status.
    const auto is_ready = [&] {
        return subscriber.hasServer() && subscriber.status() && subscriber.sceneInfo();
    };
    if (!pollUntil(subscriber, Clock::now() + wish.timeout, is_ready)) {
        if (stopRequested()) return 1;
        throw std::runtime_error("no server within " + std::to_string(wish.timeout.count()) +
                                 " s: " + serverQuestion(options.subscriber));
    }
    subscriber.sendCommand(commandOf(wish.text, *subscriber.sceneInfo(), *subscriber.status()));
    std::vector<CommandOutcome> outcomes;
    // The outbox itself gives up in time.
    pollUntil(subscriber, Clock::time_point::max(),
              [&] { return !(outcomes = subscriber.takeOutcomes()).empty(); });
    if (outcomes.empty()) return 1;
    std::cout << outcomeText(outcomes.front());
    if (outcomes.front().command.has_replay() && outcomes.front().isDone() &&
        !subscriber.status()->replay().event().empty())
        std::cout << ": " << subscriber.status()->replay().event();
    std::cout << std::endl;
    return outcomes.front().isDone() ? 0 : 1;
}

}  // namespace bonemill
