"""Numbers as people read them: three digits, ranges, counts.

    number_words.span([0.00123, 12.3456])  # 0.00123 to 12.3
"""


def figure(value):
    """Three digits, as in the table of claims, with a typographic minus."""
    if value is None or value != value:
        return "\u2013"
    digits = f"{value:.0f}" if 1000 <= abs(value) < 1e6 else f"{value:.3g}"
    return digits.replace("-", "\u2212")


def span(values, scale=1):
    """6.44 to 13, or the single value; None (not finite) is left out."""
    known = [scale * value for value in values if value is not None]
    low, high = figure(min(known, default=None)), figure(max(known, default=None))
    return low if low == high else f"{low} to {high}"


def span_of_thousandths(values):
    return span([round(value, 3) + 0.0 for value in values if value is not None])  # + 0.0: no minus before a zero


def listed(parts, between=", "):
    """The parts in one line, or a word that there are none."""
    return between.join(parts) or "none"


def counted(number, one, many=None):
    return f"{number} {one if number == 1 else many or one + 's'}"
