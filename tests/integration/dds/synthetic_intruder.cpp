// This intruder sends commands of as many invented senders as its standard input says, and prints "done".
#include <iostream>
#include <string>
#include <thread>

#include "common/dds/endpoint.h"

int main(int, char** argv) {
    using namespace bonemill;
    const dds::Participant participant(static_cast<uint32_t>(std::stoul(argv[1])));
    dds::Writer<dds::CommandSample> writer(participant);
    dds::CommandSample sample{};
    sample.session = static_cast<uint32_t>(std::stoul(argv[2]));
    const std::string bytes = "no command";
    dds::setPayload(sample, bytes);
    uint64_t senders = 0;
    std::cin >> senders;
    while (writer.matchedReaders() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    for (sample.sender = 1; sample.sender <= senders; ++sample.sender) writer.write(sample);
    std::cout << "done" << std::endl;
    std::cin >> senders;  // its keys stay until it is told to go
}
