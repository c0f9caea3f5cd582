#include "common/commands/order_limits.h"

#include "common/base/units.h"

namespace bonemill {
namespace {

// The action as which this one counts.
CommandAction countedAs(CommandAction action) {
    const topics::CommandRow& row = rowOf(action);
    if (!row.has_limit_of()) return action;
    return CommandAction(topics::Command::descriptor()->FindFieldByName(row.limit_of())->number());
}

}  // namespace

OrderLimits::OrderLimits() {
    forEachCommand([this](CommandAction action, const topics::CommandRow& row) {
        if (row.has_limit())
            limits_.emplace(action, LogLimit(row.limit().at_once(), row.limit().every_s() * kNsPerSecond));
    });
}

std::string OrderLimits::whyNotNow(CommandAction action, int64_t now_ns) {
    const auto limit = limits_.find(countedAs(action));
    if (limit == limits_.end() || limit->second.ask(now_ns) >= 0) return "";
    return "too many orders of this kind; one in " + std::to_string(rowOf(limit->first).limit().every_s()) +
           " s is carried out";
}

}  // namespace bonemill
