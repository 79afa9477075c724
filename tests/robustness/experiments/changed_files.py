"""Random changes to a file of every kind that the program reads except rigs, which changed_rigs.py changes: 28 with
fixed seeds and 1,000 in ./check --long. Each ends in time: refused with the file and a rule, or with a sound result.
Sound: every number is finite; a frame has the volume that its points give to the rest mesh's tets; tets hold the volume
that their surface encloses within a factor of two; and what is written in another dialect has the result of the
original."""
import os
import random
import re
import unittest

import numpy

import bad_case
import mesh_texts
import program
import sound_files
import written_frames

LEAST_SHARE_READ = 0.2  # of the changes; most others break a rule of the format
MOST_PROCESSOR_S = 60.0
ROUNDED_PCT = 1e-4  # single precision in a file with binary or short numbers
WORDS = ["nan", "inf", "-inf", "1e999", "1.#QNAN", "1,5", "2.9D-01", "--1", "1.5.2", "0x10", "9" * 30, "", "abc", "-1",
         "0", "1e30", "1e-30"]
NUMBER = re.compile(rb"(?<![\w.#])-?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.])")


def spaced(text, by):
    return re.sub(rb"(\d) (?=[-\d])", rb"\1" + by, text)


DIALECTS = {
    "byte-order mark": lambda text, _: b"\xef\xbb\xbf" + text,
    "CR LF": lambda text, _: text.replace(b"\n", b"\r\n"),
    "tabs": lambda text, _: spaced(text, b"\t"),
    "two spaces": lambda text, _: spaced(text, b"  "),
    "empty lines at the end": lambda text, _: text + b"\n\n",
}


def change_number(text, choices):
    numbers = list(NUMBER.finditer(text))
    if not numbers:
        return text
    found = choices.choice(numbers)
    number = float(found[0])
    others = [str(int(number) + choices.choice((-1, 1))), repr(number * 10 ** choices.uniform(-4, 4)), repr(-number),
              *WORDS]
    return text[:found.start()] + choices.choice(others).encode() + text[found.end():]


def change_lines(text, choices):
    lines = text.splitlines(keepends=True)
    at, other = choices.randrange(len(lines)), choices.randrange(len(lines))
    kind = choices.choice(("drop", "double", "swap", "indent", "comment"))
    if kind == "swap":
        lines[at], lines[other] = lines[other], lines[at]
    else:
        lines[at:at + 1] = {"drop": [], "double": [lines[at]] * 2, "indent": [b" \t" + lines[at]],
                            "comment": [b"# a remark\n", lines[at]]}[kind]
    return b"".join(lines)


def change_bytes(text, choices):
    if not text:  # an earlier change left nothing
        return text
    at, length = choices.randrange(len(text)), choices.choice((1, 1, 4, 40))
    kind = choices.choice(("flip", "cut", "insert", "end"))
    if kind == "end":
        return text[:at]
    new = {"cut": b"", "flip": bytes(choices.randrange(256) for _ in range(length)),
           "insert": bytes([choices.randrange(256)])}[kind]
    return text[:at] + new + text[at + (0 if kind == "insert" else length):]


TEXT_CHANGES = {"number": change_number, "lines": change_lines, "bytes": change_bytes}
POINT_CHANGES = {
    "moved": lambda points, r: points + [[r.gauss(0, 0.05) for _ in range(3)] for _ in points],
    "one far": lambda points, r: numpy.vstack([points[:-1], points[-1:] * 10 ** r.uniform(0, 12)]),
    "scaled": lambda points, r: points * 10 ** r.uniform(-6, 6),
    "mirrored": lambda points, r: points * [-1, 1, 1],
    "away": lambda points, r: points + 10 ** r.uniform(0, 8),
    "flat": lambda points, r: points * [1, 1, 0],
    "two at a place": lambda points, r: numpy.vstack([points[:-1], points[:1]]),
}


def volume(points, tets):
    a, b, c, d = (points[tets[:, corner]] for corner in range(4))
    return numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a).sum() / 6


def enclosed(points, triangles):
    points = points - points[0]  # far from the origin the products would lose all digits
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    return numpy.einsum("ij,ij->i", numpy.cross(a, b), c).sum() / 6


class Kind:
    """A kind of file: its sound content, and the command that reads it."""

    def __init__(self, name, extension, command, points=None):
        self.name, self.extension, self.command, self.points = name, extension, command, points
        write, arguments = sound_files.SOUND[name]
        self.write = lambda **other: write(**{**arguments, **other})

    @property
    def file(self):
        return "changed" + self.extension

    def content(self, **other):
        content = self.write(**other)
        return content if isinstance(content, bytes) else content.encode()


RUN = ["run", "{scene}", "-o", "out", "--set"]
MEASURE, MESH = ["measure", "arm.vtu", "{file}", "--csv", "out.csv"], ["mesh", "{file}", "-o", "out.vtu", "--vertices",
                                                                       "200"]
TETS = [Kind(name, name.split(" ")[0], MEASURE, numpy.array(sound_files.POINTS)) for name in mesh_texts.FORMATS]
SURFACES = [Kind(name, "." + name.split(".")[1].split(" ")[0], MESH, numpy.array(sound_files.CORNERS, dtype=float))
            for name in (*mesh_texts.SURFACES, "twenty triangles.glb")]
