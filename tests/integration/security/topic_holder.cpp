// Writes one thing on each topic that its part may write, and reads those that it may read.
//   topic_holder DOMAIN SESSION PART:DIR
// PART is server, device, operator or observer, DIR its folder for --secure, empty in an open session. A line
// on its stdin is a question, and is answered by a line:
//   writers  for each topic that it writes: NAME GUID
//   state    for each topic that it reads: NAME alive|gone|none KEYHASH
//   stop     from now on it writes nothing: "stopped"
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include "common/dds/network.h"
#include "common/dds/topic_traits.h"
#include "common/process/run_program.h"
#include "common/security/security_folder.h"

namespace {

using namespace bonemill;

constexpr char kPlugins[] = "/usr/lib/x86_64-linux-gnu/libddsc0debian";

struct Part {
    std::string name;
    std::vector<std::string> writes, reads;
};
const std::vector<std::string> kShown{"node_mesh", "scene_info",   "structure_mesh", "status",
                                      "lesson",    "remark",       "scene_picture",  "tool_state",
                                      "ticks",     "density_brick"};
const std::vector<Part> kParts{{"server", kShown, {"command", "density_wish", "viewer"}},
                               {"device", {}, {"hand_pointer"}},
                               {"operator", {"command", "density_wish", "viewer", "hand_pointer"}, {}},
                               {"observer", {}, kShown}};

struct Held {
    std::string topic;
    dds_entity_t entity;
    void (*write)(dds_entity_t writer, uint32_t session);
};

template <class Sample>
void writeOne(dds_entity_t writer, uint32_t session) {
    uint8_t byte = 1;
    Sample sample{};
    sample.session = session;
    sample.payload = {1, 1, &byte, false};
    dds_write(writer, &sample);
}

class Holder {
  public:
    Holder(dds_entity_t participant, const Part& part) {
        hold<dds::NodeMeshSample, dds::SceneInfoSample, dds::StructureMeshSample, dds::ToolStateSample,
             dds::StatusSample, dds::LessonSample, dds::ScenePictureSample, dds::RemarkSample,
             dds::ViewerSample, dds::HandPointerSample, dds::CommandSample, dds::DensityBrickSample,
             dds::DensityWishSample>(participant, part);
    }
    void write(uint32_t session) const {
        for (const Held& held : writers_) held.write(held.entity, session);
    }
    std::string writers() const {
        std::string text;
        for (const Held& held : writers_) {
            dds_guid_t guid;
            if (dds_get_guid(held.entity, &guid) == DDS_RETCODE_OK)
                text += held.topic + ' ' + hex(guid.v) + ' ';
        }
        return text;
    }
    std::string states() const {
        std::string text;
        for (const Held& held : readers_) text += held.topic + ' ' + stateOf(held.entity) + ' ';
        return text;
    }

  private:
    template <class... Samples>
    void hold(dds_entity_t participant, const Part& part) {
        (holdOne<Samples>(participant, part), ...);
    }
    template <class Sample>
    void holdOne(dds_entity_t participant, const Part& part) {
        const dds::TopicDescription description = dds::describeTopic<Sample>();
        const std::string name = std::string(description.name).substr(std::string("bonemill_").size());
        const bool writes = std::ranges::count(part.writes, name) > 0;
        if (!writes && std::ranges::count(part.reads, name) == 0) return;
        const dds_entity_t topic =
            dds_create_topic(participant, description.type, description.name, nullptr, nullptr);
        const dds_entity_t entity =
            writes ? dds_create_writer(participant, topic, description.qos.get(), nullptr)
                   : dds_create_reader(participant, topic, description.qos.get(), nullptr);
        (writes ? writers_ : readers_).push_back({name, entity, writeOne<Sample>});
    }
    static std::string hex(std::span<const uint8_t> bytes) {
        std::string text;
        constexpr char kDigits[] = "0123456789abcdef";
        for (const uint8_t byte : bytes) text += {kDigits[byte >> 4], kDigits[byte & 15]};
        return text;
    }
    static std::string stateOf(dds_entity_t reader) {
        ddsi_serdata* data = nullptr;
        dds_sample_info_t info;
        if (dds_readcdr(reader, &data, 1, &info, DDS_ANY_STATE) != 1) return "none -";
        ddsi_keyhash_t hash;
        ddsi_serdata_get_keyhash(data, &hash, false);
        ddsi_serdata_unref(data);
        return (info.instance_state == DDS_IST_ALIVE ? "alive " : "gone ") + hex(hash.value);
    }

    std::vector<Held> writers_, readers_;
};

dds_entity_t participantOf(uint32_t domain, const std::string& secure) {
    dds_create_domain(domain, dds::networkConfiguration({}).c_str());
    const dds::Qos qos = dds::makeQos();
    if (!secure.empty())
        for (const auto& [name, value] : SecurityFolder(secure).properties(kPlugins))
            dds_qset_prop(qos.get(), name.c_str(), value.c_str());
    return dds_create_participant(domain, qos.get(), nullptr);
}

std::string answerTo(const std::string& question, const Holder& holder, bool& writes) {
    if (question == "writers") return holder.writers();
    if (question == "state") return holder.states();
    writes = false;
    return "stopped";
}

int hold(uint32_t domain, uint32_t session, const std::string& part_and_folder) {
    const size_t colon = part_and_folder.find(':');
    const auto part = std::ranges::find(kParts, part_and_folder.substr(0, colon), &Part::name);
    const Holder holder(participantOf(domain, part_and_folder.substr(colon + 1)), *part);
    bool writes = true;
    for (;;) {
        if (writes) holder.write(session);
        pollfd input{STDIN_FILENO, POLLIN, 0};
        if (poll(&input, 1, 50) <= 0) continue;
        std::string question;
        if (!std::getline(std::cin, question)) return 0;
        std::cout << answerTo(question, holder, writes) << std::endl;
    }
}

}  // namespace

int main(int, char** argv) {
    return bonemill::runProgram(
        [&] { return hold(uint32_t(std::stoul(argv[1])), uint32_t(std::stoul(argv[2])), argv[3]); });
}
