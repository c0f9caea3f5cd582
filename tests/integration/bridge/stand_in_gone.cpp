// The library that stand_in_incomplete needs.
extern "C" int standInGone() {
    return 1;
}
