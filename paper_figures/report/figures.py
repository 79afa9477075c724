"""Every figure that was drawn, inline as SVG, and the reason why each of the others was not."""
import base64
import dataclasses
import html
import io
import re

from PIL import Image

import records
from records import entries
from report import record_set
from report.markup import Markup, beside_the_page, element, escaped, joined
from words import captions

most_inline_kb = 100  # size of a CSV that the page contains
papers_own = re.compile(r"(Figure|Table) \d")  # titles that contain the paper's own number


def smaller(found):
    """The URI of the same picture as WebP without loss, which needs about half of the bytes of PNG."""
    packed = io.BytesIO()
    Image.open(io.BytesIO(base64.b64decode(found[1]))).save(packed, "webp", lossless=True, exact=True)
    return as_uri(packed.getvalue(), "image/webp")


def inline_svg(text, name, label):
    """The drawing alone, with ids that are unique in the page. Namespaces and metadata are removed, since HTML needs
    neither. The title of a value becomes an attribute: the page has fewer elements, and its script need not visit them
    when it opens."""
    text = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg"):], flags=re.S)
    text = re.sub(r'\sxmlns(:\w+)?="[^"]*"', "", text)
    text = re.sub(r"(<circle [^>]*)><title>([^<]*)</title></circle>",
                  lambda found: f'{found[1]} data-value="{found[2].replace(chr(34), "&quot;")}"/>', text)
    text = re.sub(r'data:image/png;base64,([^"]*)', smaller, text)
    text = re.sub(r'\bid="([^"]+)"', rf'id="{name}-\1"', text)
    text = re.sub(r"url\(#([^)]+)\)", rf"url(#{name}-\1)", text)
    text = re.sub(r'(?:xlink:)?href="#([^"]+)"', rf'href="#{name}-\1"', text).replace("xlink:href=", "href=")
    return Markup(text.replace("<svg", f'<svg role="img" aria-label="{html.escape(label)}" tabindex="0" class="plot"',
                               1))


def as_uri(content, kind):
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def drawn(found, entry):
    """The figure's file, which is refused if its records are gone or have changed since."""
    file = found.results / "figures" / f"{entry.name}.svg"
    if found.judging != found.results and entries.not_asked_for(entry, found.results) and file.is_file():
        return file  # of the kept record
    absent = next((study for study in entry.studies() if study not in found.studies), None)
    if absent:
        raise records.RecordsMissing(record_set.why_absent(found, absent))
    entry.check(found.results)
    cause = file.with_suffix(".cause.txt")
    records.need(file.is_file() or not cause.is_file(), cause.is_file() and cause.read_text().strip())
    records.need(file.is_file(), "does not exist yet: paper_figures/make_all.py draws it")
    newest_s = max(behind.stat().st_mtime for behind in entry.files(found.results))
    if file.stat().st_mtime < newest_s - entries.slack_s:
        raise records.RecordsMissing("stale: its records are newer; draw it anew (paper_figures/make_all.py)")
    return file


def numbers_link(found, entry):
    file = found.results / "figures" / f"{entry.name}.csv"
    if not file.is_file():
        return ""
    inline = file.stat().st_size <= 1000 * most_inline_kb
    target = as_uri(file.read_bytes(), "text/csv") if inline else f"figures/{file.name}"
    apart = "" if inline else f" ({escaped(beside_the_page('files'))})"
    return Markup(f' <a download="{file.name}" href="{target}">numbers (CSV)</a>{apart}')


def drawn_figure(found, entry, number, file):
    known = {claim["id"] for claim in found.claims or []}
    title = entry.title if papers_own.match(entry.title) else f"Figure {number}: {entry.title}"
    from_record = found.judging != found.results and entries.not_asked_for(entry, found.results)
    about = [element("b", f"{title}. "), entry.caption, " Drawn from the kept record. " if from_record else " "]
    claims = joined((element("a", claim, href=f"#{claim}") if claim in known else claim for claim in entry.claims),
                    ", ")
    about += ["Claims: ", claims, ". "] if entry.claims else []
    about += [Markup(f'<abbr title="{html.escape(entries.marks[entry.mark])}">{entry.mark}</abbr>'),
              numbers_link(found, entry)]
    drawing = inline_svg(file.read_text(), entry.name, f"{entry.title}. {entry.caption}")
    return element("figure", joined([drawing, element("figcaption", joined(about))], "\n"), id=f"figure-{entry.name}")


def section(found):
    """The HTML of the figures, their entries, and a list of those that are missing."""
    parts, shown, causes, number = [], [], {}, 0
    for entry in entries.read():  # the paper's figures come first, and keep their numbers even if others are missing
        number += entry.title.startswith("Figure ")
        try:
            file = drawn(found, entry)
            # Title and caption are those of the time when it was drawn.
            as_drawn = dataclasses.replace(entry, **{part: captions.read(entry, found.results / "figures", part)
                                                     for part in ("title", "caption")})
            number += not papers_own.match(entry.title)
            parts.append(drawn_figure(found, as_drawn, number, file))
            shown.append(as_drawn)
        except records.RecordsMissing as error:
            causes.setdefault(str(error).replace(f"{found.results}/", ""), []).append(entry.name)
    missing = [f"figure{'s' * (len(names) > 1)} {', '.join(names)}: {cause}" for cause, names in causes.items()]
    intro = ("R: redrawn in minutes on any machine; CR: in hours; NR: not from this repository\u2019s records. "
             "With JavaScript, values are shown next to the pointer or the finger; with the keyboard: tab to a plot, "
             "then the arrow keys.")
    listed = element("ul", joined(element("li", line) for line in missing), class_="not-drawn") if missing else ""
    title = element("h3", "Not drawn") if missing else ""
    return joined([element("p", intro), element("div", joined(parts, "\n"), class_="figures"), title, listed],
                  "\n"), shown, missing
