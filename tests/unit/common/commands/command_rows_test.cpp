#include "common/commands/command_rows.h"

#include <gtest/gtest.h>

#include <set>

#include "common/commands/command_text.h"

namespace bonemill {
namespace {

using google::protobuf::FieldDescriptor;

TEST(CommandRows, EveryActionHasARowWithWordsForAllThatItMayBe) {
    int actions = 0;
    forEachCommand([&](CommandAction action, const topics::CommandRow& row) {
        ++actions;
        const std::string& name = fieldOf(action)->name();
        ASSERT_TRUE(fieldOf(action)->options().HasExtension(topics::row)) << name;
        ASSERT_GT(row.forms_size(), 0) << name;
        for (const topics::CommandForm& form : row.forms()) {
            EXPECT_FALSE(form.order().empty()) << name;
            const CommandPlace place = placeOf(action, form);
            ASSERT_EQ(place.field != nullptr, form.has_field()) << name << " has no field " << form.field();
            const bool is_message =
                (place.field ? place.field : place.action)->type() == FieldDescriptor::TYPE_MESSAGE;
            EXPECT_EQ(is_message, form.kind() == topics::CommandForm::PLACE ||
                                      form.kind() == topics::CommandForm::SCENE_TEXT)
                << name;
        }
    });
    EXPECT_EQ(actions, topics::Command::descriptor()->FindOneofByName("action")->field_count());
}

TEST(CommandRows, NoWordMeansTwoThings) {
    std::set<std::string> words;
    forEachCommand([&](CommandAction, const topics::CommandRow& row) {
        for (const topics::CommandForm& form : row.forms()) {
            if (!form.has_word()) continue;
            EXPECT_TRUE(words.insert(form.word()).second) << form.word();
            EXPECT_EQ(form.word().find(' '), std::string::npos) << form.word();
        }
    });
    EXPECT_GE(words.size(), 20u);
}

TEST(CommandRows, WhatAsksForNothingWhenItIsFalseIsABool) {
    forEachCommand([&](CommandAction action, const topics::CommandRow& row) {
        EXPECT_TRUE(!row.is_plain() || fieldOf(action)->type() == FieldDescriptor::TYPE_BOOL)
            << fieldOf(action)->name();
    });
}

TEST(CommandRows, WhatIsNotKnownHasAnEmptyRow) {
    for (const int action : {0, 1, 10, 999}) {
        EXPECT_EQ(fieldOf(CommandAction(action)), nullptr) << action;
        EXPECT_EQ(rowOf(CommandAction(action)).forms_size(), 0) << action;
    }
}

topics::Command replayOf(void (*set)(topics::ReplayOrder&)) {
    topics::Command command;
    set(*command.mutable_replay());
    return command;
}

TEST(CommandText, SaysWhatIsOrdered) {
    topics::Command command;
    EXPECT_EQ(commandText(command), "no action");
    command.set_pause_milling(true);
    EXPECT_EQ(commandText(command), "pause milling");
    command.set_pause_milling(false);
    EXPECT_EQ(commandText(command), "go on milling");
    command.set_select_tool(1);
    EXPECT_EQ(commandText(command), "tool 2");
    command.set_restore_checkpoint(0);
    EXPECT_EQ(commandText(command), "put the bone back");
    command.set_restore_checkpoint(7);
    EXPECT_EQ(commandText(command), "back to checkpoint 7");
    command.set_erase_remark(0);
    EXPECT_EQ(commandText(command), "erase all notes and strokes");
    command.mutable_add_remark();
    EXPECT_EQ(commandText(command), "draw a stroke");
    command.mutable_add_remark()->set_note("x");
    EXPECT_EQ(commandText(command), "write a note");
    EXPECT_EQ(commandText(replayOf([](auto& order) { order.set_seek_s(12.5); })), "go to 12.50 s");
    EXPECT_EQ(commandText(replayOf([](auto& order) { order.set_speed(0.25); })), "speed 0.25");
    EXPECT_EQ(commandText(replayOf([](auto& order) { order.set_jump(-1); })), "event before");
    EXPECT_EQ(commandText(replayOf([](auto& order) { order.mutable_removal_at(); })),
              "when this was removed");
    EXPECT_EQ(commandText(replayOf([](auto&) {})), "replay") << "a replay's order of a later version";
}

TEST(CommandText, SaysThatItIsDoneAndWhoseAttempt) {
    topics::Command command;
    command.set_start_attempt("Ben");
    EXPECT_EQ(doneText(command, "Anna"), "Ben's attempt has begun");
    command.set_stop_attempt(true);
    EXPECT_EQ(doneText(command, "Anna"), "Anna's attempt has ended");
    EXPECT_EQ(doneText(command, ""), "The attempt has ended");
    command.set_set_accuracy("fast");
    EXPECT_EQ(doneText(command, ""), "Accuracy is fast now");
    command.set_export_("x");
    EXPECT_EQ(doneText(command, ""), "It is done");
}

}  // namespace
}  // namespace bonemill
