"""The description of a contact or friction law that the command line and the
documentation print, from its declarations and docstring.
"""

from __future__ import annotations

from dataclasses import MISSING, Field, dataclass, fields
from functools import cache
from typing import Any

from vibroimpact.cases.reader import load_case
from vibroimpact.cases.rigid.pair import contact_pair
from vibroimpact.contact.docstring import docstring_sections
from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.contact.law import CompliantLaw, ContactLaw, InstantaneousLaw, default_origin
from vibroimpact.contact.pair import ContactPair
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.law_sheets.plain_math import plain_math, plain_text

ASKED = (0.9, 0.7, 0.5, 0.3)
"""The restitutions asked for at which the achieved restitution is shown."""

SPEED = 8.8
"""The approach speed at which the achieved restitution is shown [m/s], that of the paper."""

_ENDS = {
    "zero-indentation": "On a rigid plate the contact ends at zero indentation.",
    "zero-force": "On a rigid plate the contact ends at zero force.",
    "pull-off": "On a rigid plate the contact ends at pull-off.",
}
_TENSION = {
    "none": "The force is not tensile there.",
    "cut": "Where the formula gives a tensile force, the force is zero.",
    "kept": "The force may be tensile before the end.",
}


@dataclass(frozen=True)
class ParameterText:
    """The description of a parameter or a state variable of a law."""

    name: str
    meaning: str
    unit: str
    allowed: str
    default: str


@dataclass(frozen=True)
class LawText:
    """The description of a contact or friction law.

    Texts keep the reStructuredText markup; displayed formulas in `body` and `notes` are paragraphs
    that begin with ".. math::".

    Parameters
    ----------
    name, title, equation, source, departure : str
        Its name, the first paragraph of its docstring, its equation, its source, and in what it
        departs from that; "" if in nothing.
    loss_parameters : str
        The parameters that set the energy loss.
    end, tension : str
        Sentences on the end of the contact and on tension; "" of a friction law.
    persistence : str
        Sentence on whether the state persists after the contact; "" without a state.
    body, notes, references, raises : tuple of str
        Paragraphs of the docstring; one entry per reference, and per line of Raises.
    parameters, state : tuple of ParameterText
        The parameters that a case may give, and the state variables.
    """

    name: str
    title: str
    equation: str
    source: str
    departure: str
    loss_parameters: str
    end: str
    tension: str
    persistence: str
    body: tuple[str, ...]
    notes: tuple[str, ...]
    references: tuple[str, ...]
    raises: tuple[str, ...]
    parameters: tuple[ParameterText, ...]
    state: tuple[ParameterText, ...]


def law_text(law: type[ContactLaw | FrictionLaw]) -> LawText:
    """Return the description of a contact or friction law.

    Parameters
    ----------
    law : type of ContactLaw or FrictionLaw
        The law's class.

    Examples
    --------
    >>> from vibroimpact.contact.registry import find_contact_law
    >>> text = law_text(find_contact_law("flores"))
    >>> text.source, text.loss_parameters, text.parameters[0].default
    ('Flores et al. 2011, Multibody Syst. Dyn. 25:357', 'restitution', 'from the materials')
    """
    sections = docstring_sections(law.__doc__ or law.name)
    title, *body = _paragraphs(sections[""])
    departure = ""
    loss_parameters = ""
    end = ""
    tension = ""
    persistence = ""
    if issubclass(law, ContactLaw):
        departure = law.departure
        loss_parameters = _loss_parameters(law)
    if issubclass(law, InstantaneousLaw):
        end = "The contact is instantaneous: it has no duration and no force."
    if issubclass(law, CompliantLaw):
        end = _ENDS[law.contact_end]
        tension = _TENSION[law.tension]
        if any(item.metadata["memory"] for item in fields(law)):
            if law.lasting:
                persistence = "The state is kept: the next impact on the same spot starts from it."
            else:
                persistence = "The state is reset after each contact."
    return LawText(
        name=law.name,
        title=title,
        equation=law.equation,
        source=law.source,
        departure=departure,
        loss_parameters=loss_parameters,
        end=end,
        tension=tension,
        persistence=persistence,
        body=tuple(body),
        notes=tuple(_paragraphs(sections.get("Notes", ""))),
        references=tuple(_paragraphs(sections.get("References", ""))),
        raises=tuple(
            line.strip() for line in sections.get("Raises", "").splitlines() if line.startswith(" ")
        ),
        parameters=tuple(
            _parameter_text(item) for item in fields(law) if not item.metadata["memory"]
        ),
        state=tuple(_parameter_text(item) for item in fields(law) if item.metadata["memory"]),
    )


