// Bounds how often a server does what costs its tick, its disk or everyone's network, whoever asks: the limit
// of each row (command_rows.h). It lives as long as the process; the publisher thread asks.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "common/commands/command_rows.h"
#include "common/log/log_limit.h"

namespace bonemill {

class OrderLimits {
  public:
    OrderLimits();

    // Says why the order may not be carried out now; empty if it may.
    std::string whyNotNow(CommandAction action, int64_t now_ns);

  private:
    std::map<CommandAction, LogLimit> limits_;  // of those that have one of their own
};

}  // namespace bonemill
