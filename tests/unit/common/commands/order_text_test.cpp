#include <gtest/gtest.h>

#include "common/commands/command_text.h"

namespace bonemill {
namespace {

TEST(OrderText, NamesEveryOrder) {
    topics::Command command;
    EXPECT_EQ(orderText(command), "nothing");
    command.set_set_accuracy("fast\nlogin: root" + std::string(100, 'x'));
    EXPECT_EQ(orderText(command), "set_accuracy fast?login: rootxxxxxxxxxxxxxxxx...");
    command.set_select_tool(2);
    EXPECT_EQ(orderText(command), "select_tool 2");
    command.set_pause_milling(false);
    EXPECT_EQ(orderText(command), "pause_milling false");
    command.set_shut_down(true);
    EXPECT_EQ(orderText(command), "shut_down");
    command.mutable_add_remark()->set_note("not to be logged");
    EXPECT_EQ(orderText(command), "add_remark");
    // An action of another kind would need words of its own.
    const auto* actions = topics::Command::descriptor()->oneof_decl(0);
    for (int n = 0; n < actions->field_count(); ++n) {
        using google::protobuf::FieldDescriptor;
        const auto type = actions->field(n)->type();
        EXPECT_TRUE(type == FieldDescriptor::TYPE_STRING || type == FieldDescriptor::TYPE_UINT32 ||
                    type == FieldDescriptor::TYPE_BOOL || type == FieldDescriptor::TYPE_MESSAGE)
            << actions->field(n)->name();
    }
}

TEST(OrderText, WhatIsTunedIsInOneLine) {
    topics::Command command;
    command.mutable_tune()->mutable_coupling()->set_damping_time_ms(2);
    command.mutable_tune()->mutable_contact()->set_stiffness_n_per_mm3(50);
    const std::string text = "contact { stiffness_n_per_mm3: 50 } coupling { damping_time_ms: 2 }";
    EXPECT_EQ(orderText(command), "tune " + text);
    EXPECT_EQ(commandText(command), "tune " + text);
    command.mutable_tune()->Clear();
    EXPECT_EQ(commandText(command), "tune as the scene file says");
}

}  // namespace
}  // namespace bonemill
