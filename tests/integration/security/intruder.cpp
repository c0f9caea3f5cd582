// Writes what it should not: an order to end the session as instructor Anna, and a status of another server,
// for some seconds; and reads what it can of the server's status. Prints one JSON line at the end.
//   intruder --session N --domain D [--secure DIR [--plugins DIR]] [--sender N] [--seconds S] [--days-back N]
//            [--senders N]
// With --plugins the plugins of DDS Security are those of that folder. With --days-back its clock is slow.
// With --senders it does nothing but to invent so many, who order and show themselves once each, 5000 of them
// per second.
#include <dds/dds.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <thread>

#include "common/cli/command_line.h"
#include "common/dds/network.h"
#include "common/dds/topic_traits.h"
#include "common/process/run_program.h"
#include "common/security/security_folder.h"
#include "proto/topics.pb.h"

namespace {
std::time_t clock_is_slow_s = 0;
}

// Who has an identity that has expired turns the clock back: these stand before the C library's, also for
// OpenSSL and Cyclone.
extern "C" {
int clock_gettime(clockid_t clock, timespec* now) noexcept {
    const long result = syscall(SYS_clock_gettime, clock, now);
    if (result == 0 && clock == CLOCK_REALTIME) now->tv_sec -= clock_is_slow_s;
    return int(result);
}
std::time_t time(std::time_t* place) noexcept {
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    if (place) *place = now.tv_sec;
    return now.tv_sec;
}
}

namespace {

using namespace bonemill;

constexpr uint64_t kForgedEpoch = UINT64_MAX / 2;

struct Intrusion {
    uint32_t session = 1, domain = 0;
    std::string secure, plugins;
    uint64_t sender = 66;
    double seconds = 3;
    uint64_t senders = 0;
};

dds_entity_t participantOf(const Intrusion& intrusion) {
    dds_create_domain(intrusion.domain, dds::networkConfiguration({}).c_str());
    const dds::Qos qos = dds::makeQos();
    if (!intrusion.secure.empty())
        for (const auto& [name, value] : SecurityFolder(intrusion.secure).properties(intrusion.plugins))
            dds_qset_prop(qos.get(), name.c_str(), value.c_str());
    return dds_create_participant(intrusion.domain, qos.get(), nullptr);
}

template <class Sample>
dds_entity_t topicOf(dds_entity_t participant) {
    const auto description = dds::describeTopic<Sample>();
    return dds_create_topic(participant, description.type, description.name, nullptr, nullptr);
}

template <class Sample>
dds_entity_t writerOf(dds_entity_t participant) {
    return dds_create_writer(participant, topicOf<Sample>(participant),
                             dds::describeTopic<Sample>().qos.get(), nullptr);
}

template <class Sample>
void write(dds_entity_t writer, Sample sample, const std::string& bytes) {
    sample.payload._length = sample.payload._maximum = uint32_t(bytes.size());
    sample.payload._buffer = reinterpret_cast<uint8_t*>(const_cast<char*>(bytes.data()));
    dds_write(writer, &sample);
}

topics::Command endOfSession(const Intrusion& intrusion, uint32_t sequence) {
    topics::Command command;
    command.set_sender(intrusion.sender);
    command.set_sequence(sequence);
    command.set_shut_down(true);
    command.set_role(topics::Viewer::INSTRUCTOR);
    command.set_name("Anna");
    return command;
}

topics::Status statusOfAnother() {
    topics::Status status;
    status.set_epoch(kForgedEpoch);
    status.set_scene("forged");
    return status;
}

int intrude(const Intrusion& intrusion) {
    const dds_entity_t participant = participantOf(intrusion);
    const dds_entity_t reader = dds_create_reader(participant, topicOf<dds::StatusSample>(participant),
                                                  dds::describeTopic<dds::StatusSample>().qos.get(), nullptr);
    const dds_entity_t commands = writerOf<dds::CommandSample>(participant);
    const dds_entity_t statuses = writerOf<dds::StatusSample>(participant);
    int read = 0, matched = 0;
    for (uint32_t n = 1; n <= uint32_t(intrusion.seconds * 20); ++n) {
        // What was written here last must not stand before what the server wrote.
        void* sample = nullptr;
        dds_sample_info_t info;
        if (reader > 0 && dds_take(reader, &sample, &info, 1, 1) > 0) {
            const auto* bytes = static_cast<const dds::StatusSample*>(sample);
            topics::Status status;
            read += status.ParseFromArray(bytes->payload._buffer, int(bytes->payload._length)) &&
                    status.epoch() != kForgedEpoch;
            dds_return_loan(reader, &sample, 1);
        }
        write(commands, dds::CommandSample{intrusion.session, intrusion.sender, {}},
              endOfSession(intrusion, n).SerializeAsString());
        write(statuses, dds::StatusSample{intrusion.session, {}}, statusOfAnother().SerializeAsString());
        dds_publication_matched_status_t status{};
        if (commands > 0 && dds_get_publication_matched_status(commands, &status) == DDS_RETCODE_OK)
            matched = std::max(matched, int(status.total_count));
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    std::printf("{\"commands\":%s,\"statuses\":%s,\"matched\":%d,\"read\":%d}\n",
                commands > 0 ? "true" : "false", statuses > 0 ? "true" : "false", matched, read);
    return 0;
}

int invent(const Intrusion& intrusion) {
    const dds_entity_t participant = participantOf(intrusion);
    const dds_entity_t commands = writerOf<dds::CommandSample>(participant);
    const dds_entity_t viewers = writerOf<dds::ViewerSample>(participant);
    std::this_thread::sleep_for(std::chrono::seconds(1));  // until they have found each other
    for (uint64_t n = 0; n < intrusion.senders; ++n) {
        const uint64_t sender = intrusion.sender + n;
        topics::Command command;
        command.set_sender(sender);
        command.set_sequence(1);
        command.set_pause_milling(false);
        topics::Viewer viewer;
        viewer.set_name("Viewer " + std::to_string(n));
        write(commands, dds::CommandSample{intrusion.session, sender, {}}, command.SerializeAsString());
        write(viewers, dds::ViewerSample{intrusion.session, sender, {}}, viewer.SerializeAsString());
        // Else Cyclone keeps all of them here.
        dds::CommandSample gone{intrusion.session, sender, {}};
        dds_unregister_instance(commands, &gone);
        dds::ViewerSample left{intrusion.session, sender, {}};
        dds_unregister_instance(viewers, &left);
        if (n % 50 == 49) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::printf("{\"senders\":%llu}\n", static_cast<unsigned long long>(intrusion.senders));
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return bonemill::runProgram([&] {
        CLI::App app("Writes what it should not", "intruder");
        Intrusion intrusion;
        app.add_option("--session", intrusion.session)->required();
        app.add_option("--domain", intrusion.domain)->required();
        app.add_option("--secure", intrusion.secure);
        app.add_option("--plugins", intrusion.plugins);
        app.add_option("--sender", intrusion.sender);
        app.add_option("--seconds", intrusion.seconds);
        app.add_option("--senders", intrusion.senders);
        std::time_t days_back = 0;
        app.add_option("--days-back", days_back);
        if (!bonemill::parseCommandLine(app, argc, argv, "intruder")) return 0;
        clock_is_slow_s = days_back * 86400;
        return intrusion.senders > 0 ? invent(intrusion) : intrude(intrusion);
    });
}
