"""Which methods are nearest to the references for a time per frame: sentences and cells from the tables of the study
work_precision. The figures, the README, the study's page and the report all have theirs from here.

    compared = compared_methods.Compared(results / "work_precision")
    " ".join(compared.answers())                       # Within 0.1 ms per frame, DQS leaves 86 % of LBS's error (...
    compared_methods.cell(compared.row("known", 1.0, "vbd"))   # 33 [33, 48] ab

A share is the error at the joints over that of LBS: the median over the reference variants, with the range over them.
In the table `known`, methods that take flesh are given that of each reference; in `guessed`, they have the same flesh
whatever the reference is.
"""
import math

import records
from words import case_words, looks
from words.number_words import figure

method_columns = {"table", "budget_ms", "method", "takes", "setting", "ms", "times_pbs", "within", "poses",
                  "fewest_poses", "share", "share_low", "share_high", "fold_share", "skin_mm", "letters"}
significance = 0.05   # of an adjusted p, as in analysis/statistics/paired_comparison.hpp
most_names = 4        # in a list that is read aloud
familiar = ("pbs", "delta_mush", "lbs")  # the sentence always states how the nearest method compares with these
most_exceptions = 2    # that are named; more of them are counted
played_ms = 1.0       # the time for which the sentence has the methods along a clip
# Within the time with twice its own, only just, or not on this machine.
marks = {"doubled": "", "once": "\u2020", "no": "\u2021"}
legend = ("Neither of two methods that share a letter is decided to be nearer. \u2020: not within the time if the "
          "machine is half as fast; \u2021: not within it on this machine.")


def name(method):
    return looks.of(method).name


def named(methods):
    """A, B and C; of a longer list the first ones and how many more there are."""
    first = [name(method) for method in methods[:most_names]]
    rest = [f"{len(methods) - most_names} more"] if len(methods) > most_names else []
    return conjoined(first + rest, "and")


def conjoined(words, conjunction):
    """A, B and C."""
    return f" {conjunction} ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def percent(share):
    return figure(round(100 * float(share)))


def millimetres(value):
    """Two digits, as in 9.4 mm and 12 mm."""
    return f"{float(value):.{0 if float(value) >= 9.95 else 1}f}"


def assumed(members):
    """bones hold the flesh as rigid capsules or the flesh is nearly incompressible: what these reference variants
    assume."""
    return conjoined([case_words.of_field("member", member) for member in members], "or")


def is_own(row):
    """A deformer of the user's own has no setting and no look."""
    return not row["setting"] and row["method"] not in looks.listed


def time_name(ms):
    """10 ms; a budget of inf has the row of each deformer of the user's own that needs more than the longest time."""
    return "any time" if math.isinf(ms) else f"{ms:g} ms"


def taken(row):
    """What a method is given of the reference. A deformer of the user's own does not state it."""
    if is_own(row):
        return "not stated"
    return ", ".join(case_words.of_field("takes", word) for word in row["takes"].split()) or "nothing"


def is_learned(row):
    """It takes nothing while it runs, but it was trained before."""
    return row["takes"] == "learned"


def cell(row):
    """33 [33, 48] ab: the share, its range and the letters; nothing where a method needs more time."""
    return "" if row is None else (f"{percent(row['share'])} [{percent(row['share_low'])}, "
                                   f"{percent(row['share_high'])}] {row['letters']}{marks[row['within']]}")


def in_range(shares):
    """30 to 36 %"""
    return f"{' to '.join(dict.fromkeys(percent(share) for share in (min(shares), max(shares))))} %"


def in_range_of_counts(counts):
    """1 to 3 frames"""
    least, most = min(counts), max(counts)
    return f"{least} to {most} frames" if least != most else f"{most} frame{'s' if most != 1 else ''}"


