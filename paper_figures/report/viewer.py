"""The part of the page with the interactive viewer, or the reason why it is missing."""
import importlib

import records
from report.markup import Markup, element


def fragment(found):
    """(HTML or None, the reason for None)."""
    try:
        made = importlib.import_module("viewer.page").fragment(found.results)
    except (ImportError, records.RecordsMissing) as error:
        return None, str(error).replace(f"{found.results}/", "")
    return made, "" if made else "no frames are on record to show (pbskin reproduce frames), or the viewer was not built"


def pose_links(found):
    """For each claim, the link that opens its pose in the viewer."""
    return importlib.import_module("viewer.page").claim_links(found.results)


def section(found):
    """The HTML, what is missing, and links to the claims' poses."""
    made, reason = fragment(found)
    if made is None:
        return element("p", f"The viewer is missing: {reason}.", class_="missing"), [f"viewer: {reason}"], {}
    return Markup(made), [], pose_links(found)
