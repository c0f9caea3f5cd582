"""Where the tests of the Python module find things; CMake says it in the environment."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

BIN = pathlib.Path(os.environ["BONEMILL_BIN"])
SOURCE = pathlib.Path(os.environ["BONEMILL_SOURCE"])
TESTS = BIN.parent / "tests"
SCENES = SOURCE / "deploy" / "scenes"

BLOCK = """name: "block"
volume { path: "block.nrrd" }
tool { name: "2 mm" shape { sphere { radius_mm: 1 } } burr_radius_mm: 1 }
tool { name: "4 mm" shape { sphere { radius_mm: 2 } } burr_radius_mm: 2 }
effects { time_removal { } }
"""
TASK = """assessment {
  zone { name: "cavity" role: TARGET shape { cylinder { from_mm { z: -0.75 } to_mm { z: 1.25 } radius_mm: 1 } } }
}
simulated_operator { waypoint { time_s: 0 p_WT_mm { z: 3 } q_WT { w: 1 } } }
"""


def run(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=250)


def without_memory(code):
    """Runs this, which says what sim, begin() and step() are, in a process of its own; begin() gets no memory of 64 kB or
    more, for which the C library asks the system each time."""
    return subprocess.run([sys.executable, "-c", f"""
import bonemill, resource
{code}
step()
resource.setrlimit(resource.RLIMIT_AS, (1, resource.RLIM_INFINITY))
try:
    begin()
except MemoryError:
    print("MemoryError", flush=True)
resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
try:
    step()
except bonemill.Error as error:
    print(error, flush=True)
begin()
step()
print("begun")
"""], capture_output=True, text=True, timeout=250, env=os.environ | {"MALLOC_MMAP_THRESHOLD_": "65536"})


class Folder(unittest.TestCase):
    """Each test has a folder with a scene: a plate whose upper face is z = 1.25 mm."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        made = run(BIN / "make_phantom", "body", "--kind", "slab", "--voxel-mm", "0.125", "--dims", "40", "40", "40",
                   "--thickness-mm", "2.5", "--out", self.folder / "block.nrrd")
        self.assertEqual(made.returncode, 0, made.stderr)

    def scene(self, text=BLOCK):
        path = self.folder / "block.textproto"
        path.write_text(text)
        return path
