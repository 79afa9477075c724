"""The name of each verdict, the same on the whole page, with its symbol and the class of its colour."""
from words import sentences

marks = {
    "reproduced": ("\u2714", "holds"),
    "reproduced_only_for": ("\u25d0", "partly"),
    "not_reproduced": ("\u2718", "fails"),
    "inconsistent_in_print": ("\u2260", "print"),
    "cannot_be_tested_here": ("\u25cb", "untested"),
    "not_computable": ("?", "fails"),
}


def mark_of(verdict):
    """(symbol, class, name)"""
    return (*marks[verdict], name_of(verdict))


def name_of(verdict):
    return sentences.names[verdict]


def counted_in_words(claims):
    """3 are reproduced, 1 is reproduced in part, ..."""
    counts = {verdict: sum(claim["verdict"] == verdict for claim in claims) for verdict in marks}
    return ", ".join(f"{count} {with_verb(name_of(verdict), count)}" for verdict, count in counts.items() if count)


def with_verb(name, count):
    return name if name.startswith("cannot") else f"{'is' if count == 1 else 'are'} {name}"
