// This intruder invents as many senders as its standard input says, and prints "done". The third argument
// says what they send: "commands", "viewers" or "wishes".
#include <iostream>
#include <string>
#include <thread>

#include "common/dds/endpoint.h"
#include "common/log/log.h"

namespace {

using namespace bonemill;

template <class Sample>
void invent(char** argv) {
    const dds::Participant participant(static_cast<uint32_t>(std::stoul(argv[1])));
    dds::Writer<Sample> writer(participant);
    Sample sample{};
    sample.session = static_cast<uint32_t>(std::stoul(argv[2]));
    const std::string bytes = "no message";
    dds::setPayload(sample, bytes);
    uint64_t senders = 0;
    std::cin >> senders;
    while (writer.matchedReaders() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    for (sample.sender = 1; sample.sender <= senders; ++sample.sender) writer.write(sample);
    std::cout << "done" << std::endl;
    std::cin >> senders;  // its keys stay until it is told to go
}

}  // namespace

int main(int, char** argv) {
    setUpLog("synthetic_intruder", "info");  // its standard output is for the test
    const std::string what = argv[3];
    if (what == "viewers")
        invent<dds::ViewerSample>(argv);
    else if (what == "wishes")
        invent<dds::DensityWishSample>(argv);
    else
        invent<dds::CommandSample>(argv);
}
