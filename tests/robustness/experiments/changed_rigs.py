"""Random changes to the rigs of rig_files.py, 24 with fixed seeds and 1,000 in ./check --long. Each ends in time:
refused with the file and a rule, or tried with a sound result. Sound: every number of the tables is finite, the
artist's surface is that of the format's formula (skin_formula.py), and flesh that does not follow it has a warning."""
import math
import os
import random
import re
import unittest

import numpy

import program
import rig_files
import skin_formula
from written_frames import points_of

# 28, 35, 37, 40 and 45 have the changes that the others lack; 5, 19 and 20 repeat those of others. The open surfaces of
# 6, 16, 17 and 56 take 9 to 21 s each; meshing_ends.py has one. At seeds 16 and 56, Mesh_3 is asked to insert a point
# twice.
SEEDS = range(1000) if os.environ.get("PBS_LONG") else [*range(5), *range(7, 16), 18, *range(21, 25), 28, 35, 37, 40,
                                                        45]
CLOSED_SOUND = {1, 3, 7, 10, 11, 14, 15, 18, 21, 22, 23}  # with CGAL 5.5.1 and 6.0.1
NUMBERED = re.compile(r"animation \d+")  # the name of an animation without one
FAR_FROM_ARTIST_PCT = 2.0
MOST_PROCESSOR_S = 60.0  # which other work stretches less than the wall time; run() has a limit on that
NAMES = ["", " ", "a/b", "..", "%s", "\n", "Ωmega", "x" * 5000, "elbow", 'say "so"', "[0]", "null"]


class Rig:
    """A glTF document and its numbers, to be changed by random choices."""

    def __init__(self, choices, variant):
        self.random = choices
        self.document, self.data = rig_files.rig(**rig_files.VARIANTS[variant])
        self.primitive = self.document["meshes"][0]["primitives"][0]

    def change(self, accessor, width, change):
        """Replaces the numbers of an accessor, #elements x width, by what `change` makes of them."""
        of = self.document["accessors"][accessor]
        begin, kind = self.document["bufferViews"][of["bufferView"]].get("byteOffset", 0), skin_formula.TYPES[
            of["componentType"]]
        count = of["count"] * skin_formula.COMPONENTS[of["type"]]
        numbers = numpy.frombuffer(bytes(self.data), kind, count, begin).reshape(-1, width).astype(float)
        with numpy.errstate(all="ignore"):
            changed = numpy.asarray(change(numbers)).astype(kind).tobytes()
        self.data[begin:begin + len(changed)] = changed

    def put(self, numbers, shares, value):
        """Gives a random share of the rows the value that is made of them."""
        share = self.random.choice(shares)
        rows = numpy.array([self.random.random() < share for _ in numbers], dtype=bool)
        numbers[rows] = value(numbers[rows])
        return numbers

    def node(self):
        return self.random.choice(self.document["nodes"])

    def factor(self):
        return 10.0 ** self.random.uniform(-4, 4) * self.random.choice((1, 1, 1, -1))

    def normal(self, count):
        return [self.random.gauss(0, 1) for _ in range(count)]

    def sampler(self):
        return self.random.choice(self.random.choice(self.document["animations"])["samplers"])

    def move_child(self):
        child = self.random.randrange(len(self.document["nodes"]))
        for node in self.document["nodes"]:
            node["children"] = [other for other in node.get("children", []) if other != child]
        self.node()["children"].append(child)
        for node in self.document["nodes"]:
            if not node["children"]:
                del node["children"]

    def change_of(self, name, change, width=3):
        """Of an attribute of the mesh, or of its indices."""
        self.change(self.primitive["attributes"].get(name, self.primitive["indices"]), width, change)

    def put_in(self, name, shares, value):
        self.change_of(name, lambda numbers: self.put(numbers, shares, value))

    def change_unit(self):
        factor = abs(self.factor())
        self.change_of("POSITION", lambda points: factor * points)
        self.change(self.document["skins"][0]["inverseBindMatrices"], 16,
                    lambda bind: bind * ([1] * 12 + [factor] * 3 + [1]))
        for node in self.document["nodes"]:
            if "translation" in node:
                node["translation"] = [factor * x for x in node["translation"]]


