"""A trial of an invented rig, `pbskin try`, and what it wrote. The rigs are those of rig_files.py and block_rigs.py."""
import glob
import html
import json
import os
import re

import program
import rig_files
from written_frames import points_of

FRAMES, FAR_FROM_ARTIST_PCT = 3, 2.0  # above which the program warns, of the model's size
ROUNDED_M = 1.04 * 2.0 ** -24  # a coordinate of the tube in single precision, as in .glb files


def turned(degrees, joint=1):
    """Channels of an animation whose joint turns by this angle within a second."""
    return [(joint, "rotation", [0.0, 1.0], [rig_files.turn((0, 0, 1), angle) for angle in (0, degrees)], "LINEAR")]


class TrialTest(program.ProgramTest):
    def rig(self, variant="plain", **options):
        """One name for all, so that the cache has one mesh for those with the same surface."""
        return rig_files.write(variant, self.path("rig.glb"), **options)

    def tried(self, model, *arguments, into="out", without=("--no-reference",), vertices="300", frames=FRAMES,
              **environment):
        """try.json and what was printed. The page has a viewer, whose program does nothing."""
        self.write("viewer.js", "// a viewer")
        process = self.succeeds("try", model, "-o", self.path(into), "--frames", frames, "--vertices", vertices,
                                *without, *arguments, env={**os.environ, "PBS_VIEWER_BUILD": self.folder,
                                                           **environment})
        return self.json(into, "try.json"), process.stdout + process.stderr

    def refused(self, *arguments):
        return self.ends(2, *arguments).stderr

    def remarked(self, facts, printed, words, kind="warning"):
        """Once in the terminal, in run.json, in try.json and in the page, and only as this kind of remark."""
        self.assertEqual(len(re.findall(f"pbskin: {kind}: .*{re.escape(words)}", printed)), 1, printed)
        for recorded in (facts, self.json("out", "run.json")["outcome"]):
            counts = [sum(words in remark for remark in recorded[kinds]) for kinds in ("warnings", "notes")]
            self.assertEqual(counts, [1, 0] if kind == "warning" else [0, 1], recorded)
        for text in (printed, html.unescape(self.read("out", "report.html"))):
            self.assertEqual(text.count(words), 1, words)

    def points(self, *name):
        """Of the surfaces in these files, in the order of the frames."""
        return [points_of(file) for file in sorted(glob.glob(self.path("out", *name)))]

    def shown(self, folder="out"):
        """The run in the viewer of a page."""
        header = re.search(r'id="viewer-header">(.*?)</script>', self.read(folder, "report.html"))[1]
        return json.loads(header)["runs"][0]
