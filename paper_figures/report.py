"""One self-contained page from what is on disk: the table of claims, the drawn figures, where the records come from.

    python3 paper_figures/report.py results/reproduce
"""
import base64
import html
import pathlib
import re
import sys

import claims_table
import records

captions = {
    "volume_over_angle": "Volume change of the limb over the angle of twist and bend.",
    "volume_over_clip": "Volume change of the human over the clip; triangles mark the stills.",
    "volume_over_iterations": "PBS volume change against the number of iterations.",
    "frames_skin": "The human under LBS, PBS and FEM.",
    "frames_volume_ratio": "The same frames, each tet coloured by its volume ratio.",
    "verification": "The finite element reference against theory and published benchmarks.",
}
studies = {"verification": "verification"}  # whose records a figure shows; else those of the study volume
page = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>pbskin: claims</title>
<style>
body {{ font: 15px/1.45 sans-serif; max-width: 75em; margin: 2em auto; padding: 0 1em; color: #111; }}
table {{ border-collapse: collapse; display: block; overflow-x: auto; }}
th, td {{ border: 1px solid #bbb; padding: .3em .6em; text-align: left; vertical-align: top; }}
img {{ max-width: 100%; }} figure {{ margin: 2em 0; }} .missing {{ color: #a00; }}
</style></head><body>
<h1>Position Based Skinning: claims against measurements</h1>
{body}
</body></html>
"""


def inline(text):
    """Escaped text; Markdown's code and emphasis become HTML's."""
    text = re.sub(r"`([^`]*)`", r"<code>\1</code>", html.escape(text))
    text = re.sub(r"\*\*([^*]+)\*\*", r"<strong>\1</strong>", text)
    return re.sub(r"(?<!\w)\*([^*]+)\*(?!\w)", r"<em>\1</em>", text)


def html_table(lines):
    header, _, *body = [claims_table.cells(line) for line in lines]
    rows = ["<tr>" + "".join(f"<th>{inline(cell)}</th>" for cell in header) + "</tr>"]
    rows += ["<tr>" + "".join(f"<td>{inline(cell)}</td>" for cell in row) + "</tr>" for row in body]
    return "<table>" + "\n".join(rows) + "</table>"


def html_figures(results):
    parts = []
    for name, caption in captions.items():
        file = results / "figures" / f"{name}.png"
        if not file.is_file() and not (results / studies.get(name, "volume")).is_dir():
            continue
        if not file.is_file():
            parts.append(f'<p class="missing">{html.escape(name)}: not drawn</p>')
            continue
        data = base64.b64encode(file.read_bytes()).decode()
        parts.append(f'<figure><img alt="{html.escape(caption)}" src="data:image/png;base64,{data}">'
                     f"<figcaption>{html.escape(caption)}</figcaption></figure>")
    return "\n".join(parts)


def html_claims(results):
    if not (results / "claims.md").is_file() and (results / "verification").is_dir():
        return []
    return ["<h2>Claims</h2>", html_table(claims_table.table_lines(results))]


def html_verification(results):
    """The reference's own record, where that study was run: its table, and the notes below it."""
    file = results / "verification" / "verification.md"
    if not file.is_file():
        return []
    notes = [line.split(". ", 1)[1] for line in file.read_text().splitlines() if re.match(r"[0-9]+\. ", line)]
    return ["<h2>Verification of the finite element reference</h2>", html_table(claims_table.lines_of_first_table(file)),
            "<ol>" + "".join(f"<li>{inline(note)}</li>" for note in notes) + "</ol>"]


def html_provenance(facts):
    def text(value):
        return ", ".join(f"{key} {entry}" for key, entry in value.items()) if isinstance(value, dict) else str(value)

    rows = "\n".join(f"<tr><th>{html.escape(key)}</th><td>{html.escape(text(value))}</td></tr>" for key, value in facts.items())
    return f"<table>{rows}</table>"


def main(results):
    try:
        parts = [*html_claims(results), *html_verification(results), "<h2>Figures</h2>", html_figures(results),
                 "<h2>Where the records come from</h2>", html_provenance(records.provenance(results))]
    except records.RecordsMissing as error:
        print(f"report: {error}", file=sys.stderr)
        return 1
    (results / "report.html").write_text(page.format(body="\n".join(parts)))
    return 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1])))
