// A bonemill that answers from files and notes what it was told, in place of the real one.
#pragma once

#include <filesystem>
#include <string>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill::test {

class FakeLauncher {
  public:
    // It lists what is in `list`, or what the real bonemill lists.
    FakeLauncher() {
        writeFile(file(), R"(#!/bin/bash
folder=${0%/*}
case $1 in
    list) if [[ -e $folder/list ]]; then cat "$folder/list"; else exec ")" +
                              sourceDir() +
                              R"(/deploy/bonemill" "$@"; fi; exit ;;
    sessions | doctor) cat "$folder/$1" 2>/dev/null; exit ;;
    watch) [[ "$*" != *" --list "* ]] || { cat "$folder/found" 2>/dev/null; exit; } ;;
esac
echo "$*" >>"$folder/told"
[[ ! -e $folder/fails ]] || { cat "$folder/fails" >&2; exit 2; }
echo "bonemill: close the window or press Ctrl-C to end"
while [[ -d $folder && ! -e $folder/end ]]; do sleep 0.02; done
rm -f "$folder/end"
)");
        std::filesystem::permissions(file(), std::filesystem::perms::owner_all);
    }
    std::string file() const { return folder_ / "bonemill"; }
    const TemporaryFolder& folder() const { return folder_; }
    void put(const std::string& name, const std::string& lines) const { writeFile(folder_ / name, lines); }
    // What it was told to start so far, a line each.
    std::string told() const { return readFile(folder_ / "told"); }
    // Whatever runs comes to its end.
    void letEnd() const { writeFile(folder_ / "end", ""); }

  private:
    TemporaryFolder folder_;
};

}  // namespace bonemill::test
