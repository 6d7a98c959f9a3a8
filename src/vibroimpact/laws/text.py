"""A contact law in words: what the command line and the documentation print, from the law's own declarations."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from dataclasses import MISSING, Field, dataclass, fields
from functools import cache
from typing import Any

from vibroimpact.cases.reader import load_case
from vibroimpact.cases.rigid import contact_pair
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.contact.pair import ContactPair
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.laws.plain_math import plain_text

ASKED = (0.9, 0.7, 0.5, 0.3)
"""The restitutions asked for, of which the one achieved is shown."""

SPEED = 8.8
"""The approach speed at which that is shown [m/s]: the paper's."""

_OF_BODIES = ("effective_radius", "effective_mass")
_ENDS = {
    "zero-indentation": "The contact is over when the bodies no longer overlap.",
    "zero-force": "The contact is over when the bodies no longer push each other apart.",
    "pull-off": "The contact is over when the bodies have been torn apart.",
}
_PULLS = {
    "none": "It never pulls.",
    "cut": "The formula would pull near the end; the force is cut at zero there.",
    "kept": "It may pull before the end.",
}
_AUTHORS = re.compile(r"[A-Z][\w-]+, [A-Z]\.[^()]*\(\d{4}\)")


@dataclass(frozen=True)
class ParameterText:
    """What there is to say of one parameter, or of one state, of a law."""

    name: str
    meaning: str
    unit: str
    allowed: str
    default: str


@dataclass(frozen=True)
class LawText:
    """A contact law in words.

    Texts keep the markup of the docstring; displayed formulas in `body` and `notes` are paragraphs that begin
    with ".. math::".

    Parameters
    ----------
    name, title, equation, source : str
        Its name, the first line of its docstring, its force in one line, and who published it.
    loses_by : str
        The parameters that set how much is lost.
    end, pulls : str
        How its contact ends and whether it pulls, in sentences.
    lasts : str
        Whether what it remembers outlasts the contact; "" if it remembers nothing.
    body, notes, references, raises : tuple of str
        Paragraphs of the docstring; one entry a reference.
    parameters, state : tuple of ParameterText
        What a case may give, and what the law remembers.
    """

    name: str
    title: str
    equation: str
    source: str
    loses_by: str
    end: str
    pulls: str
    lasts: str
    body: tuple[str, ...]
    notes: tuple[str, ...]
    references: tuple[str, ...]
    raises: tuple[str, ...]
    parameters: tuple[ParameterText, ...]
    state: tuple[ParameterText, ...]


def law_text(law: type[ContactLaw]) -> LawText:
    """Return a contact law in words.

    Parameters
    ----------
    law : type of ContactLaw
        The law's class.

    Examples
    --------
    >>> from vibroimpact.contact.law import find_contact_law
    >>> text = law_text(find_contact_law("flores"))
    >>> text.source, text.loses_by, text.parameters[0].default
    ('Flores et al. 2011, Multibody Syst. Dyn. 25:357', 'restitution', 'from the materials')
    """
    sections = _sections(inspect.cleandoc(law.__doc__ or law.name))
    first, *body = _paragraphs(sections[""])
    described = _described(sections.get("Parameters", ""))
    end, pulls, lasts = "It is over at once: it has no duration and no force.", "", ""
    if issubclass(law, CompliantLaw):
        end, pulls = _ENDS[law.contact_end], _PULLS[law.tension]
        if any(item.metadata["memory"] for item in fields(law)):
            lasts = (
                "The state lasts: the next impact on the same spot goes on with it."
                if law.lasting
                else "The state does not outlast the contact: the next impact begins anew."
            )
    return LawText(
        name=law.name,
        title=re.sub(r"[:,] :math:`[^`]*`\.?$", ".", first),
        equation=law.equation,
        source=law.source,
        loses_by=_loses_by(law),
        end=end,
        pulls=pulls,
        lasts=lasts,
        body=tuple(body),
        notes=tuple(_paragraphs(sections.get("Notes", ""))),
        references=tuple(_references(sections.get("References", ""))),
        raises=tuple(line.strip() for line in sections.get("Raises", "").splitlines() if line.startswith(" ")),
        parameters=tuple(_parameter(item, described) for item in fields(law) if not item.metadata["memory"]),
        state=tuple(_parameter(item, described) for item in fields(law) if item.metadata["memory"]),
    )


def plain_paragraph(paragraph: str) -> str:
    """Return a paragraph of a `LawText` as plain text."""
    return plain_text(re.sub(r"^\.\. math:: *(.*)$", r":math:`\1`", paragraph, flags=re.S))


