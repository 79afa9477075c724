"""Writes the findings of the README: one statement with its key numbers per line, from the facts in DIR/claims.json and, for the distance
from flesh and the stability, from the tables of these studies. Draws the figure below the findings, with the answer and its table.
"""
import pathlib

import records
from drawing import style
from figures import work_precision
from readme import tables
from records import entries
from words import case_words, compared_methods, sentences
from words.number_words import counted

paper_s_solver = "the paper's own solver (file order, double precision)"
most_exceptions = 2  # named one by one
page = "experiments/records/full/work_precision/work_precision.md"
picture = pathlib.Path(__file__).resolve().with_name("error_against_time.png")
read_scenes = ("human", "human_moving")  # in which the study ambiguity measures the volume over a clip


def only(rows, what, **wanted):
    """The only row or fact with these fields."""
    found = [row for row in rows if all(row.get(name) == value for name, value in wanted.items())]
    if len(found) != 1:
        raise records.RecordsMissing(f"{what}: {len(found)} with {wanted}: expected one")
    return found[0]


def of(claims, name):
    return only(claims, "claims.json: claims", id=name)


def counted_units(claims, name):
    """The claim and its units that count; without such units, a sentence that says why in place of them."""
    claim = of(claims, name)
    units = [case for case in sentences.counting(claim) if case["value"] is not None]
    return claim, units, "" if units else f"{name} is {sentences.names[claim['verdict']]}: {'; '.join(sentences.facts(claim))}."


def percent(value):
    return f"{100 * value:.0f} %"


def between(values):
    """0 % to 73 %; or the one value."""
    return " to ".join(dict.fromkeys(percent(value) for value in (min(values), max(values))))


def volume(claims, results):
    """The shares of frames in the paper's order, by clip; the range over the other orders and precisions, and over the readings of the
    paper, which the study `ambiguity` runs in the paper's order too."""
    claim, clips, told = counted_units(claims, "C02a")
    if not told:
        orders = claim["readings"] + [of for of in claim["compared"] if of["name"] == "ordered f32"]
        others = [case["value"] for of in orders for case in sentences.counting(of) if case["value"] is not None]
        shares = "; ".join(f"{case_words.of(case)}: {percent(case['value'])}" for case in clips)
        readings = [float(row["b"]) for scene in read_scenes for row in records.table(
            results / "ambiguity" / scene / "figures.csv", {"quantity", "b"}) if row["quantity"] == "share_of_frames_within_printed"]
        records.need(readings, f"{results / 'ambiguity'}: no share of frames within 0.5 %")
        told = (f"With {paper_s_solver}, PBS with 24 iterations keeps the volume within 0.5 % in this share of the frames: {shares}."
                + (f" In other orders and precisions it is {between(others)}." if others else "")
                + f" In other readings of the paper it is {between(readings)} (human, clip 01_01).")
    return f"**Volume.** {told}"


def artefacts(claims):
    """How many joints have neither artefact, and the units that do not hold where they are few."""
    texts, solver = [], f"With {paper_s_solver}, PBS"
    for name, what, where in (("C04", "candy wrapper", "LBS narrows"), ("C05", "bulge", "DQS bulges")):
        claim, units, told = counted_units(claims, name)
        failing = [f"{case_words.of(case)} ({sentences.shown(case)})" for case in units if not case["holds"]]
        more = [f"{len(failing) - most_exceptions} more"] if len(failing) > most_exceptions else []
        verb = "exception is" if len(failing) == 1 else "exceptions are"
        exceptions = f"; the {verb} {' and '.join(failing[:most_exceptions] + more)}" if failing else ""
        poses = f"{claim['held']} of the {counted(claim['n'], 'pose')} in which {where}"
        others = [of["held"] for of in claim["readings"]]
        least = f"{min(others)} or more" if min(others, default=0) < max(others, default=0) else "as many"
        held = f" ({least} in other orders and precisions)" if others and {of["n"] for of in claim["readings"]} == {claim["n"]} else ""
        texts.append(told or f"{solver} shows no {what} in {poses}{exceptions}{held}.")
        solver = solver if told else "It"
    return f"**Artefacts.** {' '.join(texts)}"


def convergence(claims):
    claim, _, told = counted_units(claims, "C12a")
    if not told:
        told = (f"With {paper_s_solver}, 24 iterations bring the residual within 5 % of its floor in {claim['held']} of "
                f"{counted(claim['n'], 'case')}.")
    return f"**Convergence.** {told}"


def trials(results):
    """(order, precision) -> quantity -> the trials of PBS that end like this, and of all of them, over all bodies and factors."""
    counts = {}
    for row in (row for file in sorted((results / "stability").glob("*/measurements.csv")) for row in records.read_rows(file)):
        if row["deformer"] == "pbs" and row["quantity"].startswith("share_of_cells_"):
            ends = counts.setdefault((row.get("order", ""), row.get("precision", "")), {})
            ended, every = ends.get(row["quantity"], (0, 0))
            ends[row["quantity"]] = ended + round(row.number("value") * row.number("n")), every + round(row.number("n"))
    return counts


