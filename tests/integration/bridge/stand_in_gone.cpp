#include "tests/integration/bridge/stand_in_gone.h"

int standInGone() {
    return 1;
}
