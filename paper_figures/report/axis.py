"""The cases' numbers of a claim on a small axis: the threshold as a shaded band, each case as a dot, each control as a
mark below."""
import math

from report.markup import Markup, element, escaped
from words import case_words, sentences
from words.number_words import counted, figure

width, height, margin = 320, 34, 6  # [px]
log_from = 30  # numbers of which the largest is so many times the smallest are drawn on a logarithmic scale


class Scale:
    """From numbers to places [px]: from the least to the most of them, linear or logarithmic."""

    def __init__(self, numbers):
        self.is_log = min(numbers) > 0 and max(numbers) / min(numbers) >= log_from
        low, high = (self.of(end(numbers)) for end in (min, max))
        room = 0.06 * (high - low) or 0.5 * abs(low) or 1.0
        self.low, self.high = low - room, high + room

    def of(self, number):
        return math.log10(number) if self.is_log else number

    def place(self, number):
        if self.is_log and number <= 0:
            return margin
        share = (self.of(number) - self.low) / (self.high - self.low)
        return margin + (width - 2 * margin) * min(1.0, max(0.0, share))


def known(cases):
    return [case for case in cases if case["value"] is not None and math.isfinite(case["value"])]


def drawn(claim):
    """The axis of the claim's first quantity; nothing where no case has a number, or each has a threshold of its
    own."""
    if claim["rule"] == "printed":
        return ""
    groups = {quantity: known(cases) for quantity, cases in sentences.by_quantity(claim).items()}
    quantity, tested = next(((name, cases) for name, cases in groups.items() if cases), (None, []))
    if not tested:
        return ""
    of_one_threshold = [case for case in tested if all(case[end] == tested[0][end]
                                                       for end in ("threshold_low", "threshold_high"))]
    tested = of_one_threshold
    others = sum(len(cases) for cases in groups.values()) - len(tested)
    controls = [(f"{of['name']}, {case_words.of_field('role', of['role'])}",
                 known(sentences.by_quantity(of).get(quantity, [])))
                for of in claim["controls"]]
    low, high = tested[0]["threshold_low"], tested[0]["threshold_high"]
    ends = [end for end in (low, high) if end is not None]
    scale = Scale([case["value"] for case in tested] + [middle(cases) for _, cases in controls if cases] + ends)
    parts = []
    if ends:
        left, right = (edge if end is None else scale.place(end) for end, edge in ((low, 0), (high, width)))
        parts.append(f'<rect class="threshold" x="{left:.1f}" y="2" width="{max(right - left, 1):.1f}" height="18"/>')
    parts.append(f'<line class="line" x1="0" x2="{width}" y1="20" y2="20"/>')
    colours = [("holds" if case["holds"] else "fails") if ends else "control" for case in tested]
    parts += [f'<circle class="{colour}" cx="{scale.place(case["value"]):.1f}" cy="11" r="3"/>'
              for case, colour in zip(tested, colours)]
    parts += [f'<path class="control" d="M{scale.place(middle(cases)):.1f} 21l4 '
              f'8h-8z"><title>{escaped(name)}</title></path>'
              for name, cases in controls if cases]
    label = (f"{sentences.title(claim, quantity)}: {sentences.span(tested)}; threshold: "
             f"{sentences.threshold(tested[0]) or 'none'}")
    label += f"; {counted(others, 'more number has', 'more numbers have')} other thresholds" if others else ""
    # The label is for those who do not see the picture.
    kinds = [f"control {name}: {figure(middle(cases))}" for name, cases in controls if cases]
    picture = Markup(f'<svg class="axis" viewBox="0 0 {width} {height}" role="img" '
                     f'aria-label="{escaped("; ".join([label, *kinds]))}">{"".join(parts)}</svg>')
    return Markup(picture + element("span", label, class_="under"))


def middle(cases):
    ordered = sorted(case["value"] for case in cases)
    return ordered[len(ordered) // 2]
