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


def section(found):
    """HTML, and what is missing."""
    made, reason = fragment(found)
    if made is None:
        return element("p", f"The viewer is missing: {reason}.", class_="missing"), [f"viewer: {reason}"]
    return Markup(made), []