def plain_paragraph(paragraph: str) -> str:
    """Return a paragraph of a `LawText` as plain text."""
    if paragraph.startswith(".. math::"):
        return plain_math(paragraph.removeprefix(".. math::"))
    return plain_text(paragraph)


@cache
def paper_pair() -> ContactPair:
    """Return the contact pair of the paper: a rock sphere of radius 25 mm on a steel plate."""
    return contact_pair(load_case("paper:type1-theory"))


def asked_and_achieved(law: type[ContactLaw]) -> list[tuple[float, float]]:
    """Return pairs of restitution asked for and achieved, of the paper's sphere at 8.8 m/s without
    gravity.

    Empty for a law without the parameter `restitution`.

    Examples
    --------
    >>> from vibroimpact.contact.registry import find_contact_law
    >>> [
    ...     (asked, round(achieved, 3))
    ...     for asked, achieved in asked_and_achieved(find_contact_law("flores"))
    ... ]
    [(0.9, 0.894), (0.7, 0.683), (0.5, 0.47), (0.3, 0.256)]
    """
    if "restitution" not in {item.name for item in fields(law)}:
        return []
    pair = paper_pair()
    example = law.example(pair)
    return [
        (
            asked,
            float(
                achieved_restitution(
                    example.changed({"restitution": asked}), pair.effective_mass, SPEED
                )
            ),
        )
        for asked in ASKED
    ]


def short_source(law: type[ContactLaw | FrictionLaw]) -> str:
    """Return the authors and the year of a law's source, or, without a year, the text before the
    first comma.

    Examples
    --------
    >>> from vibroimpact.contact.registry import find_contact_law
    >>> short_source(find_contact_law("jkr")), short_source(find_contact_law("adams-poisson"))
    ('Johnson, Kendall & Roberts 1971', 'MSC Adams/Solver guide')
    """
    return _short(law.source.split("; ")[0])


def short_sources(law: type[ContactLaw]) -> str:
    """Return the authors and years of all sources of a law.

    Examples
    --------
    >>> from vibroimpact.contact.registry import find_contact_law
    >>> short_sources(find_contact_law("tsuji"))
    'Tsuji et al. 1992; Antypov & Elliott 2011'
    """
    return "; ".join(map(_short, law.source.split("; ")))


def _short(source: str) -> str:
    parts = source.split(",")
    for number, part in enumerate(parts, 1):
        if _is_year(part.rpartition(" ")[2]):
            return ",".join(parts[:number])
    return parts[0]


def _is_year(word: str) -> bool:
    return len(word) == 4 and word.isdigit()


def _loss_parameters(law: type[ContactLaw]) -> str:
    """Return the free parameter, or the alternatives of which one is given; "nothing is
    lost" without a free parameter.
    """
    free = law.example(paper_pair()).free_parameter
    if free is None:
        return "nothing is lost"
    alternatives = [
        item.name for item in fields(law) if item.default is None and not item.metadata["from_pair"]
    ]
    if free in alternatives:
        return " or ".join(alternatives)
    return free


def _parameter_text(item: Field[Any]) -> ParameterText:
    metadata = item.metadata
    return ParameterText(
        item.name, metadata["detail"], metadata["unit"], metadata["range"].words, _default(item)
    )


def _default(item: Field[Any]) -> str:
    """Return the origin or value of a parameter that a case leaves out, or whether it is
    required.
    """
    if origin := default_origin(item):
        return origin
    if item.default is MISSING:
        typical = item.metadata["example"]
        return "required" if typical is None else f"required, such as {typical:g}"
    if item.default is None:
        return "optional"
    return f"{item.default:g}"


def _paragraphs(text: str) -> list[str]:
    """Return the paragraphs of a text, each in one line."""
    return [
        " ".join(line.strip() for line in part.splitlines())
        for part in text.strip().split("\n\n")
        if part.strip()
    ]
