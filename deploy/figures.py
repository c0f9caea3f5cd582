"""The figures that texts quote: docs/figures.json, which deploy/measure writes, docs/benchmark.json, which
tests/bench/benchmark/run writes, and their marks in README.md, CONTRIBUTING.md and docs/. A mark is a comment, which a
reader of the page does not see:

  in 62<!--=accuracy.tooth_corridor.balanced.tick_p50_us--> µs    the number before the mark is this figure
  <!--=benchmark.bonemill balanced.peg.force_error-->             a program's figure in a scene of the benchmark, or of all
  (Intel Xeon, 2 cores)<!--=machine-->                            what is in the brackets; so, too, commit and date

  <!--=table accuracy.tooth_corridor.{}.tick_p50_us - .tick_p99_us-->
  | setting | p50, of us | p99 |      the numbers of each row, in order; `-`: a number that is no figure; {} is the
  |---|---|---|                       row's first cell: the code in it, else all of it; a name that begins with a dot
  | `balanced` | 62 of 1000 | 129 |   begins like the one before it

How many decimals are shown is the author's choice. deploy/measure says which figures there are and how to measure them;
tests/support/check_docs asks faults() below.
"""

import hashlib
import json
import re

FILE, BENCHMARK = "docs/figures.json", "docs/benchmark.json"
# What a tick's time depends on: its own code, and how it is compiled.
CODE = ("haptic_server/core", "haptic_server/laws", "common/geometry", "common/math", "CMakeLists.txt", "CMakePresets.json")
HEADER = ("machine", "commit", "date")
TEXTS = re.compile(r"(README|CONTRIBUTING|docs/(\w+/)?[^/]+)\.md")
MARK = re.compile(r"\*{0,2}<!--=(?!table\s)(?P<name>[^>]+?)-->")
TABLE = re.compile(r"<!--=table\s+(?P<names>[^>]+?)-->[ ]*\n(?P<rows>(?:\|.*(?:\n|$))*)")
NUMBER = r"(?<![\w.])-?\d+(?:\.\d+)?(?!\w)"


def code_of(root):
    """A hash of each part of CODE, without its comments and blanks."""
    found = {}
    for part in CODE:
        paths = [root / part] if (root / part).is_file() else sorted((root / part).rglob("*"))
        digest = hashlib.sha256()
        for path in paths:
            if path.is_file() and path.suffix in (".h", ".cpp", ".txt", ".json"):
                text = path.read_text(encoding="utf-8", errors="replace")
                text = re.sub(r"//.*" if path.suffix in (".h", ".cpp") else r"(?m)^\s*#.*", "", text)
                digest.update(" ".join([path.relative_to(root).as_posix(), *text.split(), "\0"]).encode())
        if any(path.is_file() for path in paths):
            found[part] = digest.hexdigest()[:12]
    return found


def read(root, file=FILE):
    return json.loads((root / file).read_text(encoding="utf-8")) if (root / file).exists() else {}


def write(root, measured):
    """One line for each figure."""
    text = json.dumps(measured, indent=1, ensure_ascii=False)
    text = re.sub(r"\[\n\s+([-\d.e+,\s]+?)\n\s+\]", lambda found: "[" + " ".join(found.group(1).split()) + "]", text)
    (root / FILE).write_text(text + "\n", encoding="utf-8")


def values(measured):
    """Each figure by its name; of the three numbers (median, quartiles) the median."""
    found = {name: measured[name] for name in (*HEADER, "load_before") if name in measured}
    for bench, result in measured.get("benches", {}).items():
        found |= {f"{bench}.{name}": numbers[0] for name, numbers in result["figures"].items()}
    return found


def known(root):
    """Each figure that a text may quote, by its name."""
    return values(read(root)) | benchmark_values(read(root, BENCHMARK))


def benchmark_values(result):
    """Each figure of the benchmark by its name; those that a program cannot have are not there."""
    found = {}
    for program in result.get("programs", []):
        for scene, figures in (("", program["figures"]), *program["scenes"].items()):
            for name, figure in figures.items():
                if figure["value"] is not None:
                    found[".".join(filter(None, ("benchmark", program["name"], scene, name)))] = figure["value"]
    return found


def shown_as(value, shown):
    """The value as the text would show it: with as many decimals as it shows now."""
    if isinstance(value, str):
        return value
    decimals = len(shown.partition(".")[2])
    return f"{round(value, decimals) + 0.0:.{decimals}f}"


