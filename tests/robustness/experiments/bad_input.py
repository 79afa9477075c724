"""Every bad input by name, through the program itself: exit status 2 and one line with file, line, field, value and rule, within seconds
and a gigabyte, and nothing left behind. Truth: the contract in README. The sound files that the bad ones are made of are accepted."""
import concurrent.futures
import os
import pathlib
import random
import subprocess
import tempfile
import threading
import unittest

import bad_case
import bad_characters
import bad_records
import bad_scenes_and_files
import bad_surfaces
import bad_tets
import foreign_arm
import reliability
import tet_texts

COMMON = {"arm.vtu": tet_texts.vtu(bad_tets.POINTS, bad_tets.TETS), "arm.skeleton.toml": foreign_arm.SKELETON,
          "arm.toml": bad_characters.SCENE, "clip.toml": bad_scenes_and_files.CLIP_SCENE, "good.bvh": bad_scenes_and_files.COMMON_CLIP}
TABLES = (bad_tets, bad_surfaces, bad_characters, bad_scenes_and_files, bad_records)


def accepted(name, files, command, *says):
    return bad_case.Case(name, files, command, says, status=0, leaves=("out",))


def turned(tets):
    return [[tets[0][1], tets[0][0], *tets[0][2:]], *tets[1:]]


def two_parts():
    points = [*bad_tets.POINTS, *[(x + 3.0, y, z) for x, y, z in bad_tets.POINTS]]
    return points, [*bad_tets.TETS, *[[vertex + len(bad_tets.POINTS) for vertex in tet] for tet in bad_tets.TETS]]


def told():
    """Accepted, and said so."""
    points, tets = bad_tets.POINTS, bad_tets.TETS
    measured, run = ["measure", "x.vtu", "x.vtu"], ["run", "arm.toml", "-o", "out", "--set", "character.mesh=x.vtu"]
    for verb in (measured, run):
        yield accepted(f"turned tet, {verb[0]}", {"x.vtu": tet_texts.vtu(points, turned(tets))}, verb,
                       "warning: x.vtu: inverted tets = 1: turned")
    yield accepted("two parts", {"x.vtu": tet_texts.vtu(*two_parts())}, measured, "warning: x.vtu: parts = 2: kept")
    yield accepted("1,700 m", {"x.vtu": tet_texts.vtu([[1700.0 * x for x in point] for point in points], tets)}, measured,
                   "warning: x.vtu: extent [m] = 1700: taken as it is")


READ_WHILE_THEY_CHANGE = {"x.vtu": (COMMON["arm.vtu"], ["measure", "x.vtu", "x.vtu"]),
                          "x.obj": (bad_surfaces.obj(200 * bad_surfaces.POINTS, bad_surfaces.FACES[:3]),
                                    ["mesh", "x.obj", "-o", "tets.vtu"]),
                          "x.bvh": (COMMON["good.bvh"], ["run", "clip.toml", "-o", "out", "--set", "motion.clip=x.bvh"]),
                          "x.toml": (COMMON["arm.toml"], ["run", "x.toml", "-o", "out"])}


def shrink_and_grow(path, text, stop, chance):
    while not stop.is_set():
        path.write_text(text[: chance.randrange(len(text))])
        stop.wait(1e-3 * chance.random())
        path.write_text(text)
        stop.wait(1e-3 * chance.random())


class BadInput(unittest.TestCase):
    def run_all(self, cases):
        with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
            wrong = [problem for found in pool.map(lambda case: bad_case.problems(case, COMMON), cases) for problem in found]
        self.assertEqual(wrong, [], "\n" + "\n".join(wrong))

    def test_each_is_refused(self):
        cases = [case for table in TABLES for case in table.cases() if not case.as_nobody or bad_case.nobody_can_run_it()]
        self.assertEqual(len({case.name for case in cases}), len(cases))
        self.run_all(cases)
        reliability.tell("bad_input", "bad inputs refused: exit status 2, file and reason named, within 5 s and 1 GiB, nothing left behind",
                         len(cases), len(cases))

    def test_what_is_accepted_with_a_treatment_is_told(self):
        self.run_all(list(told()))

    def test_a_file_that_shrinks_while_it_is_read(self):
        """Whole or refused by its name, whatever the moment."""
        chance = random.Random(2014)
        for name, (text, command) in READ_WHILE_THEY_CHANGE.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as temporary:
                folder, stop = pathlib.Path(temporary), threading.Event()
                bad_case.make(folder, COMMON | {name: text})
                disturber = threading.Thread(target=shrink_and_grow, args=(folder / name, text, stop, chance))
                disturber.start()
                try:
                    for _ in range(4):
                        process = subprocess.run([bad_case.PBSKIN, *command], cwd=folder, capture_output=True, text=True, timeout=60)
                        self.assertIn(process.returncode, (0, 2), process.stderr)
                        self.assertTrue(process.returncode == 0 or name in process.stderr, process.stderr)
                finally:
                    stop.set()
                    disturber.join()


if __name__ == "__main__":
    bad_case.limit_address_space()
    unittest.main()
