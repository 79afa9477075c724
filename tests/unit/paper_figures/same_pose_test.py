"""The picture of the README shows the records' numbers, and a run that disagrees with the records is refused. Reference: the kept
records."""
import csv
import math
import unittest

from results_case import ResultsTest
from readme import same_pose
from synthetic_records import write_table


def shown():
    with open(same_pose.picture.with_suffix(".csv"), newline="") as stream:
        return list(csv.DictReader(stream))


class SamePose(ResultsTest):
    def write_run(self, **changed):
        """The kept rows of LBS at the first pose as a run's metrics.csv, with these cells changed."""
        pose = same_pose.poses[0]
        row = {**same_pose.row_of(same_pose.kept_volume / pose.scene, pose, "lbs"), **changed}
        write_table(self.results / "metrics.csv", [row])
        return pose

    def test_each_deformer_is_shown_in_each_pose(self):
        self.assertEqual([(row["scene"], row["deformer"]) for row in shown()],
                         [(pose.scene, name) for pose in same_pose.poses for name in ("lbs", "dqs", "pbs", pose.reference)])

    def test_the_numbers_are_those_of_the_records(self):
        for row in shown():
            pose = next(pose for pose in same_pose.poses if pose.scene == row["scene"])
            self.assertEqual(float(row["angle_deg"]), pose.angle_deg)
            kept = same_pose.row_of(same_pose.kept_volume / pose.scene, pose, row["deformer"])
            for column in same_pose.compared:
                self.assertTrue(math.isclose(float(row[column]), kept.number(column), rel_tol=1e-5), (row, column))

    def test_a_run_that_agrees_with_the_records_is_accepted(self):
        pose = self.write_run()
        self.assertEqual(same_pose.checked_row(self.results, pose, "lbs")["deformer"], "lbs")

    def test_a_run_that_disagrees_is_refused(self):
        pose = self.write_run(volume_change_pct="-14.7")
        with self.refused("volume_change_pct of lbs = -14.7: expected -14.8"):
            same_pose.checked_row(self.results, pose, "lbs")


if __name__ == "__main__":
    unittest.main()
