"""Error against run time: the answer, the methods with known and with guessed flesh, their times, what is decided and
how firmly, what other initial guesses and wrong materials are worth, and the same along a clip."""
import pages
import records
from words import case_words, compared_methods
from words.compared_methods import percent, time_name
from words.number_words import counted

small_error_pct = 1.0  # of a reference
table_words = {"known": "Flesh known", "guessed": "Flesh guessed"}
table_notes = {"known": "Methods that take flesh are given that of each reference.",
               "guessed": "All methods that take flesh have that of the first variant, whatever the reference is. "
                          "Changes to PBS have rows of their own."}
decision_words = {"first_is_nearer": "{first} is nearer", "second_is_nearer": "{second} is nearer", "level": "level",
                  "depends": "depends", "open": "open"}


def names_of(row):
    return {which: compared_methods.name(row[which]) for which in ("first", "second")}


def shown(row):
    return decision_words[row["decision"]].format(**names_of(row))


def limits(compared, folder):
    """What a number is, and how much the poses can show."""
    bodies = {row["body"] for row in records.table(folder / "references.csv", {"body", "stratum"})
              if row["stratum"] == "movement"}
    poses = max(int(row["poses"]) for row in compared.methods)
    return (f"A number is the error at the joints in per cent of that of LBS: the geometric mean over {poses} poses, "
            "of which the table has the median over the reference variants and in brackets their range. A method is "
            "nearer than another one if each variant shows it (sign test over the poses, adjusted by Holm for all "
            f"pairs of the table). {compared_methods.legend}\n\nThe number of bodies is the limit of what these poses "
            f"show. A sign test over {counted(len(bodies), 'body', 'bodies')} cannot have p below "
            f"{2.0 ** (1 - len(bodies)):g}, so that the decisions hold for these bodies alone.\n")


def shares(compared, table):
    """The movement poses, and the deep folds in columns of their own."""
    folds = ([fold_cell(compared.row(table, ms, method)) for ms in compared.columns_ms]
             for method in compared.ranked(table))
    rows = [cells + of_folds for cells, of_folds in zip(compared.table(table), folds)]
    heads = ["method", "takes", *map(time_name, compared.columns_ms),
             *(f"deep folds, {time_name(ms)}" for ms in compared.columns_ms)]
    return pages.table(rows, {head: lambda row, place=place: row[place] for place, head in enumerate(heads)})


def fold_cell(row):
    if row is None or not row["fold_share"]:
        return ""
    return f"{percent(row['fold_share'])} [{percent(row['fold_low'])}, {percent(row['fold_high'])}]"


def times(compared, table):
    """The distance of the skin, and the time with its multiple of PBS."""
    columns = {"method": compared_methods.name}
    for ms in compared.columns_ms:
        columns[f"skin, {time_name(ms)} [mm]"] = lambda method, ms=ms: cell_of(compared.row(table, ms, method), skin)
    for ms in compared.columns_ms:
        columns[f"time, {time_name(ms)} [ms] (\u00d7 PBS)"] = lambda method, ms=ms: cell_of(
            compared.row(table, ms, method), time_cell)
    return pages.table(compared.ranked(table), columns)


def cell_of(row, text):
    return "" if row is None else text(row)


def skin(row):
    inverted = f" ({row['inverted_poses']})" if row["inverted_poses"] != "0" else ""
    return (compared_methods.millimetres(row["skin_mm"]) if row["skin_mm"] else "\u2013") + inverted


def time_cell(row):
    over = f" (\u00d7 {float(row['times_pbs']):.2g})" if row["times_pbs"] else ""
    return (f"{float(row['ms']):.2g}{over}" if row["ms"] else "\u2013") + compared_methods.marks[row["within"]]


def of_tables(compared):
    text = ""
    for table, heading in table_words.items():
        text += f"\n## {heading}\n\n{table_notes[table]}\n\n{shares(compared, table)}"
    text += ("\n## Distance of the skin, and time\n\nThe distance is the root mean square over the skin of a body of "
             "1.7 m, followed by the number of poses in which a tet is inverted, if there are any. The time is "
             "followed by its multiple of that of PBS with 24 iterations in plain double precision on the same "
             "machine.\n")
    for table, heading in table_words.items():
        text += f"\n{heading}:\n\n{times(compared, table)}"
    return text


def decisions(compared):
    """How many pairs are decided, and which of them depend on the flesh."""
    counts, depending = [], []
    for table, heading in table_words.items():
        for ms in compared.columns_ms:
            rows = [row for row in compared_methods.of_time(compared.decisions, table, ms) if not row["without_body"]]
            kinds = [row["decision"] for row in rows]
            counts.append({"table": heading.lower(), "time": time_name(ms), "pairs": len(kinds),
                           "decided": sum(kind.endswith("is_nearer") for kind in kinds),
                           **{kind: kinds.count(kind) for kind in ("level", "depends", "open")}})
            for row in (row for row in rows if row["decision"] == "depends"):
                for one, other in ((row["first"], row["second"]), (row["second"], row["first"])):
                    depending.append(f"- {heading.lower()}, {time_name(ms)}: {compared_methods.name(one)} is "
                                     f"nearer than {compared_methods.name(other)} if "
                                     f"{compared.conditions(table, ms, one, other)}.\n")
    return ("\n## Decisions\n\nTwo methods are level if on each variant their errors differ by less than the "
            "reference's own error in 80 % of the poses, or by less than a tenth in the mean. A decision depends on "
            "the flesh if two variants decide in opposite ways.\n\n" + pages.table(counts, "decisions")
            + ("\n" + "".join(depending) if depending else ""))


