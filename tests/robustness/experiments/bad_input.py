"""Every bad input by name, through the program itself: exit status 2 and one line with file, line, field, value and
rule, within seconds and a gigabyte, with nothing left behind. Reference: the contract in
experiments/command_line/README.md. The valid files from which the bad ones are made are accepted."""
import unittest

import bad_case
import bad_inputs
import reliability

LEAST = 80
NOT_LINES = ["x.vtu: damaged", "pbskin: x.vtu: std::bad_alloc", "pbskin: x.vtu: ", "pbskin: other.vtu: no such file",
             "pbskin: x.vtu:12", "pbskin: x.vtu: assimp: ", "pbskin: cannot be read", "pbskin: x.vtu: k_volume = 1.4: ",
             "pbskin: x.vtu: k_volume = 1.4"]
LINES = ["pbskin: x.vtu: no such file", "pbskin: x.vtu:12: k_volume = 1.4: expected 0 <= k <= 1",
         "pbskin: --set: k = 1.4: expected a text", "pbskin: x.vtu:3:8: 8 fields: expected 7",
         "pbskin: x.vtu: schema: missing", "pbskin: x.vtu/run.json: the file is empty",
         "pbskin: reproduce = alchemy: unknown claim or study"]


class BadInput(unittest.TestCase):
    def expect_answers(self, cases):
        wrong = bad_inputs.wrong_answers(cases)
        self.assertEqual(wrong, [], "\n" + "\n".join(wrong))

    def test_each_is_refused(self):
        of_nobody = bad_case.nobody_can_run_it()
        every = bad_inputs.refused()
        cases = [case for case in every if of_nobody or not case.as_nobody]
        self.assertEqual(len({case.name for case in every}), len(every))
        self.assertGreaterEqual(len(cases), LEAST)
        self.expect_answers(cases)
        skipped = (f"{len(every) - len(cases)} skipped: nobody cannot run the program" if len(cases) < len(every)
                   else "none skipped")
        reliability.tell("bad_input", "bad inputs refused: exit status 2, file and rule named, within 5 s of processor "
                                      "time and 1 GiB a process, nothing left behind", len(cases), len(every),
                         note=skipped)

    def test_each_demands_a_rule(self):
        """The expected words of each case include a rule, and not only parts of the command line."""
        self.assertEqual([case.name for case in bad_inputs.refused() if not bad_case.demands_a_rule(case)], [])

    def test_the_form(self):
        for line in LINES:
            self.assertTrue(bad_case.is_well_formed(line, {"x.vtu"}), line)
        for line in NOT_LINES:
            self.assertFalse(bad_case.is_well_formed(line, {"x.vtu"}), line)

    def test_what_is_sound_is_accepted_and_what_is_treated_is_told(self):
        self.assertGreaterEqual(len(bad_inputs.accepted()), 30)
        self.expect_answers(bad_inputs.accepted())


if __name__ == "__main__":
    bad_case.limit_address_space()
    unittest.main()
