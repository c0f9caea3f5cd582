"""Makes the pages of docs/ ready for mkdocs, which reads another Markdown than repositories show: a list needs an empty
line before it and four columns within it, a heading's anchor is said, and a link out of docs/ leads to a copy or nowhere.
"""

import os
import pathlib
import re
import shutil

LINK = re.compile(r"(!?)\[([^]]*)\]\(([^)\s#]*)(#[^)\s]*)?\)")
LIST_ITEM = re.compile(r"\s*([-*+]|\d+\.)\s")
MARK = re.compile(r"<!--.*?-->\n?")


def anchor_of(heading):
    """As tests/support/check_docs and the repository's page have it."""
    text = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading.strip().rstrip("#").strip())
    return re.sub(r"\s", "-", re.sub(r"[^\w\s-]", "", text.lower()))


class Staging:
    """Copies pages, and what they show, from a checkout into a folder."""

    def __init__(self, root, out):
        self.root, self.out = root, out
        self.pages = {path: path.removeprefix("docs/") for path in self.sources()} | {"CONTRIBUTING.md": "develop/contributing.md"}

    def sources(self):
        return [path.relative_to(self.root).as_posix() for path in sorted((self.root / "docs").rglob("*.md"))]

    def copy_all(self):
        for source, page in self.pages.items():
            self.write(page, self.ready(source, page))

    def write(self, page, text):
        path = self.out / page
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def ready(self, source, page):
        text = MARK.sub("", (self.root / source).read_text(encoding="utf-8"))
        return "\n".join(spaced(LINK.sub(lambda link: self.lead(link, source, page), text).splitlines())) + "\n"

    def lead(self, link, source, page):
        """The link as it is in the handbook."""
        picture, words, target, anchor = link.group(1), link.group(2), link.group(3), link.group(4) or ""
        if re.match(r"[a-z]+:", target) or not target:
            return link.group(0)
        aim = os.path.normpath(os.path.join(os.path.dirname(source), target))
        if aim in self.pages:
            aim = self.pages[aim]
        elif aim.endswith((".png", ".jpg", ".gif", ".csv", ".json")):
            aim = self.copy(aim)
        else:
            return f"`{aim}`"  # a source, which the handbook does not bring
        if words == pathlib.PurePosixPath(target).name:
            words = self.title_of(target, source) or words  # a file's name says little to who reads no files
        return f"{picture}[{words}]({os.path.relpath(aim, os.path.dirname(page) or '.')}{anchor})"

    def title_of(self, target, source):
        first = re.match(r"# (.+)", (self.root / source).parent.joinpath(target).read_text(encoding="utf-8"))
        return first and first.group(1)

    def copy(self, file):
        place = file.removeprefix("docs/") if file.startswith("docs/") else "images/" + pathlib.PurePosixPath(file).name
        (self.out / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(self.root / file, self.out / place)
        return place


def spaced(lines):
    """The lines with what mkdocs wants around and within lists, and at headings."""
    made, fenced, in_list = [], False, False
    for line in lines:
        before = made[-1] if made else ""
        if line.lstrip().startswith("```"):
            fenced = not fenced
            line = re.sub(r"^(```\w*).*", r"\1", line)
        elif fenced:
            pass
        elif re.match(r"#+ ", line):
            line, in_list = f"{line} {{#{anchor_of(line.lstrip('#'))}}}", False
        elif LIST_ITEM.match(line):
            if before.strip() and not in_list:
                made.append("")
            in_list, line = True, indented(line)
        elif in_list and line.startswith("  "):
            line = indented(line)
        elif line and not before.strip():
            in_list = False
        made.append(line)
    return made


def indented(line):
    """Two or three columns are one level of a list, four to six are two."""
    columns = len(line) - len(line.lstrip(" "))
    return " " * (4 * ((columns + 2) // 4 if columns > 3 else columns > 1)) + line.lstrip(" ")
