"""The records of `pbskin check`, read by Python's own parsers."""
import csv
import json
import os
import xml.etree.ElementTree as ElementTree

import program


def cases(path):
    """The test cases of a JUnit report, by classname and name."""
    found = {}
    for case in ElementTree.parse(path).getroot().iter("testcase"):
        key = case.get("classname"), case.get("name")
        assert key not in found, key
        found[key] = case
    return found


def failed(path):
    """Classname and name of each case with a <failure> or an <error>."""
    return {key for key, case in cases(path).items() if case.find("failure") is not None or case.find("error") is not None}


def scenes_of_another_mesh(folder):
    """The scenes of a check's folder whose counts of vertices and tets differ from the project's baseline, as with another version of
    CGAL."""
    with open(os.path.join(program.SOURCE, "experiments", "verdicts", "check", "check_baseline.csv"), encoding="utf-8", newline="") as file:
        baseline = {row["scene"]: (int(row["vertices"]), int(row["tets"])) for row in csv.DictReader(file)}
    others = set()
    for scene, counts in baseline.items():
        with open(os.path.join(folder, scene, "run.json"), encoding="utf-8") as file:
            character = json.load(file)["character"]
        if (character["vertices"], character["tets"]) != counts:
            others.add(scene)
    return others


def baselines_of(scenes, path):
    """The cases of a JUnit report that compare one of the scenes with the baseline."""
    return {(scene, name) for scene, name in cases(path) if scene in scenes and name.startswith("baseline of ")}
