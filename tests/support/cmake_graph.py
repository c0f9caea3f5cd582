"""What CMake knows of a configured tree: which target links which, how, and from which files it is made. One reader for
the checks that look at the walls between rooms."""
import json
import pathlib
import re
import subprocess
import tempfile

VISIBILITY = {None: "PUBLIC", "dashed": "INTERFACE", "dotted": "PRIVATE"}  # the styles of cmake --graphviz


class CMakeGraph:
    """links: target -> {target that it names in target_link_libraries: PUBLIC, PRIVATE or INTERFACE}, external ones too.
    sources: target -> its files below the source tree, relative to it. kinds: target -> STATIC_LIBRARY, EXECUTABLE, ...
    """

    def __init__(self, build):
        self.build = pathlib.Path(build).resolve()
        query = self.build / ".cmake/api/v1/query/client-rooms"
        query.mkdir(parents=True, exist_ok=True)
        (query / "codemodel-v2").touch()
        with tempfile.TemporaryDirectory() as folder:
            graph = pathlib.Path(folder) / "graph.dot"
            # It configures the tree, too, and so answers the query.
            subprocess.run(["cmake", f"--graphviz={graph}", str(self.build)], check=True, capture_output=True, text=True)
            self._read_links(graph.read_text())
        self._read_targets()

    def _read_links(self, text):
        names = dict(re.findall(r'"(node\d+)" \[ label = "([^"\\]+)', text))
        self.links = {name: {} for name in names.values()}
        for user, used, style in re.findall(r'"(node\d+)" -> "(node\d+)"\s*(?:\[ style = (\w+) \])?', text):
            self.links[names[user]][names[used]] = VISIBILITY[style or None]

    def _read_targets(self):
        replies = self.build / ".cmake/api/v1/reply"
        index = json.loads(max(replies.glob("index-*.json")).read_text())
        answer = index["reply"]["client-rooms"]["codemodel-v2"]
        model = json.loads((replies / answer["jsonFile"]).read_text())
        self.root = pathlib.Path(model["paths"]["source"])
        self.sources, self.kinds = {}, {}
        for entry in model["configurations"][0]["targets"]:
            target = json.loads((replies / entry["jsonFile"]).read_text())
            files = (self.root / source["path"] for source in target.get("sources", ()) if not source.get("isGenerated"))
            self.sources[target["name"]] = [str(file.relative_to(self.root)) for file in files
                                            if file.is_relative_to(self.root) and not file.is_relative_to(self.build)]
            self.kinds[target["name"]] = target["type"]

    def linked_by(self, target):
        """The target and everything that it links, directly or not."""
        found, todo = set(), [target]
        while todo:
            name = todo.pop()
            if name not in found:
                found.add(name)
                todo += self.links.get(name, ())
        return found
