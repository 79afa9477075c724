"""The first screen: the short table of the claims, the moving character, what PBS is, and two answers. Every sentence
is composed from claims.json, the tables of work_precision, and timing/timing.csv."""
from report import verdicts
from report.markup import Markup, element, joined, table
from report.record_set import not_run, number
from words import compared_methods, glossary, sentences
from words.number_words import span

what_it_is = ("Position based skinning (PBS) moves a character\u2019s tetrahedral mesh with its bones by linear blend "
              "skinning (LBS). Then it gives the flesh its volume back with a few iterations of stretch, "
              "volume and bind constraints.")
where_to_go = Markup("Your own model: <code>pbskin try hero.glb</code>. "
                     "A deformer of your own: <code>experiments/deformers/external/README.md</code> (any program or C "
                     "library), <code>experiments/deformers/README.md</code> (C++).")


def answer(question, sentence, *more):
    """A question with its answer."""
    return element("div", joined([element("h2", question), element("p", sentence), *more]), class_="answer")


def do_they_hold(found):
    """The first card: how many claims hold, whether this machine repeats the record, and the short table."""
    repeats = found.repeated["text"]
    if not found.claims:
        sentence = "No verdict is on record: run `pbskin reproduce`, or `pbskin reproduce --judge` on these records."
        shown = [*([element("p", repeats)] if repeats else []), element("p", sentence, class_="missing")]
    else:
        shown = [element("p", " ".join(filter(None, [sentences.counts(found.claims), repeats]))),
                 verdicts.short_table(found)]
    return card("claims", "Do the paper\u2019s claims hold?", shown)


def card(anchor, heading, parts):
    """The first thing that is read on a page."""
    return element("section", joined([element("h2", heading), *parts], "\n"), id=anchor, class_="card")


def compared(found):
    """The methods of the study work_precision, or None without their tables. A run with deformers of the user's own
    answers by itself."""
    for results in (found.results, found.judging):
        folder = results / "work_precision"
        methods = compared_methods.Compared(folder) if (folder / "methods.csv").is_file() else None
        if methods and (methods.own() or results == found.judging):
            return methods
    return None


def how_far(found):
    question = "How far is PBS from simulated flesh?"
    methods = compared(found)
    told = methods.share_of_pbs() if methods else ""
    missing = f"The distance from finite elements is {not_run(found, 'work_precision')}."
    return answer(question, told or element("span", missing, class_="missing"))


def which_method(found):
    question = "Which method for which time?"
    methods = compared(found)
    if not methods:
        return answer(question, element("span", f"The nearest method is {not_run(found, 'work_precision')}.",
                                        class_="missing"))
    return answer(question, joined([*methods.own_answers(), methods.headline(), *methods.answers()], Markup("<br>")))


def first_screen(viewer, answers):
    """Beside the moving character: what PBS is, and the answers; the first use of a term links to the glossary."""
    seen = set()
    what, sentence = (glossary.linked(text, seen) for text in (element("p", what_it_is, class_="what"),
                                                               joined(answers, "\n")))
    return element("div", joined([element("div", viewer, id="viewer", class_="stage"), element("div", joined(
        [what, sentence, element("p", where_to_go, class_="place")], "\n"), class_="answers")], "\n"),
                   class_="first-screen")


# Further down: the shares of all methods, and the cost.

def distances(found):
    methods = compared(found)
    if not methods:
        return ""
    head = ["method", "takes", *map(compared_methods.time_name, methods.columns_ms)]
    return joined([table("Error at the joints in per cent of that of LBS, with known flesh [range over the reference "
                         "variants]", head,
                         methods.table("known")), element("p", compared_methods.legend)])


def frame_sentence(found):
    rows = [row for row in found.rows("timing/timing.csv") if row["paper_frames_per_s"]]
    quick, plain = ([row for row in rows if (row["variant"], row["precision"]) == kernel]
                    for kernel in (("ordered", "f32"), ("plain", "f64")))
    if not quick or not plain:
        return f"A frame's time at the paper's mesh sizes is {not_run(found, 'timing')}."

    def told(rows, column):
        return span([number(row, column) for row in rows])

    return joined([element("b", f"PBS, 24 iterations, meshes of Table 1's sizes, one core ({quick[0]['cpu_model']}): "
                                f"{told(quick, 'total_wall_ms')} ms per frame"),
                   f" in single precision and ordered ({told(quick, 'frames_per_s')} frames per second); "
                   f"plain loops in double precision take {told(plain, 'total_wall_ms')} ms "
                   f"({told(plain, 'frames_per_s')} frames per second; Table 1 prints "
                   f"{told(plain, 'paper_frames_per_s')})."])