def without_a_body(compared):
    """The decisions that one body can change."""
    of_pair = {}
    for row in compared.decisions:
        of_pair.setdefault((row["table"], float(row["budget_ms"]), row["first"], row["second"]),
                           {})[row["without_body"]] = row
    changed = []
    for (table, ms, *_), rows in of_pair.items():
        others = [f"without {body}: {shown(row)}"
                  for body, row in rows.items() if row["decision"] != rows[""]["decision"]]
        if others:
            changed.append(names_of(rows[""]) | {"table": table_words[table].lower(), "time": time_name(ms),
                                                 "all": shown(rows[""]), "others": "; ".join(others)})
    text = f"\n## Decisions that change if a body is excluded: {len(changed)} of {len(of_pair)}\n\n"
    return text + (pages.table(changed, "without_body") if changed else "None.\n")


def starts(folder):
    """What the initial guess and the right flesh are worth."""
    rows = records.rows_if_any(folder / "starts.csv")
    if not rows:
        return ""
    cells = {(row["method"], float(row["budget_ms"])): f"{percent(row['share_of_setting'])} \u2192 "
                                                       f"{percent(row['share'])}" for row in rows}
    of_method = {row["method"]: row["of"] for row in rows}
    columns = {"method": lambda method: compared_methods.name(of_method[method]),
               "change": lambda method: case_words.of_field("other_start",
                                                            method.removeprefix(f"{of_method[method]}_"))}
    for ms in sorted({ms for _, ms in cells}):
        columns[time_name(ms)] = lambda method, ms=ms: cells.get((method, ms), "")
    poses = max(int(row["poses"]) for row in rows)
    return (f"\n## What the initial guess and the right material are worth\n\nThe share of LBS's error [%] in {poses} "
            "poses, of the method's setting and after the change alone, against the first variant.\n\n"
            + pages.table(of_method, columns))


def motion(compared):
    if not compared.motion:
        return ""
    cells, ranked = {}, compared.ranked("guessed")
    for row in compared.motion:
        key = tuple(row[name] for name in ("clip", "member", "method"))
        posed, played = (f"{percent(row[f'{start}_share'])} % ({compared_methods.millimetres(row[f'{start}_skin_mm'])} "
                         "mm)"
                         for start in ("cold", "played"))
        cells[key, float(row["budget_ms"])] = f"{posed} \u2192 {played}"
    columns = {"clip": lambda key: key[0], "reference": lambda key: case_words.in_plain(key[1]),
               "method": lambda key: compared_methods.name(key[2])}
    for ms in compared.times_ms:
        columns[time_name(ms)] = lambda key, ms=ms: cells.get((key, ms), "")
    keys = sorted({key for key, _ in cells}, key=lambda key: (*key[:2], ranked.index(key[2])))
    frames = max(int(row["frames"]) for row in compared.motion)
    return (f"\n## Posed and played\n\nThe share of LBS's error and the distance of the skin in {frames} frames of "
            "each clip: each frame alone, then played at 60 frames per second, each frame from the one before.\n\n"
            + pages.table(keys, columns))


def own_errors(folder):
    rows = records.table(folder / "references.csv", {"own_error_pct", "outcome"})
    known = [float(row["own_error_pct"]) for row in rows if row["own_error_pct"]]
    missing = sum(row["outcome"] != "reached" for row in rows)
    small = sum(value <= small_error_pct for value in known)
    told = (f"The error of a reference itself is estimated at {min(known):.2g} to {max(known):.2g} % of the mean bone "
            f"distance in {len(known)} of {len(rows)} solutions, and at {small_error_pct:g} % or less in {small}."
            ) if known else "No own error is known."
    return f"\n## The references\n\n{told}" + (f" Not reached: {missing}." if missing else "") + "\n"


def settings(compared):
    """The settings that the training poses chose."""
    columns = {"method": compared_methods.name}
    for ms in compared.times_ms:
        columns[time_name(ms)] = lambda method, ms=ms: cell_of(compared.row("guessed", ms, method),
                                                               lambda row: f"`{row['setting']}`")
    return "\n## Settings\n\nOther poses than those above have chosen them.\n\n" + pages.table(
        compared.ranked("guessed"), columns)


def own_deformers(folder):
    clocks = compared_methods.own_clocks(folder)
    return ("\n## Deformers of the user's own\n\nTheir times were taken as follows:\n\n" + "".join(
        f"- `{method}`: {case_words.of_field('clock', clock)}\n" for method, clock in clocks.items())) if clocks else ""


def page(folder):
    compared = compared_methods.Compared(folder)
    own = [f"**{answer}**\n" for answer in compared.own_answers()]
    answers = "\n".join([*own, f"**{compared.headline()}**", "", *(f"- {answer}" for answer in compared.answers())])
    return (f"# Error against run time\n\n{answers}\n\n{limits(compared, folder)}" + of_tables(compared)
            + decisions(compared)
            + without_a_body(compared) + starts(folder) + motion(compared) + own_errors(folder) + settings(compared)
            + own_deformers(folder))
