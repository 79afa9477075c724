"""The terms of the suite (glossary.toml), and links to them.

    for entry in glossary.entries(): ...          # name, slug (GitHub's anchor of the heading), sentence, also
    text = glossary.linked(text, seen)            # HTML in which the first use of each term not in `seen` is a link
"""
import collections
import functools
import html
import pathlib
import re
import tomllib

unlinked = frozenset("a button code dt h1 h2 h3 h4 h5 h6 label nav option pre script style summary svg title".split())
Entry = collections.namedtuple("Entry", ("name", "slug", "sentence", "also"))


def entries():
    listed = tomllib.loads(pathlib.Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
    return [Entry(name, re.sub(r"[^\w\- ]", "", name.lower()).replace(" ", "-"), of["sentence"],
                  tuple(of.get("also", ())))
            for name, of in listed.items()]


@functools.cache
def uses():
    """The entry of each group of the pattern, and the pattern of all uses; the longest one comes first."""
    words = sorted(((word, entry) for entry in entries() for word in (entry.name, *entry.also)),
                   key=lambda pair: -len(pair[0]))
    first = [f"[{word[0].upper()}{word[0].lower()}]" if word[1].islower() else word[0] for word, _ in words]
    patterns = [f"({letter}{re.escape(word[1:])}s?)".replace("'", "(?:'|&#x27;|\u2019)")
                for letter, (word, _) in zip(first, words)]
    return [entry for _, entry in words], re.compile(rf"(?<![\w.-])(?:{'|'.join(patterns)})(?![\w-])".replace(
        r"\ ", r"\s+"))


def linked(html_text, seen):
    """The slugs of the terms that it links are added to `seen`. Tags, links, code and headings stay as they are."""
    def link(match):
        entry = uses()[0][match.lastindex - 1]
        if entry.slug in seen:
            return match[0]
        seen.add(entry.slug)
        return f'<a class="term" href="#term-{entry.slug}" title="{html.escape(entry.sentence)}">{match[0]}</a>'

    parts, depth = re.split(r"(<[^>]*>)", html_text), 0
    for i, part in enumerate(parts):
        if tag := re.match(r"<(/?)(\w+)", part):
            depth += (-1 if tag[1] else 1) * (tag[2].lower() in unlinked and not part.endswith("/>"))
        elif depth == 0 and not part.startswith("<"):
            parts[i] = uses()[1].sub(link, part)
    return type(html_text)("".join(parts))
