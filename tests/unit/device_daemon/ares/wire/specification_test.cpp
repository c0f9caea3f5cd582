// docs/reference/ares_link.md says what the code does: its tables of fields, and its example.
#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <sstream>

#include "tests/support/places.h"
#include "tests/support/process.h"
#include "tests/unit/device_daemon/ares/wire/wire_test_tools.h"

namespace bonemill::wire {
namespace {

std::string specification() {
    return bonemill::test::readFile(bonemill::test::sourceDir() + "/docs/reference/ares_link.md");
}

std::string sectionOf(const std::string& heading) {
    const std::string text = specification();
    const size_t begin = text.find("\n### " + heading);
    EXPECT_NE(begin, std::string::npos) << heading;
    return text.substr(begin, text.find("\n##", begin + 5) - begin);
}

// Of "u32" or "f64[6]".
size_t sizeOfType(const std::string& type) {
    const std::map<std::string, size_t> sizes = {{"header", sizeof(Header)},
                                                 {"char", 1},
                                                 {"u8", 1},
                                                 {"u16", 2},
                                                 {"i16", 2},
                                                 {"u32", 4},
                                                 {"i32", 4},
                                                 {"f32", 4},
                                                 {"u64", 8},
                                                 {"f64", 8}};
    const size_t bracket = type.find('[');
    const size_t count = bracket == std::string::npos ? 1 : std::stoul(type.substr(bracket + 1));
    return sizes.at(type.substr(0, bracket)) * count;
}

struct Field {
    size_t offset, size;
};

std::map<std::string, Field> fieldsOf(const std::string& heading) {
    std::istringstream section(sectionOf(heading));
    std::map<std::string, Field> fields;
    size_t next = 0;
    for (std::string line; std::getline(section, line);) {
        size_t offset = 0;
        char type[40] = "", name[40] = "";
        if (std::sscanf(line.c_str(), "| %zu | %39s | %39s |", &offset, type, name) != 3) continue;
        EXPECT_EQ(offset, next) << heading << name;
        fields[name] = {offset, sizeOfType(type)};
        next = offset + fields[name].size;
    }
    fields["end"] = {next, 0};
    return fields;
}

#define EXPECT_FIELD(fields, Packet, field)                    \
    EXPECT_EQ(fields[#field].offset, offsetof(Packet, field)); \
    EXPECT_EQ(fields[#field].size, sizeof(Packet::field)) << #field

TEST(Specification, NamesTheFieldsOfEveryPacketWithTheirPlaces) {
    for (const auto& [heading, size] :
         std::map<std::string, size_t>{{"Header, ", sizeof(Header)},
                                       {"DescribeRequest: type 3, host to controller, 40 bytes", 40},
                                       {"Describe: type 4, controller to host, 160 bytes", 160},
                                       {"Description: type 4, controller to host, 232 bytes", 232},
                                       {"JointState: type 1, controller to host, 216 bytes", 216},
                                       {"JointCommand: type 2, host to controller, 80 bytes", 80},
                                       {"PoseState: type 5, bridge to host, 168 bytes", 168},
                                       {"PoseCommand: type 6, host to bridge, 80 bytes", 80}}) {
        EXPECT_EQ(fieldsOf(heading)["end"].offset, size) << heading;
    }
    auto header = fieldsOf("Header, ");
    EXPECT_FIELD(header, Header, version);
    EXPECT_FIELD(header, Header, session);
    EXPECT_FIELD(header, Header, sequence);
    auto request = fieldsOf("DescribeRequest");
    EXPECT_FIELD(request, DescribeRequest, watchdog_us);
    auto describe = fieldsOf("Describe:");
    EXPECT_FIELD(describe, Describe, name);
    EXPECT_FIELD(describe, Describe, stroke);
    EXPECT_FIELD(describe, Describe, kind);
    auto description = fieldsOf("Description:");
    EXPECT_EQ(description["mass"].offset, offsetof(Description, handle) + offsetof(Handle, mass));
    EXPECT_EQ(description["delay"].offset, offsetof(Description, handle) + offsetof(Handle, delay));
    EXPECT_EQ(description["encoder_angle"].offset,
              offsetof(Description, handle) + offsetof(Handle, encoder_angle));
    auto joints = fieldsOf("JointState");
    EXPECT_FIELD(joints, JointState, statusword);
    EXPECT_FIELD(joints, JointState, lost_commands);
    EXPECT_FIELD(joints, JointState, qd);
    EXPECT_FIELD(joints, JointState, counts);
    EXPECT_FIELD(joints, JointState, temperature_dc);
    auto command = fieldsOf("JointCommand");
    EXPECT_FIELD(command, JointCommand, controlword);
    EXPECT_FIELD(command, JointCommand, valid_for_us);
    EXPECT_FIELD(command, JointCommand, force);
    auto pose = fieldsOf("PoseState");
    EXPECT_FIELD(pose, PoseState, q_DT);
    EXPECT_FIELD(pose, PoseState, w_DT);
    EXPECT_FIELD(pose, PoseState, fault_code);
    EXPECT_FIELD(pose, PoseState, applied);
    auto wrench = fieldsOf("PoseCommand");
    EXPECT_FIELD(wrench, PoseCommand, wrench);
}

TEST(Specification, ItsExampleIsWhatTheCodecMakes) {
    const std::string section = sectionOf("Example");
    const size_t begin = section.find("```\n") + 4;
    std::istringstream hex(section.substr(begin, section.find("```", begin) - begin));
    test::Bytes example;
    for (int byte; hex >> std::hex >> byte;) example.push_back(std::byte(byte));

    JointCommand command{};
    command.reflected_sequence = 1234;
    command.flags = kCommandEngaged | kCommandAttached;
    command.host_ns = 1'000'000'000;
    command.controlword = kControlEnable;
    command.mode = kModeTorque;
    command.enabling_echo = kInputEnabled;
    command.valid_for_us = 5000;
    const float forces[6] = {1, -2, 0.5, 0, 10, -0.25};
    std::copy(forces, forces + 6, command.force);
    seal(command, 0x12345678, 42);
    EXPECT_EQ(test::copyOf(command), example);
    EXPECT_TRUE(open<JointCommand>(example));
}

}  // namespace
}  // namespace bonemill::wire
