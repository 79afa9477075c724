"""The interactive viewer as a piece of HTML for the report: its header, the frames and the program, all inline, without
network access.

    fragment = page.fragment(results)               # <div id="frame-viewer">, the data and the bundle
    links = page.claim_links(results)              # claim -> "#run=...", which opens the claim's pose in the viewer
    python3 -m viewer.page results/reproduce viewer.html    # in paper_figures: a page with nothing else
"""
import base64
import html
import json
import math
import os
import pathlib
import sys

from matplotlib import colors

import records
from drawing import rendering
from viewer import data as viewer_data

most_bytes = 5_000_000  # limit for the viewer, so that the report stays below 12 MB
# From the colour of the skin to dark ones, so that what agrees with the reference looks like skin.
difference_colors = colors.LinearSegmentedColormap.from_list("difference",
                                                             [rendering.skin_color, "#F4A040", "#D3341E", "#5A0F46"])
overlap_colors = colors.LinearSegmentedColormap.from_list("overlap", ["#F08A70", "#7A0016"])
folder = pathlib.Path(__file__).resolve().parent
how_to_build = "npm ci && npm run build, in paper_figures/viewer"
page = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>pbskin: recorded frames</title><link rel="icon" href="data:,"></head><body>
{body}
</body></html>
"""


first_run = "human_jump"  # which is shown at first, if it is there


def bundle_file():
    return pathlib.Path(os.environ.get("PBS_VIEWER_BUILD") or folder / "dist") / "viewer.js"


def shades_of(colormap):
    return [colors.to_hex(shade) for shade in colormap([step / 63 for step in range(64)])]


def colours():
    """The same colours as in the stills."""
    scale = rendering.ratio_scale
    return {"ratio": {"low": scale.vmin, "high": scale.vmax, "shades": shades_of(rendering.ratio_colors)},
            "error": {"shades": shades_of(difference_colors)}, "skin": colors.to_hex(rendering.skin_color),
            "contact": {"touching": "#2A9D8F", "shades": shades_of(overlap_colors)},
            "inverted": colors.to_hex(rendering.inverted_color)}


def statements(results):
    """For each claim its statement in the paper, if the claims are on record."""
    file = results / "claims.json"
    return {claim["id"]: claim["statement"] for claim in records.read_json(file)["claims"]} if file.is_file() else {}


def pack(recorded):
    """Packs every frame, or every second, third, ... one if all are too many for a page. Returns the header and base64
    text."""
    for every in range(1, 100):
        header, block = viewer_data.pack(recorded, every)
        text = base64.b64encode(block).decode()
        if len(text) <= most_bytes:
            return header, text
    raise records.RecordsMissing(f"{recorded[0].folder / 'frames'}: too large for a page")


def fragment(results):
    """The HTML of the viewer for the study `frames`. RecordsMissing if frames are missing or the program is not built;
    the message states how to get it."""
    return fragment_of(viewer_data.recorded_runs(results), statements(results))


def fragment_of(recorded, claims=None):
    """The HTML of the viewer for these runs."""
    bundle = program()
    return f"{data_of(recorded, claims)}\n{bundle}"


def program():
    """The script that shows the data of a page."""
    records.need(bundle_file().is_file(), f"{bundle_file().name} is not built: {how_to_build}")
    return f'<script type="module">{bundle_file().read_text().replace("</script", "<" + chr(92) + "/script")}</script>'


def data_of(recorded, claims=None):
    """The place of the viewer in the page and what it shows, without the program."""
    header, block = pack(recorded)
    header.update(colours=colours(), first=first_run, poses=poses_of(header["runs"]), claims=claims or {})
    words = json.dumps(header, separators=(",", ":"), allow_nan=False).replace("</", "<\\/")
    broken = [f"{run['title']}: {of['title']} is not shown, for a position in frame {of['frame']} is not finite."
              for run in header["runs"] for of in run["left_out"]]
    return "\n".join((
        '<div id="frame-viewer"><noscript>The viewer needs JavaScript.</noscript></div>',
        *(f'<p class="missing">{html.escape(words)}</p>' for words in broken),
        f'<script type="application/json" id="viewer-header">{words}</script>',
        f'<script type="application/octet-stream;base64" id="viewer-block">{block}</script>'))


# The recorded frame that shows a claim best: the one in which a recorded number of a deformer is at its extreme, opened
# by a link such as `#run=limb_twist&frame=18&colour=ratio&claim=C01`. Claim, run, deformer and its column, which
# extreme, colouring, panels, description.
poses = (
    ("C01", "limb_twist", "lbs", "volume_change_pct", min, "ratio", "", "LBS loses most volume"),
    ("C02a", "human_jump", "pbs", "volume_change_pct", "far", "ratio", "", "PBS is farthest from the volume at rest"),
    ("C03", "human_jump", "pbs_increment", "error_linf_m", max, "error", "lbs,pbs,pbs_increment,nh_p1",
     "PBS without the start from LBS is farthest from FEM"),
    ("C04", "limb_twist", "lbs", "min_section_pct", min, "skin", "lbs,dqs,pbs,nh_p1", "LBS has its thinnest section"),
    ("C05", "limb_bend", "dqs", "error_joint_pct", max, "error", "lbs,dqs,pbs,nh_p1", "DQS errs most at the joint"),
    ("C09a", "human_walk", "pbs_jiggle", "error_linf_m", max, "error", "lbs,pbs_no_zone,pbs_jiggle,nh_p1",
     "jiggling flesh is farthest from FEM; for comparison, the same stiffness without a jiggling zone"),
    ("C12a", "human_jump", "pbs", "error_joint_pct", max, "error", "",
     "PBS with 24 iterations errs most at the joints"),
)


def position_of(values, extreme):
    """The index of the extreme among the recorded values; None without values."""
    known = [(abs(value) if extreme == "far" else value, at) for at, value in enumerate(values)
             if value is not None and math.isfinite(value)]
    return (max if extreme == "far" else extreme)(known, key=lambda pair: pair[0])[1] if known else None


def poses_of(runs):
    """The poses whose run and deformer are packed, in the format of the viewer."""
    named = {run["name"]: run for run in runs}
    found = []
    for claim, run, label, column, extreme, colour, panels, what in poses:
        known = {deformer["label"]: deformer for deformer in named[run]["deformers"]} if run in named else {}
        if label not in known:
            continue
        panels = ",".join(panel for panel in panels.split(",") if panel in known)
        at = position_of(known[label]["figures"][column], extreme)
        if at is not None:
            found.append({"claim": claim, "run": run, "frame": named[run]["frames"][at], "colour": colour,
                          "panels": panels, "what": what})
    return found


def claim_links(results):
    """For each claim, the link that opens its pose."""
    runs = [viewer_data.facts_of(recorded, 1) for recorded in viewer_data.recorded_runs(results)]
    return {pose["claim"]: f"#run={pose['run']}&frame={pose['frame']}&colour={pose['colour']}"
                           + (f"&panels={pose['panels']}" if pose["panels"] else "") + f"&claim={pose['claim']}"
            for pose in poses_of(runs)}


def main(results, file):
    try:
        text = page.format(body=fragment(results))
    except records.RecordsMissing as error:
        print(f"viewer: {error}", file=sys.stderr)
        return 1
    file.write_text(text)
    print(f"viewer: {file}, {len(text) / 1e6:.1f} MB")
    return 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(*map(pathlib.Path, sys.argv[1:])))