OTHERS = [Kind(name, extension, [*RUN, f"{key}={{file}}"]) for name, extension, key in (
    ("clip.bvh", ".bvh", "motion.clip"), ("clip.gltf", ".gltf", "motion.clip"), ("clip.glb", ".glb", "motion.clip"),
    ("skeleton", ".toml", "character.skeleton"), ("weights", ".csv", "skinning.weights"))]
SCENES = [Kind("scene", ".toml", ["run", "{file}", "-o", "out"])]
KINDS = [*TETS, *SURFACES, *OTHERS, *SCENES]
# One of each kind, and those that have the changes which the first ones lack.
SEEDS = range(1000) if os.environ.get("PBS_LONG") else [*range(len(KINDS)), 26, 48, 94, 115, 164]
CHANGES = {f"{kind} {name}" for kind, names in (("text", TEXT_CHANGES), ("dialect", DIALECTS),
                                                ("points", POINT_CHANGES)) for name in names}


class ChangedFiles(program.ProgramTest):
    def setUp(self):
        super().setUp()
        for name, text in sound_files.COMMON.items():
            self.write(name, text)
        self.results = {}  # of the sound files

    def changed(self, kind, choices):
        """The names of the changes, the content, and the points that it has, if they are known."""
        if kind.points is not None and kind.name not in (".zae", "twenty triangles.glb") and choices.random() < 0.35:
            name = choices.choice(sorted(POINT_CHANGES))
            points = POINT_CHANGES[name](kind.points, choices)
            return ["points " + name], kind.content(points=points.tolist()), points
        content = kind.content()
        if b"\0" not in content and choices.random() < 0.3:
            name = choices.choice(sorted(DIALECTS))
            return ["dialect " + name], DIALECTS[name](content, choices), None
        names = choices.sample(sorted(TEXT_CHANGES), choices.choice((1, 1, 2)))
        for name in names:
            content = TEXT_CHANGES[name](content, choices)
        return ["text " + name for name in names], content, None

    def answer(self, kind, content):
        """The finished process that reads the file, and the processor time that it took [s]."""
        for name in os.listdir(self.folder):
            if name.startswith("out"):
                program.subprocess.run(["rm", "-r", self.path(name)], check=True)
        with open(self.path(kind.file), "wb") as file:
            file.write(content)
        scene = "clip.toml" if kind.command[-1].startswith("motion") else "arm.toml"
        start_s = program.processor_s()
        process = program.run(*(word.format(file=kind.file, scene=scene) for word in kind.command), cwd=self.folder)
        return process, program.processor_s() - start_s

    def numbers(self, kind):
        """The numbers of the result that do not depend on the machine's speed."""
        if kind.command == MESH:
            return [written_frames.signed_volumes(written_frames.read(self.path("out.vtu"))).sum()]
        rows = self.rows("out.csv") if kind.command == MEASURE else self.rows("out", "metrics.csv")
        cells = [(column, cell) for row in rows for column, cell in row.items() if not column.endswith("_ms")]
        self.assertEqual([column for column, cell in cells if cell.lower().strip("-") in ("nan", "inf")], [])
        return [float(cell) for _, cell in cells if NUMBER.fullmatch(cell.encode())]

    def check_sound(self, kind, changes, points):
        numbers = self.numbers(kind)
        self.assertTrue(numpy.isfinite(numbers).all())
        if changes[0].startswith("dialect"):
            if kind.name not in self.results:
                self.answer(kind, kind.content())
                self.results[kind.name] = self.numbers(kind)
            self.assertEqual(numbers, self.results[kind.name])
        if points is not None and kind.command == MEASURE:
            tets = numpy.array(sound_files.TETS)
            rest = volume(kind.points, tets)
            self.assertAlmostEqual(float(self.rows("out.csv")[0]["volume_change_pct"]),
                                   100 * (volume(points, tets) - rest) / rest,
                                   delta=ROUNDED_PCT * max(1.0, abs(volume(points, tets) / rest)))
        if points is not None and kind.command == MESH:
            inside = abs(enclosed(points, numpy.array(sound_files.FACES)))
            self.assertTrue(0.5 * inside <= numbers[0] <= 2.0 * inside, (numbers, inside))

    def test_every_change_ends_in_a_sound_result_or_an_error_with_its_rule(self):
        read, seen = 0, set()
        for number in SEEDS:
            choices = random.Random(number)
            kind = KINDS[number % len(KINDS)]
            changes, content, points = self.changed(kind, choices)
            seen.update(changes)
            with self.subTest(number, kind=kind.name, changes=changes):
                process, taken_s = self.answer(kind, content)
                self.assertLess(taken_s, MOST_PROCESSOR_S)
                if process.returncode == 0:
                    read += 1
                    self.check_sound(kind, changes, points)
                else:
                    self.assertEqual(process.returncode, 2, process.stderr)
                    case = bad_case.Case(kind.name, {kind.file: content}, [kind.file], ())
                    self.assertEqual(list(bad_case.what_is_wrong_with(process.stderr, case, sound_files.COMMON)), [],
                                     process.stderr)
        self.assertEqual(seen, CHANGES)
        self.assertGreaterEqual(read, LEAST_SHARE_READ * len(SEEDS))


if __name__ == "__main__":
    unittest.main()
