# bonemill handbook: the pages of docs/, as a browser reads them.
# shellcheck shell=bash
# shellcheck disable=SC2154

handbook() {
    local pages=$bin/../handbook how="make it with: cmake --build --preset release --target handbook" page
    if [[ $installed == true ]]; then
        pages=$here/../share/doc/bonemill/handbook how="install the package bonemill-doc"
    fi
    read_words handbook "" "$@"
    [[ -f $pages/index.html ]] || fail "the handbook is not on this PC: $how"
    page=$(find_page "$(realpath -- "$pages")" "$operand") || exit 2
    echo "$page"
    # The browser goes on by itself.
    if has_display && command -v xdg-open >/dev/null; then setsid --fork xdg-open "$page" >/dev/null 2>&1 </dev/null; fi
}

# find_page FOLDER WORD: WORD is a page as messages name it (docs/howto/start.md), or its name alone. Another word is looked
# for in the pages.
find_page() {
    local word=${2#docs/} named=() having
    word=${word%.md}
    [[ -n $word ]] || word=index
    mapfile -t named < <(find "$1" -path "$1/$word.html" -o -path "$1/*/$word.html" | sort)
    if [[ ${#named[@]} == 1 ]]; then echo "${named[0]}"; return; fi
    named=("${named[@]#"$1/"}")
    [[ ${#named[@]} == 0 ]] || fail "several pages of the handbook are called $2: ${named[*]%.html}"
    having=$(cd "$1" && grep -rliF --include='*.html' -- "$2" . | sed 's#^\./##; s#\.html$##' | sort | head -n 12 | paste -sd ' ')
    [[ -n $having ]] || fail "the handbook has no page $2, and none with that word: bonemill handbook alone opens its first page"
    fail "the handbook has no page $2; these have that word: $having"
}
