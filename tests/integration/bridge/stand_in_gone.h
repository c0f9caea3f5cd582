// What stand_in_incomplete needs of stand_in_gone.
#pragma once

extern "C" int standInGone();
