"""Pieces of HTML. Text that is not Markup is escaped.

    markup.table("Costs", ["study", "minutes"], [["volume", "1.5"]])
"""
import html
import re
import urllib.parse


class Markup(str):
    """HTML that is not escaped again."""


def escaped(value):
    return value if isinstance(value, Markup) else Markup(html.escape(str(value)))


def element(tag, content, **attributes):
    """An element. class_ and the like lose their underscore; other underscores in names become hyphens."""
    written = "".join(f' {name.rstrip("_").replace("_", "-")}="{html.escape(str(value))}"'
                      for name, value in attributes.items())
    return Markup(f"<{tag}{written}>{escaped(content)}</{tag}>")


def joined(parts, between=""):
    return Markup(between.join(escaped(part) for part in parts))


def inline(text):
    """Renders Markdown's code, emphasis and strong emphasis."""
    text = re.sub(r"`([^`]*)`", r"<code>\1</code>", html.escape(text))
    text = re.sub(r"\*\*([^*]+)\*\*", r"<strong>\1</strong>", text)
    return Markup(re.sub(r"(?<!\w)\*([^*]+)\*(?!\w)", r"<em>\1</em>", text))


def table(name, header, rows, class_=""):
    """A table in a box that scrolls if the table is wider than the page; the first cell of each row is its header."""
    head = joined(element("th", cell, scope="col") for cell in header)
    body = joined((row_of(row) for row in rows), "\n")
    whole = f"<table><caption>{escaped(name)}</caption><thead><tr>{head}</tr></thead><tbody>\n{body}\n</tbody></table>"
    return element("div", Markup(whole), class_=f"scroll {class_}".strip(), tabindex=0, role="region", aria_label=name)


def row_of(cells):
    first, *others = cells
    return Markup(f"<tr>{element('th', first, scope='row')}" + joined(element("td", cell) for cell in others) + "</tr>")


def details(summary, content):
    return Markup(f"<details><summary>{escaped(summary)}</summary>{escaped(content)}</details>")


def items(entries, class_=""):
    return element("ul", joined((element("li", entry) for entry in entries), "\n"), class_=class_)


def folder_link(results, name):
    """A link to a folder next to the page, if that folder exists."""
    if not (results / name).exists():
        return escaped(name)
    return element("a", name, href=urllib.parse.quote(name) + "/")


def beside_the_page(what):
    """A note for links to files outside the page, which a copy of the page alone cannot open."""
    return f"{what} next to this page; where the page was moved without them, their links do not work"
