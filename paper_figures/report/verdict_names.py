"""What each verdict on record is called on the page, everywhere the same, with its symbol and the class of its colour."""

marks = {
    "reproduced": ("\u2714", "holds", "reproduced"),
    "reproduced only for": ("\u25d0", "partly", "reproduced in part"),
    "not reproduced": ("\u2718", "fails", "not reproduced"),
    "inconsistent in print": ("\u2260", "print", "inconsistent in print"),
    "cannot be tested here": ("\u25cb", "untested", "cannot be tested here"),
    "not computable": ("?", "fails", "not computable"),
}


def mark_of(verdict):
    """(symbol, class, name); one that is not known keeps its word."""
    return marks.get(verdict, ("?", "untested", verdict))


def name_of(verdict):
    return mark_of(verdict)[2]


def counted_in_words(claims):
    """3 are reproduced, 1 is reproduced in part, ..."""
    counts = {}
    for verdict in [*marks, *(claim["verdict"] for claim in claims)]:
        counts[verdict] = sum(claim["verdict"] == verdict for claim in claims)
    return ", ".join(f"{count} {with_verb(name_of(verdict), count)}" for verdict, count in counts.items() if count)


def with_verb(name, count):
    return name if name.startswith("cannot") else f"{'is' if count == 1 else 'are'} {name}"
