// A library whose dependency is missing at run time.
extern "C" int standInGone();
extern "C" int standInIncomplete() {
    return standInGone();
}
