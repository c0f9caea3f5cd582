"""What the handbook says out of the sources themselves: each field's meaning in the scene, and each program's --help."""

import json
import os
import pathlib
import re
import subprocess

FIELD = re.compile(r"(?:optional |repeated )?([\w.]+) (\w+) = \d+\b")
BLOCK = re.compile(r"(message|enum|oneof) (\w+) \{")


class Schema:
    """What the comments of proto/scene*.proto say, by message and field."""

    def __init__(self, folder):
        self.fields, self.said = {}, {}
        for file in sorted(folder.glob("scene*.proto")):
            self.read(file.read_text(encoding="utf-8").splitlines())

    def read(self, lines):
        inside, comment, these = [], [], ""
        for line in map(str.strip, lines):
            if line.startswith("//"):
                comment.append(line.lstrip("/ "))
                continue
            block, field = BLOCK.match(line), FIELD.match(line)
            opened = line.count("{") - line.count("}")
            if block and block.group(1) != "oneof":
                self.said[".".join([*filter(None, inside), block.group(2)])] = " ".join(comment)
                self.add([*inside, block.group(2)], FIELD.search(line, block.end()), "")  # a message in one line
            elif field:
                # What is said of "these" holds for the fields that follow without a word of their own.
                said = " ".join(comment) or these
                these = said if said.startswith("These ") else ""
                self.add(inside, field, said)
            else:
                these = ""
            inside += [block.group(2) if block and block.group(1) != "oneof" else ""] * opened
            del inside[len(inside) + min(opened, 0):]
            comment = []

    def add(self, inside, field, comment):
        if field:
            self.fields[(".".join(filter(None, inside)), field.group(2))] = (field.group(1), comment)

    def type_of(self, message, name):
        """A type's full name, as it is seen from within a message."""
        scopes = message.split(".")
        names = [".".join([*scopes[:depth], name]) for depth in range(len(scopes), -1, -1)]
        return next((full for full in names if full in self.said), name)

    def follow(self, path):
        """The message that a path of names leads to, and what is said of its last field."""
        message, comment = "Scene", ""
        for name in path.replace("[]", "").split("."):
            kind, comment = self.fields[(message, name)]
            message = self.type_of(message, kind)
        return message, comment

    def meaning(self, path):
        """Of a row of the table of fields, as `tool[].shape[].sphere.radius_mm`."""
        message, comment = self.follow(path)
        return (comment or self.said.get(message, "")).replace("|", "&#124;")

    def group(self, path):
        """The heading above a row: `tool`, or an effect of its own; what is said of it all."""
        names = path.split(".")[:-1]
        if not names:
            return "### The scene", ""
        group = ".".join(names[:2 if names[0] == "effects" else 1])
        message, comment = self.follow(group)
        return f"### `{group.replace('[]', '')}`", " ".join(filter(None, [self.said.get(message, ""), comment]))


def with_meanings(page, proto):
    """The page on scene files, its table of fields by message, with what the schema says of each."""
    schema, made, group = Schema(proto), [], None
    for line in page.splitlines():
        row = re.match(r"\| `([\w.\[\]]+)` \|.*\|.*\|.*\|$", line) if group is not None else None
        if line.startswith("| field | unit |"):
            head, group = f"{line} meaning |\n|---|---|---|---|---|", ""
            continue
        if row:
            if schema.group(row.group(1)) != group:
                group = schema.group(row.group(1))
                made += ["", group[0], "", *filter(None, [group[1]]), "", head]
            line += f" {schema.meaning(row.group(1))} |"
        if group is None or row:
            made.append(line)
    return "\n".join(made) + "\n"


def help_of(program, *words):
    """What a program says of itself, called by its name alone and by nobody in particular."""
    said = subprocess.run([program.name, *words, "--help"], executable=program, capture_output=True, text=True, timeout=60,
                          env={"PATH": os.environ["PATH"], "HOME": "/home/you", "LANG": "C.UTF-8"}, check=True)
    return said.stdout.rstrip()


def commands_in(text, name):
    """The words after which a program takes options of their own."""
    listed = text.partition("Subcommands:")[2] if name != "bonemill" else text
    return [word for word in re.findall(r"^  ([a-z][a-z-]*) ", listed, re.MULTILINE)]


def programs_page(programs):
    """--help of each program and of each of its commands."""
    made = ["# Options of every program {#options-of-every-program}", "", "What `--help` says, of this very build."]
    for program in programs:
        text = help_of(program)
        made += ["", f"## {program.name} {{#{program.name}}}", "", "```", text, "```"]
        for word in commands_in(text, program.name):
            made += ["", f"### {program.name} {word} {{#{program.name}-{word}}}", "", "```", help_of(program, word), "```"]
    return "\n".join(made) + "\n"


def listed_programs(binaries, launcher):
    names = ("haptic_server", "device_daemon", "render_client", "bonemill_lab", "make_phantom", "ares_emulator", "study")
    return [pathlib.Path(launcher), *(binaries / name for name in names if (binaries / name).exists())]


# Asks the module itself: (heading, signature or nothing, docstring) of all that it offers.
PYTHON = r"""
import inspect, json, bonemill, bonemill.demonstrations, bonemill.gym
def said(thing): return inspect.getdoc(thing) or ""
def entries(owner, prefix):
    for name, thing in sorted(vars(owner).items(), key=lambda entry: entry[0]):
        if name.startswith("_") or not said(thing): continue
        if isinstance(thing, property): yield 3, prefix + name, "", said(thing)
        elif callable(thing) or isinstance(thing, classmethod):
            thing = getattr(owner, name)
            try: signature = str(inspect.signature(thing)).replace("self, ", "").replace("(self)", "()")
            except (TypeError, ValueError): signature = None
            first, _, rest = said(thing).partition("\n")
            yield 3, prefix + name, signature or "", rest.strip() if signature is None else said(thing)
pages = []
for module in (bonemill, bonemill.gym, bonemill.demonstrations):
    pages.append((2, module.__name__, "", said(module)))
    for name in sorted(module.__all__):
        thing = getattr(module, name)
        if inspect.isclass(thing):
            pages.append((2, name, "", said(thing)))
            pages += entries(thing, name + ".")
        elif inspect.isroutine(thing):
            pages += [entry for entry in entries(type("one", (), {name: staticmethod(thing)}), "")]
print(json.dumps(pages))
"""


def python_page(package):
    """Every class and call of the Python module, by its own docstrings."""
    asked = subprocess.run(["/usr/bin/python3", "-c", PYTHON], capture_output=True, text=True, check=True, timeout=60,
                           env={"PATH": os.environ["PATH"], "PYTHONPATH": str(package)})
    made = ["# The Python module", "", "What its docstrings say. [How to use it](../howto/python.md)."]
    for depth, name, signature, said in json.loads(asked.stdout):
        made += ["", f"{'#' * depth} {name}", "", *([f"`{name}{signature}`", ""] if signature else []), *(["```", said, "```"] if said else [])]
    return "\n".join(made) + "\n"
