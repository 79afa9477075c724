"""Composes the page: the answers first, then the data on which they rest."""
import importlib
import pathlib

import records
from report import answers, errors, figures, origin, verdicts
from report.markup import Markup, element, escaped, items, joined
from words import glossary

here = pathlib.Path(__file__).parent
title = "Position Based Skinning: do its claims hold?"


def lead(found):
    """What was examined, and at which revision."""
    revisions = origin.values_of(found, "git_revision")
    runs = sum(name.count("/") == 1 for name in found.runs)  # the parts of a run are in folders below it
    text = (f"The claims of the paper of 2014 against {runs} recorded runs of pbskin "
            f"{', '.join(origin.values_of(found, 'version'))}, "
            f"revision {', '.join(dict.fromkeys(revision[:10] for revision in revisions))}.")
    if found.judging != found.results:
        text += " The verdicts and the comparison of methods are those of the kept record."
    if not found.repeated["text"] and any(plan.get("extent") == "quick" for plan in found.plans.values()):
        text += (" They are those of a quick run: claims have fewer cases or lack a control, so that full records may "
                 "give other verdicts.")
    return element("p", text, class_="lead")


def navigation(sections):
    links = joined((element("a", name, href=f"#{anchor}") for anchor, name, _ in sections), " ")
    return element("nav", links, aria_label="Sections")


def viewer_section(found):
    """The interactive viewer or the reason why it is missing, what is missing, and for each claim the link to its pose
    in the viewer."""
    try:
        viewer = importlib.import_module("viewer.page")
        return Markup(viewer.fragment(found.results)), [], viewer.claim_links(found.results)
    except (ImportError, records.RecordsMissing) as error:
        reason = str(error).replace(f"{found.results}/", "")
    return element("p", f"The viewer is missing: {reason}.", class_="missing"), [f"viewer: {reason}"], {}


def page(found):
    """The text of the page, and what is missing in it."""
    shown, not_shown, moving = viewer_section(found)
    pictures, drawn, not_drawn = figures.section(found)
    distances, not_told = errors.section(found)
    no_verdicts = [] if found.claims is not None else ["verdicts: claims.json does not exist (pbskin reproduce "
                                                       "--judge)"]
    missing = not_shown + not_drawn + not_told + no_verdicts
    missing += [f"{study}: {scene} is excluded: {reason}" for study, scene, reason in found.left_out()]
    costs = items([told for told in (answers.frame_sentence(found), origin.costs_sentence(found)) if told])
    folded = [("errors", "Distance from the finite elements", joined([answers.distances(found), distances], "\n")),
              ("figures", "Figures", pictures), ("reference", "Is the reference right?",
                                                 errors.reference_section(found)),
              ("glossary", "Glossary", glossary_section()),
              ("costs", "Cost", joined([costs, origin.costs_section(found)])),
              ("origin", "Where the records come from", origin.section(found, with_viewer=not not_shown)),
              ("cite", "How to cite", origin.citation_section(found))]
    claims = [("verdicts", "The claims, one per line", verdicts.section(found, moving, drawn))]
    first = [answers.do_they_hold(found),
             answers.first_screen(shown, [answers.how_far(found), answers.which_method(found)])]
    return whole(title, lead(found), [*first, navigation(claims + folded), *written(claims),
                                      *written(folded, are_folded=True)]), missing


def glossary_section():
    terms = [element("dt", entry.name, id=f"term-{entry.slug}") + element("dd", entry.sentence)
             for entry in glossary.entries()]
    return element("dl", Markup("\n".join(terms)), class_="glossary")


def written(sections, are_folded=False):
    """The sections; the reader opens those that are folded."""
    def of(name, content):
        heading = element("h2", name)
        return (element("details", joined([element("summary", heading), content], "\n")) if are_folded
                else joined([heading, content], "\n"))

    return [element("section", of(name, content), id=anchor) for anchor, name, content in sections]


def whole(title, lead, body, first="claims"):
    """The text of a page; `first` is the anchor of its first section."""
    template = (here / "page.html").read_text()
    return template.format(title=escaped(title), lead=lead, first=first, style=(here / "page.css").read_text(),
                           script=Markup((here / "page.js").read_text()), body=joined(body, "\n"))
