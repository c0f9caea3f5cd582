// This is a server without a volume, steered line by line on stdin; it answers "<node count> <node digest>"
// to each line.
//   nodes FIRST COUNT REVISION    publishes COUNT nodes
//   empty LEAF REVISION           publishes that the node is empty
// Between the lines it publishes status and tool state, and carries out commands. It leaves
// when stdin closes.
#include <poll.h>
#include <unistd.h>

#include <iostream>
#include <sstream>

#include "common/log/log.h"
#include "haptic_server/server/publish/publisher.h"
#include "tests/support/synthetic_nodes.h"

namespace {

using namespace bonemill;

void carryOut(const std::string& line, Publisher& publisher) {
    std::istringstream words(line);
    std::string verb;
    uint32_t first = 0, count = 0, revision = 0;
    words >> verb >> first;
    if (verb == "nodes") {
        words >> count >> revision;
        for (uint32_t leaf = first; leaf < first + count; ++leaf) {
            publisher.publishNodes(std::vector{syntheticNode(leaf, revision)});
        }
    } else if (verb == "empty") {
        words >> revision;
        publisher.publishNodes(std::vector{emptyNode(first, revision)});
    }
    publisher.publishStatus({});
    std::cout << publisher.digest().count() << ' ' << publisher.digest().value() << std::endl;
}

void answerCommands(Publisher& publisher) {
    for (const topics::Command& command : publisher.takeCommands()) {
        publisher.acknowledge(command,
                              {topics::DONE, "done: action " + std::to_string(command.action_case())});
    }
}

}  // namespace

int main(int, char** argv) {
    setUpLog("synthetic_server", "info");  // its standard output is for the test
    Publisher publisher({.domain = static_cast<uint32_t>(std::stoul(argv[1])),
                         .session = static_cast<uint32_t>(std::stoul(argv[2]))});
    publisher.publishSceneInfo(syntheticSceneInfo());
    publisher.publishStatus({});
    std::string line;
    for (uint64_t tick = 1;; ++tick) {
        pollfd input{STDIN_FILENO, POLLIN, 0};
        if (poll(&input, 1, 10) > 0) {
            char c = 0;
            while (true) {
                if (read(STDIN_FILENO, &c, 1) != 1) return 0;
                if (c == '\n') break;
                line += c;
            }
            carryOut(line, publisher);
            line.clear();
        }
        answerCommands(publisher);
        publisher.publishToolState(syntheticTick(tick));
        if (tick % 20 == 0) publisher.publishStatus({});
    }
}
