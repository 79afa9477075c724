"""The interactive viewer as a piece of HTML for the report: its header, the frames and the program, all inline, no network.

    fragment = viewer_data.packed(results)               # <div id="viewer">, the data and the bundle
    links = viewer_data.claim_links(results)              # claim -> "#run=...", which opens the claim's pose in the viewer
    python3 paper_figures/viewer_data.py results/reproduce viewer.html    # a page with nothing else
"""
import base64
import html
import json
import os
import pathlib
import sys

from matplotlib import cm, colors

import records
import viewer_frames
import viewer_poses

most_bytes = 15_000_000  # of the viewer in a report that stays below 25 MB
skin, inverted, ratio_low, ratio_high = "#debe9e", "#d90059", 0.5, 1.5
folder = pathlib.Path(__file__).resolve().parent / "viewer"
how_to_build = "npm ci && npm run build, in paper_figures/viewer"
page = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>pbskin: recorded frames</title><link rel="icon" href="data:,"></head><body>
{body}
</body></html>
"""


def bundle_file():
    return pathlib.Path(os.environ.get("PBS_VIEWER_BUILD") or folder / "dist") / "viewer.js"


def shades_of(name):
    return [colors.to_hex(shade) for shade in cm.get_cmap(name)([step / 63 for step in range(64)])]


def colours():
    return {"ratio": {"low": ratio_low, "high": ratio_high, "shades": shades_of("PuOr")}, "error": {"shades": shades_of("viridis_r")},
            "skin": skin, "inverted": inverted}


def statements(results):
    """claim -> what the paper says, where the claims are on record."""
    file = results / "claims.json"
    return {claim["id"]: claim["statement"] for claim in records.read_json(file)["claims"]} if file.is_file() else {}


def pack(results):
    """Every frame, or every second, third, ... one where that is too much for a page. Header and base64 text."""
    for every in range(1, 100):
        header, block = viewer_frames.pack(results, every)
        text = base64.b64encode(block).decode()
        if len(text) <= most_bytes:
            return header, text
    raise records.RecordsMissing(f"{results / 'frames'}: too large for a page")


def packed(results):
    """The viewer's HTML; without the built program, what is missing and how to get it."""
    if not bundle_file().is_file():
        return f'<p class="missing" id="viewer">The interactive viewer is not built: {html.escape(how_to_build)}.</p>'
    header, block = pack(results)
    header.update(colours=colours(), poses=viewer_poses.poses_of(header["runs"]), claims=statements(results))
    words = json.dumps(header, separators=(",", ":"), allow_nan=False).replace("</", "<\\/")
    program = bundle_file().read_text().replace("</script", "<\\/script")
    return "\n".join((
        '<div id="viewer"><noscript>The viewer needs JavaScript.</noscript></div>',
        f'<script type="application/json" id="viewer-header">{words}</script>',
        f'<script type="application/octet-stream;base64" id="viewer-block">{block}</script>', f"<script>{program}</script>"))


def claim_links(results):
    """claim -> link that opens its pose."""
    runs = [viewer_frames.facts_of(recorded, 1) for recorded in viewer_frames.recorded_runs(results)]
    return {pose["claim"]: viewer_poses.link_of(pose) for pose in viewer_poses.poses_of(runs)}


def main(results, file):
    try:
        text = page.format(body=packed(results))
    except records.RecordsMissing as error:
        print(f"viewer: {error}", file=sys.stderr)
        return 1
    file.write_text(text)
    print(f"viewer: {file}, {len(text) / 1e6:.1f} MB")
    return 0 if bundle_file().is_file() else 1


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(*map(pathlib.Path, sys.argv[1:])))
