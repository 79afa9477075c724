"""Writes the parts of README.md and of other pages that come from records, each between two markers of its own. Nobody
edits them by hand.

    # writes claims.json there; git ignores it
    build/release/bin/pbskin reproduce --judge -o experiments/records/full
    # all parts except reliability
    python3 paper_figures/make_readme.py experiments/records/full
    # the counts that the tests of ./check --long wrote
    python3 paper_figures/make_readme.py results/check/reliability reliability

claims: one line per claim in the README; findings: its findings; methods: which method in which time, with its figure;
features: the table of the study that switches features off; kept: the generated parts of the studies' READMEs and of
the claims' pages; glossary: the terms of experiments/GLOSSARY.md with their picture; reliability: the table of
tests/README.md. Exit status 2 if the records or a page are not as expected.
"""
import pathlib
import sys

from readme import findings, joint, pages, part, tables
from records import kept


def glossary_pages(_):
    joint.draw(tables.glossary_page.with_name("glossary.svg"))
    return {tables.glossary_page: tables.glossary_lines()}


parts = {"claims": lambda results: {part.own_readme: tables.claims_lines(results)},
         "findings": lambda results: {part.own_readme: findings.lines_of(results)},
         "methods": lambda results: {part.own_readme: findings.drawn_methods_lines(results)},
         "features": lambda results: {tables.features_page: tables.features_lines(results)}, "kept": pages.pages,
         "glossary": glossary_pages,
         "reliability": lambda folder: {tables.reliability_page: tables.reliability_lines(folder)}}


def main(arguments):
    folder, names = arguments[:1], arguments[1:] or ["claims", "findings", "methods", "features", "kept", "glossary"]
    if not folder or folder[0].startswith("-") or not set(names) <= set(parts):
        print(__doc__, file=sys.stderr)
        return 2
    results = kept.opened(pathlib.Path(folder[0]))
    return max(part.main(name, parts[name], results) for name in names)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
