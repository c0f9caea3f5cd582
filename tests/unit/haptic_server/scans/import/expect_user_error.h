// The call throws UserError, and its one line names what the user needs to know.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "common/base/user_error.h"

namespace bonemill {

template <class Call>
void expectUserError(Call&& call, std::initializer_list<std::string> words) {
    try {
        call();
    } catch (const UserError& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        for (const std::string& word : words)
            EXPECT_NE(message.find(word), std::string::npos) << "no \"" << word << "\" in: " << message;
        return;
    }
    ADD_FAILURE() << "no UserError";
}

}  // namespace bonemill
