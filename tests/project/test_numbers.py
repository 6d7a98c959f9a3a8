"""Every number of the pages that people meet first is held by a test, is an input, has a
source, or carries its machine and day.
"""

from __future__ import annotations

import ast
import re
import tomllib
from collections.abc import Iterator
from functools import cache
from itertools import chain

import pytest

from stated_numbers import NUMBER, ROOT, pattern

CLAIMS = ROOT / "tests" / "claims"
GENERATED = {"docs/reproduction.md", "docs/validation.md"}
"""Written by the program and by tests, which have tests of their own."""

PAGES = [
    page.relative_to(ROOT).as_posix()
    for page in [
        ROOT / "README.md",
        *sorted(ROOT.glob("docs/*.md")),
        *sorted(ROOT.glob("docs/guides/*.md")),
    ]
    if page.relative_to(ROOT).as_posix() not in GENERATED
]

NOT_YET: set[str] = set()
"""Pages with numbers that nothing holds yet."""

DATED = re.compile(r"\b20\d\d-\d\d-\d\d\b")
"""A section with a day holds measurements of time and memory; their machine stands beside it."""

ORIGIN = re.compile(r"(input|source|time): .{5,}|(tests/\S+\.py)::(\w+)")
"""Where a number is from that no test of claims computes: a value of the case that the page
describes, a publication, a machine and day that stand elsewhere on the page, or a test that holds
it."""

_TOKEN = re.compile(
    rf"(?<![\w.,/^-])({NUMBER})(?![\w/]|\.\d|-\d)(\s?(?:%|[a-zµ°]+\b))?", re.IGNORECASE
)
_SMALL = 12
"""Whole numbers up to it, without a unit, count things that the sentence itself lists."""


@cache
def held_sentences() -> dict[str, list[re.Pattern[str]]]:
    """Return the patterns of the sentences that tests hold, by page: from the calls of
    `says` in tests/claims.
    """
    sentences: dict[str, list[re.Pattern[str]]] = {}
    for path in sorted(CLAIMS.glob("test_*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        constants = {
            target.id: node.value.value
            for node in tree.body
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant)
            for target in node.targets
            if isinstance(target, ast.Name)
        }
        for node in ast.walk(tree):
            if not (
                isinstance(node, ast.Call)
                and isinstance(node.func, ast.Name)
                and node.func.id == "says"
            ):
                continue
            page, sentence = (
                constants.get(one.id) if isinstance(one, ast.Name) else ast.literal_eval(one)
                for one in node.args[:2]
            )
            constant = isinstance(page, str) and isinstance(sentence, str)
            assert constant, f"{path.name}, line {node.lineno}: page and sentence are constants"
            sentences.setdefault(page, []).append(pattern(prose(sentence)))
    return sentences


@cache
def statements(page: str) -> dict[str, str]:
    """Return the sentences of a page whose numbers no test of claims computes, and where
    they are from.
    """
    path = CLAIMS / "statements" / f"{page.removesuffix('.md').replace('/', '-')}.toml"
    return tomllib.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def sections(text: str) -> list[str]:
    """Return the sections of a page, without their blocks of code."""
    text = re.sub(r"^(```|~~~).*?^\1[ \t]*$", "", text, flags=re.M | re.S)
    return re.split(r"^#+ .*$", text, flags=re.M)


def prose(text: str) -> str:
    """Return a text without formulas, code, comments, links' targets and pictures' names."""
    text = re.sub(r"\$\$.*?\$\$|(?<![\w$])\$[^$\n]+\$|`[^`\n]+`", " ` ", text, flags=re.S)
    text = re.sub(r"<!--.*?-->", "", text, flags=re.S)
    return re.sub(r"\]\([^)]*\)", "]", text)


def paragraphs(text: str) -> Iterator[str]:
    """Yield the prose of a section; a table is one paragraph."""
    for paragraph in re.split(r"\n\s*\n", prose(text)):
        yield " ".join(paragraph.split())


def inputs_of(text: str) -> set[float]:
    """Return the numbers in the cases, commands and programs of a page."""
    blocks = re.findall(r"^```(?:toml|console|python|sh)\n(.*?)^```", text, flags=re.M | re.S)
    return {_value(number) for block in blocks for number in re.findall(NUMBER, block)}


def unheld(page: str) -> list[str]:
    """Return the numbers of a page that nothing holds, with the words around them."""
    text = (ROOT / page).read_text(encoding="utf-8")
    given = inputs_of(text)
    claims = [
        *held_sentences().get(page, []),
        *(pattern(prose(sentence)) for sentence in statements(page)),
    ]
    free = []
    undated = (section for section in sections(text) if not DATED.search(section))
    for paragraph in chain.from_iterable(map(paragraphs, undated)):
        covered = [match.span() for claim in claims for match in claim.finditer(paragraph)]
        for match in _TOKEN.finditer(paragraph):
            begin, end = match.span(1)
            whole = match[1].isdigit()
            if (
                any(first <= begin and end <= last for first, last in covered)
                or _value(match[1]) in given
            ):
                continue
            if whole and not match[2] and (int(match[1]) <= _SMALL or 1600 <= int(match[1]) < 2100):
                continue
            free.append(f"{match[1]}: ...{paragraph[max(0, begin - 50) : end + 30]}...")
    return free


def _value(number: str) -> float:
    return abs(float(number.replace(",", "")))


@pytest.mark.parametrize("page", PAGES)
def test_every_number_is_held(page: str) -> None:
    free = unheld(page)
    if page in NOT_YET:
        assert free, f"{page} is whole and leaves NOT_YET"
        return
    assert not free, "\n".join(
        [
            f"{page}: hold it in tests/claims, or say in tests/claims/statements where it is from",
            *free,
        ]
    )


@pytest.mark.parametrize("page", PAGES)
def test_statements_are_there(page: str) -> None:
    """A sentence that left its page leaves the list, and a test that is named exists."""
    every = [
        *chain.from_iterable(map(paragraphs, sections((ROOT / page).read_text(encoding="utf-8"))))
    ]
    for sentence, origin in statements(page).items():
        assert any(pattern(prose(sentence)).search(paragraph) for paragraph in every), (
            f"{page} does not say {sentence!r}"
        )
        told = ORIGIN.fullmatch(origin)
        assert told, f"{page}: {sentence!r} has the origin {origin!r}"
        if told[2]:
            assert f"def {told[3]}(" in (ROOT / told[2]).read_text(encoding="utf-8"), (
                f"{page}: there is no test {origin}"
            )