def names_of(words):
    """A name that begins with a dot gets what the one before it has up to {}."""
    found = []
    for word in words:
        begin = next((name[:name.index("{}") + 2] for name in reversed(found) if "{}" in name), "")
        found.append(begin + word if word.startswith(".") else word)
    return found


def key_of(cell):
    code = re.search(r"`([^`]+)`", cell)
    return code.group(1) if code else cell.replace("*", "").strip()


class Text:
    """One text with the places in it that quote figures."""

    def __init__(self, text):
        self.text = text
        self.quotes = []  # start, end, name
        self.faults = []  # start, what is wrong with a mark
        for mark in MARK.finditer(text):
            self.take_mark(mark)
        for table in TABLE.finditer(text):
            self.take_table(table)

    def take_mark(self, mark):
        name, line = mark.group("name"), self.text.rfind("\n", 0, mark.start()) + 1
        pattern = r"(?<=\()[^()]+(?=\)$)|[^\s(*|]+$" if name in HEADER else NUMBER + "$"
        shown = re.search(pattern, self.text[line:mark.start()])
        if shown:
            self.quotes.append((line + shown.start(), line + shown.end(), name))
        else:
            self.faults.append((mark.start(), f"the mark {name} does not stand behind a figure"))

    def take_table(self, table):
        names, row_start = names_of(table.group("names").split()), table.start("rows")
        for number, row in enumerate(table.group("rows").splitlines()):
            first_cell = row.split("|")[1] if row.count("|") > 1 else ""
            numbers = list(re.finditer(NUMBER, row[len(first_cell) + 1:])) if number > 1 else []
            if number > 1 and len(numbers) != len(names):
                self.faults.append((row_start, f"the row {key_of(first_cell)} has {len(numbers)} numbers, its table's mark {len(names)} names"))
            elif numbers:
                start = row_start + len(first_cell) + 1
                self.quotes += [(start + one.start(), start + one.end(), name.replace("{}", key_of(first_cell)))
                                for one, name in zip(numbers, names) if name != "-"]
            row_start += len(row) + 1

    def wrong(self, known):
        """Start and complaint of each mark and figure that is not as in the file."""
        found = list(self.faults)
        for start, end, name in self.quotes:
            shown = self.text[start:end]
            if name not in known:
                found.append((start, f"{file_of(name)} has no figure {name}"))
            elif shown_as(known[name], shown) != shown:
                found.append((start, f"{shown} is {shown_as(known[name], shown)} in {file_of(name)}: {name}"))
        return sorted(found)

    def rewritten(self, known):
        text = self.text
        for start, end, name in sorted(self.quotes, reverse=True):
            if name in known:
                text = text[:start] + shown_as(known[name], text[start:end]) + text[end:]
        return text


def shipped_faults(root, measured):
    """What the viewer's panel shows is read from the files beside the scenes: do they say the same?"""
    found = []
    for bench, result in measured.get("benches", {}).items():
        place = f"deploy/scenes/{bench.partition('.')[2]}.accuracy.json"
        if not bench.startswith("accuracy.") or not (root / place).exists():
            continue
        settings = json.loads((root / place).read_text(encoding="utf-8"))["settings"]
        for name, numbers in result["figures"].items():
            setting, _, field = name.rpartition(".")
            if setting in settings and rounded(settings[setting][field]) != numbers[0]:
                found.append(f"{place}: {setting}: {field} is {numbers[0]} in {FILE}")
    return found


def file_of(name):
    return BENCHMARK if name.startswith("benchmark.") else FILE


def rounded(value):
    return float(f"{value:.5g}")


def faults(root, texts):
    """What is wrong with the figures of these texts: place -> content."""
    measured = read(root)
    all_known, quotes = known(root), 0
    found = shipped_faults(root, measured)
    for place, content in texts.items():
        text = Text(content)
        quotes += len(text.quotes)
        found += [f"{place}:{content.count(chr(10), 0, start) + 1}: {what}" for start, what in text.wrong(all_known)]
    code = code_of(root)
    changed = [part for part in CODE if code.get(part) != measured.get("code", {}).get(part)]
    if quotes and measured and changed:
        found.append(
            f"{FILE}: measured at {measured['commit']}, {measured['date']}; the tick's code has changed since, in "
            f"{', '.join(changed)}: deploy/measure, or deploy/measure --accept WHY where that moves no figure")
    return found