def ends_of(counts):
    """How many trials there are, how many are bounded, and the shares at rest and as if undisturbed. A bounded body may move on, and one at
    rest may be elsewhere than the undisturbed one; a diverged one does not rest."""
    diverged, every = counts["share_of_cells_diverged"]
    moving, correct = (counts[f"share_of_cells_{what}"][0] for what in ("in_motion", "at_rest"))
    return every, every - diverged, (every - diverged - moving) / every, correct / every


def bounded_in(counts):
    bounded, every = (sum(of) for of in zip(*((ends_of(of)[1], ends_of(of)[0]) for of in counts)))
    return f"all {every} trials" if bounded == every else f"{bounded} of {every} trials"


def stability(results):
    counts = trials(results)
    own = counts.pop(("plain", "f64"), None)
    records.need(own, f"{results / 'stability'}: no trial of PBS in the paper's order and double precision")
    _, _, rest, correct = ends_of(own)
    text = (f"With {paper_s_solver}, PBS stays bounded in {bounded_in([own])} with disturbances, extreme settings and time steps to 1 s; "
            f"at the end it is at rest in {percent(rest)} and correct (as if undisturbed) in {percent(correct)}.")
    if counts:
        pooled = {quantity: tuple(map(sum, zip(*(of[quantity] for of in counts.values() if quantity in of))))
                  for quantity in next(iter(counts.values()))}
        _, _, rest, correct = ends_of(pooled)
        text += f" In the other orders and precisions it is bounded in {bounded_in([pooled])}, at rest in {percent(rest)} and correct in " \
                f"{percent(correct)}."
    return f"**Stability.** {text}"


def stiffness(claims):
    _, units, told = counted_units(claims, "C11")
    factors = [case["value"] for case in units]
    return "**Stiffness.** " + (told or f"k alone does not define a stiffness: with {paper_s_solver}, doubling the iterations makes the "
                                f"flesh {min(factors):.1f} to {max(factors):.1f} times stiffer.")


def speed(claims, results):
    claim, units, told = counted_units(claims, "C10a")
    compared = of(claims, "C10b")
    table_1 = f", {sentences.span(sentences.counting(compared))} times the rates of Table 1 on a processor of 2014" if compared["n"] else ""
    rates = sentences.span(units).removesuffix(" 1/s")
    processors = sorted({row["cpu_model"] for row in records.table(results / "timing" / "timing.csv", {"cpu_model"})})
    return "**Speed.** " + (told or f"At the sizes of Table 1, PBS with {paper_s_solver} reaches {rates} frames per second on one "
                            f"core ({', '.join(processors)}){table_1}. The threshold is {claim['thresholds'][0]['low']:.0f}.")


def distance(results):
    told = compared_methods.Compared(results / "work_precision").share_of_pbs()
    records.need(told, f"{results / 'work_precision' / 'methods.csv'}: no row of PBS within 1 ms")
    return f"**Distance from flesh.** {told}"


def lines_of(results):
    claims = sentences.claims_of(results / "claims.json")
    findings = [volume(claims, results), artefacts(claims), convergence(claims), stability(results), stiffness(claims),
                speed(claims, results), distance(results)]
    return [f"{number}. {finding}".replace("\u2212", "-") for number, finding in enumerate(findings, 1)]


def figure_lines(results):
    """Draws the figure of error against run time, and returns the lines that show it, the answer and the table of the methods."""
    origin, = (entry.origin(results) for entry in entries.read() if entry.name == "error_against_time")
    drawn, rows = work_precision.error_against_time(results)
    style.save(drawn, picture.with_suffix(""), origin, rows, formats=("png",), dpi=200)
    compared = compared_methods.Compared(results / "work_precision")
    lbs = compared.row("known", compared.times_ms[0], "lbs")
    head = ["method", "takes", *(f"{ms:g} ms" for ms in compared.times_ms)]
    return [f"![Error against run time of each method](paper_figures/readme/{picture.name})", "", f"**{compared.headline()}** "
            f"[Other times, and what is open]({page}).", "",
            tables.line(*head), "|---" * len(head) + "|", *(tables.line(*cells) for cells in compared.table("known")), "",
            f"*Error at the joints in per cent of that of LBS, on one core ({origin['cpu_model']}): the geometric mean over "
            f"{lbs['poses']} poses ({lbs['fewest_poses']} for the reference variant with the fewest solutions), and in brackets the range "
            f"over the variants. {compared_methods.legend} [The whole comparison]({page}).*"]