CHANGE = {
    "name": lambda r: r.random.choice([*r.document["nodes"],
                                       *r.document["meshes"]]).update(name=r.random.choice(NAMES)),
    "name of an animation": lambda r: r.document["animations"][0].update(name=r.random.choice(NAMES)),
    "scale": lambda r: r.node().update(scale=[r.factor()] * 3),
    "scales": lambda r: r.node().update(scale=[r.factor() for _ in range(3)]),
    "place": lambda r: r.node().update(translation=[r.factor() * x for x in r.normal(3)]),
    "turn": lambda r: r.node().update(rotation=r.normal(4)),
    "matrix and its parts": lambda r: r.node().update(matrix=r.normal(16)),
    "parent": Rig.move_child,
    "joint": lambda r: r.document["skins"][0]["joints"].append(r.random.randrange(len(r.document["nodes"]) + 1)),
    "unit": Rig.change_unit,
    "weights": lambda r: r.change_of("WEIGHTS_0", lambda w: r.put(w, (0.01, 0.3, 1.0), lambda _: r.random.choice(
        (0, 1, r.factor(), math.nan))), 4),
    "bones of weights": lambda r: r.change_of("WEIGHTS_0", lambda w: w[:, r.random.sample(range(4), 4)], 4),
    "small holes": lambda r: r.put_in("indices", (0.003, 0.05, 0.4, 0.99), lambda t: t[:, :1]),
    "large hole": lambda r: r.change_of("indices",
                                        lambda t: numpy.repeat(t[:1], len(t), axis=0) if r.random.random() < 0.1 else
                                        numpy.where(numpy.arange(len(t))[:, None] < len(t) / 3, t[:, :1], t)),
    "orientation": lambda r: r.put_in("indices", (0.01, 0.5, 1.0), lambda t: t[:, ::-1]),
    "corners": lambda r: r.put_in("indices", (0.002, 0.1), lambda t: t + r.random.randrange(-3, 20)),
    "some points": lambda r: r.put_in("POSITION", (0.005, 0.1),
                                      lambda p: p + r.factor() * numpy.reshape(r.normal(p.size), p.shape)),
    "rough points": lambda r: r.change_of("POSITION",
                                          lambda p: p + r.random.choice((0.001, 0.02)) * numpy.reshape(r.normal(p.size),
                                                                                                      p.shape)),
    "endless points": lambda r: r.put_in("POSITION", (0.005,), lambda _: r.random.choice((math.inf, math.nan))),
    "flat": lambda r: r.change_of("POSITION", lambda p: p * [1, 1, r.random.choice((0.0, 0.01, -1.0))]),
    "times": lambda r: r.change(r.sampler()["input"], 1,
                                r.random.choice((lambda t: t[::-1], lambda t: 0 * t, lambda t: t - 5,
                                                lambda t: 1e6 * t, lambda t: t * math.nan))),
    "turns": lambda r: r.change(r.sampler()["output"], 1, lambda turns: turns * r.random.choice((0.0, -1.0, 3.0))),
}


class ChangedRigs(program.ProgramTest):
    def changed(self, number):
        """The names of the changes to a rig, which is written."""
        choices = random.Random(number)
        rig = Rig(choices, choices.choice(sorted(name for name in rig_files.VARIANTS if name != "no_animation")))
        kinds = choices.sample(sorted(CHANGE), choices.choice((1, 1, 2, 3)))
        for kind in kinds:
            CHANGE[kind](rig)
        rig_files.write_glb(self.path("rig.glb"), rig.document, rig.data)
        return ", ".join(kinds)

    def check_sound(self, changes_times):
        """changes_times: keys may be at the same time, so that the formula has several values."""
        facts = self.json("out", "try.json")
        for row in self.rows("out", "metrics.csv"):
            self.assertEqual([column for column, cell in row.items() if cell.lower().strip("-") in ("nan", "inf")], [])
        self.assertTrue(os.path.exists(self.path("out", "report.html")))
        followed = facts["from_artist"]
        if followed and followed["largest_pct"] > FAR_FROM_ARTIST_PCT:
            self.assertTrue(any("away from the artist's" in warning for warning in facts["warnings"]), facts)
        model, name = skin_formula.Model(self.path("rig.glb")), re.search('animation = "(.*)"',
                                                                          self.read("out", "scene.toml"))
        if name and "\\" not in name[1] and not changes_times:
            with numpy.errstate(all="ignore"):
                expected = model.points(NUMBERED.sub("", name[1]), facts["motion"]["time_zero_s"])
            known = numpy.isfinite(expected).all(axis=1)  # points without weight are left to the program
            found = points_of(self.path("out", "skin", "artist_000000.vtp"))
            self.assertLessEqual(abs(found - expected)[known].max(), skin_formula.ROUNDED * abs(expected[known]).max())

    def test_every_change_ends_in_a_sound_result_or_an_error_with_its_rule(self):
        sound, seen = [], set()
        for number in SEEDS:
            changes = self.changed(number)
            seen.update(changes.split(", "))
            with self.subTest(number, changes=changes):
                start_s = program.processor_s()
                process = program.run("try", self.path("rig.glb"), "-o", self.path("out"), "--no-reference", "--frames",
                                      2, "--vertices", "300", cwd=self.folder)
                self.assertLess(program.processor_s() - start_s, MOST_PROCESSOR_S)
                self.assertLessEqual(set(os.listdir(self.folder)), {"rig.glb", "out"})
                if process.returncode == 0:
                    self.check_sound("times" in changes.split(", "))
                    sound.append(number)
                else:
                    self.assertEqual(process.returncode, 2, process.stderr)
                    self.assertRegex(process.stderr.splitlines()[-1], r"^pbskin: .*rig\.glb\b.*: .")
        self.assertEqual(seen, set(CHANGE))
        self.assertLessEqual(CLOSED_SOUND, set(sound))
        self.assertLess(program.most_memory_bytes(), program.MOST_BYTES)


if __name__ == "__main__":
    unittest.main()
