"""./check builds and tests with the preset ci, and ./check is what continuous integration runs. Reference: the files
themselves."""
import json
import os
import pathlib
import re
import unittest

SOURCE = pathlib.Path(os.environ["PBS_SOURCE"])


def text(name):
    return (SOURCE / name).read_text(encoding="utf-8")


class Presets(unittest.TestCase):
    def setUp(self):
        presets = json.loads(text("CMakePresets.json"))
        self.steps = {flow["name"]: [(step["type"], step["name"]) for step in flow["steps"]]
                      for flow in presets["workflowPresets"]}
        self.configured = {preset["name"]: preset for preset in presets["configurePresets"]}
        self.built = {preset["name"]: preset for preset in presets["buildPresets"]}
        self.tested = {preset["name"] for preset in presets["testPresets"]}

    def test_check_configures_by_the_preset_of_the_workflow(self):
        self.assertEqual(self.steps["ci"], [("configure", "ci"), ("build", "ci"), ("test", "ci")])
        self.assertEqual(re.findall(r"configured cmake --preset (\S+)", text("check")), ["ci"])
        self.assertNotRegex(text("check"), r"--preset ci[^|]* -D")
        self.assertRegex(text(".ci/run"), r'(?m)^exec ".*/\.\./check" "\$@"$')

    def test_both_in_one_folder(self):
        """With the same flags, so that ./check compiles nothing again that ./reproduce has compiled."""
        self.assertEqual((self.configured["ci"]["inherits"], self.configured["ci"]["cacheVariables"]),
                         ("release", {"PBS_WITH_TESTS": "ON"}))
        folder = re.search(r"^build_folder=(\S+)$", text("cmake/setup.sh"), re.MULTILINE)[1]
        self.assertEqual(self.configured["ci"]["binaryDir"], "${sourceDir}/" + folder)

    def test_packages_are_for_any_machine(self):
        self.assertEqual(self.steps["package"][-1], ("package", "package"))
        self.assertEqual(self.configured["package"]["cacheVariables"]["PBS_NATIVE"], "OFF")

    def test_every_preset_is_built_by_its_name(self):
        visible = {name for name, preset in self.configured.items() if not preset.get("hidden")}
        self.assertEqual(set(self.built), visible)
        self.assertLessEqual(self.tested | set(re.findall(r"--preset (\w[\w-]*)", text("check"))), visible)

    def test_the_method_and_the_metrics_alone(self):
        """The presets tsan and valgrind leave out every option except the metrics, the tests and threads."""
        options = set(re.findall(r'option\((PBS_WITH_\w+) ".*" ON\)', text("CMakeLists.txt")))
        for name in ("tsan", "valgrind"):
            parent = self.configured[self.configured[name]["inherits"]]["cacheVariables"]
            self.assertEqual(set(parent), options - {"PBS_WITH_ANALYSIS", "PBS_WITH_TESTS", "PBS_WITH_THREADS"})
            self.assertEqual(set(parent.values()), {"OFF"})


if __name__ == "__main__":
    unittest.main()
