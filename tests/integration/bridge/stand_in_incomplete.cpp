// A library whose dependency is missing at run time.
#include "tests/integration/bridge/stand_in_gone.h"

extern "C" int standInIncomplete() {
    return standInGone();
}
