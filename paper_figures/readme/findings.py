"""Writes the findings of the README: one statement with its key number per line, from the facts in DIR/claims.json and,
for the distance from flesh and the stability, from the tables of these studies. Draws the figure of error against run
time, and writes the answer and the table below it.
"""
import pathlib

import records
from drawing import style
from figures import work_precision
from readme import tables
from records import entries
from words import compared_methods, sentences
from words.number_words import counted

page = "experiments/records/full/work_precision/work_precision.md"
picture = pathlib.Path(__file__).resolve().with_name("error_against_time.png")


def of(claims, name):
    """The only claim of this id."""
    found = [claim for claim in claims if claim["id"] == name]
    if len(found) != 1:
        raise records.RecordsMissing(f"claims.json: claims: {len(found)} with the id {name}: expected one")
    return found[0]


def stated(claims, name, sentence):
    """sentence(claim, the numbers of its cases); without numbers, a sentence that states why there are none."""
    claim = of(claims, name)
    values = [case["value"] for case in sentences.counting(claim) if case["value"] is not None]
    return (sentence(claim, values) if values else f"{name} is {sentences.names[claim['verdict']]}. "
                                                   f"{sentences.in_line(claim)}.")


def span(values, digits=0, unit=""):
    """0 to 45 %, or the one value."""
    return " to ".join(dict.fromkeys(f"{value:.{digits}f}" for value in (min(values), max(values)))) + unit


def percent(shares):
    return span([100 * share for share in shares], unit=" %")


def volume(claims):
    title = {"holds": "kept as claimed", "fails": "not kept as claimed"}.get(of(claims, "C02a")["verdict"], "open")
    shares = stated(claims, "C02a", lambda _, values: f"PBS is within the paper's limit in {percent(values)} of the "
                                                      "frames of a clip.")
    return f"**Volume: {title}.** {shares}"


def artefacts(claims):
    def count(claim, _):
        return f"{claim['held']} of {counted(claim['n'], 'pose')}"

    gone = all(of(claims, name)["verdict"] == "holds" for name in ("C04", "C05"))
    title = "gone" if gone else "not everywhere gone"
    return (f"**Artefacts: {title}.** No candy wrapper of LBS is left in {stated(claims, 'C04', count)}, "
            f"and no bulge of DQS in {stated(claims, 'C05', count)}.")


def convergence(claims):
    verdict = {"holds": "enough", "fails": "too few",
               "not_shown": "not shown to suffice"}.get(of(claims, "C12a")["verdict"], "open")
    count = stated(claims, "C12a", lambda claim, _: f"The paper's number suffices in {claim['held']} of "
                                                    f"{counted(claim['n'], 'pose')}.")
    return f"**Iterations: {verdict}.** {count}"


def trials(results, quantity):
    """How many trials of PBS in the paper's own order and double precision end like this, and of how many, over all
    bodies and factors."""
    rows = [row for file in sorted((results / "stability").glob("*/measurements.csv"))
            for row in records.read_rows(file)
            if (row["deformer"], row.get("order"), row.get("precision"),
                row["quantity"]) == ("pbs", "plain", "f64", quantity)]
    records.need(rows, f"{results / 'stability'}: no {quantity} of PBS in the paper's order and double precision")
    return sum(round(row.number("value") * row.number("n"))
               for row in rows), sum(round(row.number("n")) for row in rows)


def stability(results):
    """A body that is bounded may move on; a diverged one does not rest."""
    diverged, every = trials(results, "share_of_cells_diverged")
    moving, _ = trials(results, "share_of_cells_in_motion")
    title = f"blows up in {diverged} trials" if diverged else "never blows up"
    rest = percent([(every - diverged - moving) / every])
    return f"**Stability: PBS {title}**, but it comes to rest in only {rest} of the trials with disturbances."


def stiffness(claims):
    factors = stated(claims, "C11", lambda _, values: f"Twice the iterations make the flesh {span(values, 1)} times "
                                                      "stiffer.")
    return f"**Stiffness: k alone does not define it.** {factors}"


def speed(claims):
    title = {"holds": "real time", "fails": "not real time"}.get(of(claims, "C10a")["verdict"], "open")
    rates = stated(claims, "C10a", lambda _, values: f"At the paper's sizes, one core computes {span(values)} frames "
                                                     "per second.")
    return f"**Speed: {title}.** {rates}"


def distance(results):
    compared = compared_methods.Compared(results / "work_precision")
    ms = compared.times_ms[len(compared.times_ms) // 2]
    pbs, lbs = (compared.row("known", ms, method) for method in ("pbs", "lbs"))
    records.need(pbs, f"{results / 'work_precision' / 'methods.csv'}: no row of PBS within {ms:g} ms")
    skins = [compared_methods.millimetres(row["skin_mm"]) for row in (pbs, lbs)]
    return (f"**Distance from flesh: {'less' if float(pbs['share']) < 1 else 'no less'} than with LBS.** The skin of a "
            "body of "
            f"1.7 m is {skins[0]} mm from it with PBS, {skins[1]} mm with LBS.")


def lines_of(results):
    claims = sentences.claims_of(results / "claims.json")
    findings = [volume(claims), artefacts(claims), convergence(claims), stability(results), stiffness(claims),
                speed(claims), distance(results)]
    hold, fail = (sum(claim["verdict"] == verdict for claim in claims) for verdict in ("holds", "fails"))
    return [*(line for finding in findings for line in tables.filled(f"- {finding}", "  ")), "",
            f"[All {len(claims)} claims](#claims): {hold} hold, {fail} fail, and {len(claims) - hold - fail} do "
            "neither "
            "([the verdicts](experiments/verdicts/README.md#the-rule))."]


def origin_of_picture(results):
    return next(entry for entry in entries.read() if entry.name == picture.stem).origin(results)


def methods_lines(results):
    """The answer for a reader who has to choose, and the table of the methods."""
    compared, processor = compared_methods.Compared(results / "work_precision"), origin_of_picture(results)["cpu_model"]
    processor = processor.replace("(R)", "").removesuffix(" Processor")
    head = ["method", "takes", *map(compared_methods.time_name, compared.columns_ms)]
    rows = [tables.line(*cells) for cells in compared.table("known")]
    poses = compared.row("known", compared.times_ms[0], "lbs")["poses"]
    marks = {"\u2020": "too slow on a machine half as fast", "\u2021": "on this one"}
    told = [f"Error at the joints in per cent of that of LBS, on one core ({processor}): geometric mean over {poses} "
            "poses, in brackets the range over the reference variants. Between methods with a common letter nothing is "
            "decided.",
            "; ".join(f"{mark}: {meaning}" for mark, meaning in marks.items() if mark in "".join(rows)) + "."]
    return [*tables.filled(f"**{compared.headline()}** [Other times, and what is open]({page})."), "",
            tables.line(*head), "|---" * len(head) + "|", *rows, "", *tables.filled(f"*{' '.join(told)}*")]


def drawn_methods_lines(results):
    """Draws the figure of error against run time, and returns the lines that show it, the answer and the table of the
    methods."""
    drawn, rows = work_precision.error_against_time(results)
    style.save(drawn, picture.with_suffix(""), origin_of_picture(results), rows, formats=("png",), dpi=200)
    return [f"![Error against run time of each method](paper_figures/readme/{picture.name})", "",
            *methods_lines(results)]
