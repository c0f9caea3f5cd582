// A language that is spoken for the length of a test.
#pragma once

#include <string>

#include "render_client/language/language.h"

namespace bonemill::test {

class Spoken {
  public:
    explicit Spoken(const std::string& code) { speak(code); }
    ~Spoken() { speak(kEnglish); }
    Spoken(const Spoken&) = delete;
    Spoken& operator=(const Spoken&) = delete;
};

}  // namespace bonemill::test