class Compared:
    def __init__(self, folder):
        self.methods = records.table(folder / "methods.csv", method_columns)
        self.decisions, self.pairs = (records.read_rows(folder / f"{table}.csv") for table in ("decisions", "pairs"))
        self.motion = records.rows_if_any(folder / "motion.csv")  # the quick form has no clips
        self.columns_ms = sorted({float(row["budget_ms"]) for row in self.methods})  # of the tables; inf: any time
        self.times_ms = [ms for ms in self.columns_ms if not math.isinf(ms)]
        self.decided = {}  # (table, time): (first, second, decision) of all bodies
        for row in self.decisions:
            if not row["without_body"]:
                pair = tuple(str(row[column]) for column in ("first", "second", "decision"))
                self.decided.setdefault((row["table"], float(row["budget_ms"])), []).append(pair)

    def rows(self, table, ms):
        """The methods by their share, the least first."""
        return of_time(self.methods, table, ms)

    def row(self, table, ms, method):
        return next((row for row in self.rows(table, ms) if row["method"] == method), None)

    def ranked(self, table):
        """All methods of a table, by their share within the longest time."""
        return list(dict.fromkeys(row["method"] for ms in self.columns_ms[::-1] for row in self.rows(table, ms)))

    def table(self, table):
        """The cells of each method: its name, what it takes, and its share within each time."""
        for method in self.ranked(table):
            rows = [self.row(table, ms, method) for ms in self.columns_ms]
            yield [name(method), taken(next(filter(None, rows))), *map(cell, rows)]

    def against(self, table, ms, method):
        """{decision: other methods, by their share}. The decisions are level, nearer (this method is), farther, depends
        and open."""
        turned = {"first_is_nearer": ("nearer", "farther"), "second_is_nearer": ("farther", "nearer")}
        found = {}
        for first, second, decision in self.decided.get((table, ms), ()):
            if method in (first, second):
                found[first if method == second else second] = turned.get(decision, (decision,) * 2)[method == second]
        ranked = [row["method"] for row in self.rows(table, ms)]
        return {decision: [other for other in ranked if found.get(other) == decision]
                for decision in ("level", "nearer", "farther", "depends", "open")}

    def nearest(self, table, ms, takes_nothing=False):
        """The least share, unless another method is decided to be nearer. A method that misses the time on this machine
        is no answer. takes_nothing: among the methods that are given nothing of the reference."""
        rows = [row for row in self.rows(table, ms) if row["within"] != "no"
                and not (takes_nothing and taken(row) != "nothing")]
        beaten = {row["method"]: self.against(table, ms, row["method"])["farther"] for row in rows}
        return next((row for row in rows if not set(beaten[row["method"]]) & set(beaten)), rows[0] if rows else None)

    def where_nearer(self, table, ms, method, other):
        """The reference variants on which the first of the two is nearer."""
        found = []
        for row in of_time(self.pairs, table, ms):
            if {row["first"], row["second"]} == {method, other} and float(row["p_holm"]) < significance:
                wins, losses = int(row["wins"]), int(row["losses"])
                found += [row["member"]] if (wins > losses) == (row["first"] == method) else []
        return found

    def variants(self, table, ms, method, other):
        """The reference variants that compare the two."""
        return [row["member"] for row in of_time(self.pairs, table, ms)
                if {row["first"], row["second"]} == {method, other}]

    def familiar_ones(self, table, ms, method, with_exceptions=True):
        """nearer than PBS and LBS for 7 of 8 reference variants (not decided if the flesh is nearly incompressible)"""
        by_variants = {}
        for other in familiar:
            nearer, variants = self.where_nearer(table, ms, method, other), self.variants(table, ms, method, other)
            if nearer:
                without = [member for member in variants if member not in nearer]
                text = f" for {len(nearer)} of {len(variants)} reference variants" if without else ""
                if (with_exceptions and 0 < len(without) <= most_exceptions
                    and not self.where_nearer(table, ms, other, method)):
                    text += f", not decided if {assumed(without)}"
                by_variants.setdefault(text, []).append(other)
        return "; ".join(f"nearer than {named(others)}{text}" for text, others in by_variants.items())

    def conditions(self, table, ms, method, other):
        """bones hold the flesh as rigid capsules: what is assumed of the flesh where the first of the two is nearer."""
        return assumed(self.where_nearer(table, ms, method, other))

    # The sentences.

    def share_of_pbs(self):
        """How far PBS is from flesh, within the time of the middle column; nothing where it has no row."""
        ms = self.times_ms[len(self.times_ms) // 2]
        pbs, lbs = (self.row("known", ms, method) for method in ("pbs", "lbs"))
        if pbs is None:
            return ""
        shares = in_range([float(pbs[f"share_{end}"]) for end in ("low", "high")])
        return (f"Within {ms:g} ms, PBS leaves {shares} of the error of LBS at the joints, over reference variants "
                f"that differ in how bones hold the flesh and in its Poisson's ratio ({pbs['poses']} poses). "
                f"The skin of a body of 1.7 m is {millimetres(pbs['skin_mm'])} mm from flesh, that of LBS "
                f"{millimetres(lbs['skin_mm'])} mm.")

    def rivals(self, table, ms, method, others):
        """Those of the open pairs that the comparison with the familiar ones does not state."""
        return [other for other in others if other not in familiar or not self.where_nearer(table, ms, method, other)]

    def headline(self):
        """The answer for the time of the middle column in one sentence, for a reader who has to choose."""
        ms = self.times_ms[len(self.times_ms) // 2]
        known, without = self.nearest("known", ms), self.nearest("known", ms, takes_nothing=True)
        if known is None:
            return f"No method is fast enough on this machine for {ms:g} ms per frame."
        text = (f"With {ms:g} ms per frame, {name(known['method'])} has the least error: "
                f"it leaves {percent(known['share'])} % of the error of LBS")
        guessed, learned = self.row("guessed", ms, known["method"]), next((row for row in self.rows("known", ms)
                                                                           if is_learned(row)), None)
        if known["takes"] and not is_learned(known) and guessed is not None:
            text += (f" if material and springs of the flesh are known, and {percent(guessed['share'])} % if they "
                     "are guessed")
        if learned is not None:
            text += (f". {name(learned['method'])}, learned once for each body, "
                     f"leaves {percent(learned['share'])} % in {float(learned['ms']):.1g} ms")
        if without is not None and without is not known:
            text += (f"; of the methods that need none of this, {name(without['method'])} leaves "
                     f"{percent(without['share'])} %")
            mush = self.row("known", ms, "delta_mush")
            if mush is not None and mush is not without:
                text += f" and {name(mush['method'])} {percent(mush['share'])} %"
        compared = self.familiar_ones("known", ms, known["method"], with_exceptions=False)
        subject = name(known["method"])
        return f"{text}. {subject[0].upper()}{subject[1:]} is {compared}." if compared else f"{text}."

    def clause(self, table, ms, where="", is_first=False, takes_nothing=False):
        """quasi-Newton leaves 32 % with the flesh known (4.1 mm, level with vertex block descent)"""
        row = self.nearest(table, ms, takes_nothing)
        if row is None:
            return "no method is fast enough on this machine"
        method, share, error, on_body = (row["method"], percent(row["share"]), " of LBS's error",
                                         " from flesh on a body of 1.7 m")
        against = self.against(table, ms, method)
        if takes_nothing:
            against = {decision: [other for other in others if taken(self.row(table, ms, other)) == "nothing"]
                       for decision, others in against.items()}
        text = ("no method is nearer than LBS" if method == "lbs" else f"{name(method)} leaves {share} "
                                                                       f"%{error if is_first else ''}")
        notes = [f"{millimetres(row['skin_mm'])} mm{on_body if is_first else ''}",
                 *(f"level with {named(others)}" for others in [against["level"]] if others),
                 *filter(None, [self.familiar_ones(table, ms, method)]),
                 *(f"{named(others)} may be as near" for others in [self.rivals(table, ms, method, against["open"])]
                   if others)]
        by_condition = {}
        for other in against["depends"]:
            by_condition.setdefault(self.conditions(table, ms, other, method), []).append(other)
        return "; ".join([f"{text}{where} ({'; '.join(notes)})",
                          *(f"if {condition}, {named(others)} {'is' if len(others) == 1 else 'are'} nearer"
                            for condition, others in by_condition.items())])

    def answer(self, ms):
        """The nearest method within a time, with known flesh and with guessed flesh; once if they are the same."""
        is_first = ms == self.times_ms[0]
        text = self.clause("known", ms, "", is_first)
        if self.clause("guessed", ms, "", is_first) != text:
            text = (f"{self.clause('known', ms, ' with the flesh known', is_first)}. With guessed flesh, "
                    f"{self.clause('guessed', ms)}")
        nearest, familiar_one = self.nearest("known", ms), self.nearest("known", ms, takes_nothing=True)
        if nearest is not familiar_one and familiar_one is not None:
            text += f". Of the methods that take nothing of the flesh, {self.clause('known', ms, takes_nothing=True)}"
        return f"Within {ms:g} ms{' per frame' if is_first else ''}, {text}."

    def played(self):
        """What the nearest method and PBS leave along the clips, and of the same frames alone; no sentence without
        clips."""
        rows = [row for row in self.motion if float(row["budget_ms"]) == played_ms]
        nearest = self.nearest("known", played_ms)
        parts = []
        for method in dict.fromkeys([*([nearest["method"]] if nearest else []), "pbs"]):
            of_method = [row for row in rows if row["method"] == method]
            if of_method:
                played, posed = (in_range([float(row[column]) for row in of_method])
                                 for column in ("played_share", "cold_share"))
                parts.append(f"{name(method)} leaves {played} (the same frames alone: {posed})")
        if not parts:
            return []
        frames = in_range_of_counts([int(row["frames"]) for row in rows])
        return [f"Played along a clip, each frame from the one before, {' and '.join(parts)} within {played_ms:g} ms; "
                f"{frames} of each clip have a reference."]

    def own(self):
        """{deformer of the user's own: its row with known flesh at the shortest time that it keeps}"""
        return {row["method"]: row for ms in self.columns_ms[::-1] for row in self.rows("known", ms) if is_own(row)}

    def own_answers(self):
        """The sentences on the deformers of the user's own."""
        return [self.own_answer(row) for row in self.own().values()]

    def own_answer(self, row):
        """mine leaves 98 % [93, 103] of the error of LBS in 190 ms per frame (40 poses); with at most 10 ms, DQS leaves
        69 %."""
        method, ms = row["method"], float(row["budget_ms"])
        others = [(other, self.row("known", ms, other)) for other in ("dqs", "delta_mush", "pbs")]
        shares = conjoined([f"{name(other)} leaves {percent(of['share'])} %" for other, of in others if of], "and")
        text = (f"{name(method)} leaves {percent(row['share'])} % [{percent(row['share_low'])}, "
                f"{percent(row['share_high'])}] of the error of LBS in {figure(float(row['ms']))} ms per frame "
                f"({row['poses']} poses)")
        if shares:
            text += f"; with at most {min(ms, self.times_ms[-1]):g} ms, {shares}"
        short = [time for time in self.times_ms if time < float(row["ms"])]
        span = " to ".join(f"{time:g}" for time in dict.fromkeys([*short[:1], *short[-1:]]))
        against = self.against("known", ms, method)
        decided = [f"{named(others)} {'is' if len(others) == 1 else 'are'} {decision}" for decision, others in
                   (("nearer", against["farther"]), ("farther", against["nearer"])) if others]
        return (f"{text}." + (f" It is too slow for {span} ms." if short else "")
                + (f" Decided: {'; '.join(decided)}." if decided else " No comparison with another method is decided."))

    def answers(self):
        """One sentence for each time, and one for clips."""
        return [*map(self.answer, self.times_ms), *self.played()]


def own_clocks(folder):
    """{deformer of the user's own: its clock}"""
    own = {row["method"] for row in records.read_rows(folder / "methods.csv") if is_own(row)}
    points = (row for file in sorted(folder.glob("*/points.csv")) for row in records.read_rows(file)) if own else ()
    return {row["method"]: row["clock"] for row in points if row["method"] in own}


def of_time(rows, table, ms):
    return [row for row in rows if row["table"] == table and float(row["budget_ms"]) == ms]


def solved_sentence(rows):
    """The methods that solve the most poses within 1 and 10 ms. rows: of profiles.csv, of one table."""
    targets, parts = sorted({float(row["target_pct"]) for row in rows}), []
    target = targets[len(targets) // 2]
    for ms in (1.0, 10.0):
        solved = {row["method"]: float(row["solved_pct"]) for row in rows
                  if (float(row["target_pct"]), float(row["budget_ms"])) == (target, ms)}
        best = max(solved, key=solved.get, default=None)
        parts += [f"by {name(best)} within {ms:g} ms ({solved[best]:.0f} %)"] if best and solved[best] else []
    return f"Most poses are solved to {target:g} % of LBS's error {conjoined(parts, 'and')}." if parts else ""
