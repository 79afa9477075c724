"""The interactive viewer's place in the page; where there is none, why."""
import importlib

import records
from report.markup import Markup, element


def fragment(found):
    """(HTML or None, why not)."""
    try:
        made = importlib.import_module("viewer_html").fragment(found.results)
    except (ImportError, records.RecordsMissing) as error:
        return None, str(error).replace(f"{found.results}/", "")
    return made, "" if made else "no frames are on record to show (pbskin reproduce frames), or the viewer was not built"


def pose_links(found):
    """claim -> link that opens its pose in the viewer."""
    return getattr(importlib.import_module("viewer_html"), "claim_links", lambda results: {})(found.results)


def section(found):
    """HTML, what is missing, and links to the claims' poses."""
    made, reason = fragment(found)
    if made is None:
        return element("p", f"The viewer is missing: {reason}.", class_="missing"), [f"viewer: {reason}"], {}
    return Markup(made), [], pose_links(found)