@cache
def paper_pair() -> ContactPair:
    """Return the paper's pair: a rock sphere of 25 mm on a steel plate."""
    return contact_pair(load_case("paper:type1-theory"))


def asked_and_achieved(law: type[ContactLaw]) -> list[tuple[float, float]]:
    """Return the restitutions that a law is asked for and achieves, for the paper's sphere at 8.8 m/s.

    Empty for a law that has no parameter `restitution`.

    Examples
    --------
    >>> from vibroimpact.contact.law import find_contact_law
    >>> [(asked, round(achieved, 3)) for asked, achieved in asked_and_achieved(find_contact_law("flores"))]
    [(0.9, 0.894), (0.7, 0.683), (0.5, 0.47), (0.3, 0.256)]
    """
    if "restitution" not in {item.name for item in fields(law)}:
        return []
    pair = paper_pair()
    one = law.example(pair)
    return [(asked, float(achieved_restitution(one.changed({"restitution": asked}), pair.effective_mass, SPEED))) for asked in ASKED]


def short_source(law: type[ContactLaw]) -> str:
    """Return the authors and the year of a law's source, or what comes before the first comma.

    Examples
    --------
    >>> from vibroimpact.contact.law import find_contact_law
    >>> short_source(find_contact_law("jkr")), short_source(find_contact_law("adams-poisson"))
    ('Johnson, Kendall & Roberts 1971', 'MSC Adams/Solver guide')
    """
    found = re.match(r"[^\d;]*\b\d{4}\b", law.source)
    return found[0] if found else law.source.split(",")[0]


def _loses_by(law: type[ContactLaw]) -> str:
    """Return the name of the free parameter, and of what may be given in its place."""
    free = law.example(paper_pair()).free_parameter
    if free is None:
        return "nothing is lost"
    instead = [item.name for item in fields(law) if item.default is None and not item.metadata["from_pair"]]
    return " or ".join(instead) if free in instead else free


def _parameter(item: Field[Any], described: dict[str, str]) -> ParameterText:
    metadata = item.metadata
    meaning = described.get(item.name) or f"{metadata['meaning'][0].upper()}{metadata['meaning'][1:]}."
    return ParameterText(item.name, meaning, metadata["unit"], metadata["range"].words, _default(item))


def _default(item: Field[Any]) -> str:
    """Return where a parameter comes from if a case leaves it out."""
    source = item.metadata["from_pair"]
    if source:
        return "from the bodies" if source in _OF_BODIES else "from the materials"
    if item.default is MISSING:
        typical = item.metadata["example"]
        return "required" if typical is None else f"required, such as {typical:g}"
    return "optional" if item.default is None else f"{item.default:g}"


def _sections(doc: str) -> dict[str, str]:
    """Return the sections of a numpydoc docstring by their headings; what comes first has none."""
    parts = re.split(r"^(\w[\w ]*)\n-{3,}\n", doc, flags=re.M)
    return {"": parts[0], **dict(zip(parts[1::2], parts[2::2], strict=True))}


def _paragraphs(text: str) -> list[str]:
    """Return the paragraphs, each in one line."""
    return [" ".join(line.strip() for line in part.splitlines()) for part in re.split(r"\n\s*\n", text.strip()) if part.strip()]


def _references(text: str) -> Iterator[str]:
    """Yield the references, each in one line: a new one begins with its authors and a year."""
    lines: list[str] = []
    for line in text.strip().splitlines():
        if _AUTHORS.match(line) and lines:
            yield " ".join(lines)
            lines = []
        lines.append(line.strip())
    if lines:
        yield " ".join(lines)


def _described(text: str) -> dict[str, str]:
    """Return the meaning of each parameter, without unit and range, which are declared and printed apart."""
    parts = re.split(r"^(\w[\w, ]*) : .*\n", text, flags=re.M)
    found = {}
    for names, part in zip(parts[1::2], parts[2::2], strict=True):
        meaning = " ".join(line.strip() for line in part.splitlines()).strip().removeprefix("State: ")
        meaning = re.sub(r" \[[^\]`]*\](?=[ ,.;(:])", "", meaning, count=1)
        meaning = re.sub(r", (?:(?:>=?|<=?) [\d.]*\d|in [\[(][^\])]*[\])])(?=[ ,.;:])", "", meaning, count=1)
        for name in names.split(", "):
            found[name] = f"{meaning[:1].upper()}{meaning[1:]}"
    return found
