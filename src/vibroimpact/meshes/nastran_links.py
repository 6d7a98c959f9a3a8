"""Rigid elements and multipoint constraints of a Nastran file (RBE1, RBE2, RBE3, RBAR,
RROD, RTRPLT, MPC).
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Sequence

from vibroimpact.meshes.links import COMPONENTS, Distance, Equation, Link, Mean, Rigid, equation_of
from vibroimpact.meshes.nastran_cards import Card, nastran_real
from vibroimpact.meshes.parsed_mesh import Parts
from vibroimpact.meshes.text_files import TextLine, parse_integer
from vibroimpact.structures.joints import AXES

_ALL = tuple(range(COMPONENTS))
_NAMES = ("RBE1", "RBE2", "RBE3", "RBAR", "RROD", "RTRPLT")
_ASKED = re.compile(r"\s*MPC\s*=\s*(\d{1,18})\s*$", re.IGNORECASE)
_FIELDS = 8
_MOST_OF_A_RANGE = 1_000_000  # nodes
_NODE = "the number of a node"

Members = Sequence[tuple[int, Sequence[int]]]


class NastranLinks:
    """Collected cards that link nodes; of MPC those count that the case control asks for."""

    def __init__(self) -> None:
        self._cards: list[Card] = []
        self._asked: set[int] = set()
        self._has_control = False

    def control(self, lines: Iterable[TextLine]) -> None:
        """Read what the case control asks for."""
        self._has_control = True
        for line in lines:
            if found := _ASKED.match(line.text.split("$", 1)[0]):
                self._asked.add(int(found[1]))

    def take(self, card: Card) -> bool:
        """Keep a card if it is one of these; return whether it is."""
        mine = card.name in (*_NAMES, "MPC", "MPCADD")
        if mine:
            self._cards.append(card)
        return mine

    def add_to(self, parts: Parts, turned: Collection[int]) -> None:
        """Add the links to the parts, and count those that can't be used as skipped.

        Parameters
        ----------
        parts : Parts
            The parts.
        turned : collection of int
            Nodes whose components of motion are not those of the basic system.

        Raises
        ------
        InputError
            If a number can't be read.
        """
        sets = self._sets_in_use()
        for card in self._cards:
            if card.name == "MPCADD":
                continue
            if card.name == "MPC" and _integer(card, 0, "the number of a set") not in sets:
                parts.skipped["MPC"] += 1
                continue
            link = _link(card, turned)
            if link is None:
                parts.skipped[card.name] += 1
            else:
                parts.links.add(card.name, link)

    def _sets_in_use(self) -> set[int]:
        """Return the sets of MPC cards that apply: those of the case control; in a file
        without one, its only set.
        """
        added: dict[int, set[int]] = {}
        stated = set()
        for card in self._cards:
            if card.name == "MPCADD":
                numbers = [
                    parse_integer(field, card.line, "the number of a set")
                    for field in card.fields
                    if field
                ]
                added[numbers[0] if numbers else 0] = set(numbers[1:])
            elif card.name == "MPC":
                stated.add(_integer(card, 0, "the number of a set"))
        asked = self._asked
        if not self._has_control:
            asked = set(added) if len(added) == 1 else stated
        if len(asked) != 1:  # subcases that differ, or a file that leaves it open
            return set()
        (one,) = asked
        return added.get(one, {one})


def _link(card: Card, turned: Collection[int]) -> Link | None:
    """Return the link of a card; None if it can't be used."""
    make = {
        "RBE1": _rbe1,
        "RBE2": _rbe2,
        "RBE3": _rbe3,
        "RBAR": _rbar,
        "RROD": _rrod,
        "RTRPLT": _rtrplt,
        "MPC": _mpc,
    }[card.name]
    link = make(card)
    if isinstance(link, Rigid):
        along = [(node, components) for node, components in link.members if node in turned]
    elif isinstance(link, Mean):
        along = [
            (node, axes)
            for node, axes in (
                (link.node, link.components),
                *((node, axes) for node, _, axes in link.members),
            )
        ]
        along = [(node, axes) for node, axes in along if node in turned]
    elif isinstance(link, Equation):
        along = [(node, (component,)) for (node, component), _ in link.terms if node in turned]
    else:
        along = []
    return link if all(_is_whole(components) for _, components in along) else None


def _is_whole(components: Sequence[int]) -> bool:
    """Whether components of motion are the same in every system: none or all of the
    displacements, and of the rotations.
    """
    return all(
        len(set(components) & set(part)) in (0, AXES)
        for part in (range(AXES), range(AXES, COMPONENTS))
    )


def _rbe2(card: Card) -> Rigid:
    leads = _integer(card, 1, _NODE)
    components = _components(card, card.fields[2])
    # a real number is a thermal expansion
    words = [field.upper() for field in card.fields[3:] if field and "." not in field]
    nodes: list[int] = []
    at = 0
    while at < len(words):
        if words[at] == "THRU" and nodes and at + 1 < len(words):
            last = parse_integer(words[at + 1], card.line, _NODE)
            if last - nodes[-1] > _MOST_OF_A_RANGE:
                raise card.line.wrong(
                    f"the range up to {last} is of more than {_MOST_OF_A_RANGE:,} nodes; "
                    "write the nodes out"
                )
            nodes += range(nodes[-1] + 1, last + 1)
            at += 2
        else:
            nodes.append(parse_integer(words[at], card.line, _NODE))
            at += 1
    return Rigid(card.line, [(leads, _ALL), *((node, components) for node in nodes)])


def _rbe1(card: Card) -> Rigid | None:
    words = [field.upper() for field in card.fields[1:] if field and "." not in field]
    pairs = [word for word in words if word != "UM"]
    if "UM" not in words or len(pairs) % 2:
        return None
    count = words.index("UM") // 2
    members = [
        (parse_integer(node, card.line, _NODE), _components(card, part))
        for node, part in zip(pairs[::2], pairs[1::2], strict=True)
    ]
    return _rigid(card, members[:count], members[count:])


def _rbar(card: Card) -> Rigid | None:
    return _of_ends(card, 2)


def _rtrplt(card: Card) -> Rigid | None:
    return _of_ends(card, 3)


def _of_ends(card: Card, count: int) -> Rigid | None:
    """Return the rigid motion of a few nodes: their numbers, the components that lead,
    and those that follow, blank for all others.
    """
    fields = [*card.fields, *[""] * (2 * _FIELDS)]
    nodes = [_integer(card, 1 + index, _NODE) for index in range(count)]
    # of a plate the components that follow are in a line of their own
    first = 1 + 2 * count if count == 2 else _FIELDS
    leading = [_components(card, fields[1 + count + index]) for index in range(count)]
    following = [_components(card, fields[first + index]) for index in range(count)]
    if not any(leading):
        leading[0] = _ALL
    if not any(following):
        following = [tuple(set(_ALL) - set(components)) for components in leading]
    return _rigid(
        card, list(zip(nodes, leading, strict=True)), list(zip(nodes, following, strict=True))
    )


def _rigid(card: Card, leading: Members, following: Members) -> Rigid | None:
    """Return the rigid motion of six components that lead, which others follow; None if
    there are not six.
    """
    if sum(len(components) for _, components in leading) != COMPONENTS:
        return None
    members: dict[int, set[int]] = {}
    for node, components in [*leading, *following]:
        members.setdefault(node, set()).update(components)
    return Rigid(
        card.line,
        [(node, tuple(sorted(components))) for node, components in members.items() if components],
    )


def _rrod(card: Card) -> Distance:
    return Distance(card.line, (_integer(card, 1, _NODE), _integer(card, 2, _NODE)))


def _rbe3(card: Card) -> Mean | None:
    node, components = _integer(card, 2, _NODE), _components(card, card.fields[3])
    members: list[tuple[int, float, Sequence[int]]] = []
    weight, axes = 0.0, None
    for field in card.fields[4:]:
        # which components follow makes no difference to the motions that are possible
        if field.upper() in ("ALPHA", "UM"):
            break
        if "." in field:
            weight, axes = nastran_real(field, card.line, "a weight"), None
        elif field and axes is None:
            axes = _components(card, field)
        elif field and axes is not None:
            members.append((parse_integer(field, card.line, _NODE), weight, axes))
    usable = all(
        0.0 < weight < float("inf") and set(axes) <= set(range(AXES)) for _, weight, axes in members
    )
    return Mean(card.line, node, components, members) if usable and members else None


def _mpc(card: Card) -> Equation | None:
    fields = [
        field
        for start in range(0, len(card.fields), _FIELDS)
        for field in card.fields[start : start + _FIELDS][1:7]
    ]
    terms = []
    for start in range(0, len(fields), 3):
        node, component, value = [*fields[start : start + 3], "", ""][:3]
        if node:
            terms.append((node, component, nastran_real(value, card.line, "a coefficient")))
    parsed = [
        ((parse_integer(node, card.line, _NODE), _components(card, part)), value)
        for node, part, value in terms
    ]
    if any(
        len(components) != 1 or not abs(value) < float("inf") for (_, components), value in parsed
    ):
        return None  # of scalar points there is no body
    return equation_of(
        card.line, [((node, components[0]), value) for (node, components), value in parsed]
    )


def _components(card: Card, text: str) -> tuple[int, ...]:
    """Return components of motion, from 0, of digits from 1 to 6."""
    if text in ("", "0"):
        return ()
    if not set(text) <= set("123456"):
        raise card.line.wrong(
            f'"{text[:20]}" names no components of motion; they must be digits from 1 to '
            "6, such as 123"
        )
    return tuple(sorted({int(digit) - 1 for digit in text}))


def _integer(card: Card, index: int, what: str) -> int:
    return parse_integer(card.fields[index] if index < len(card.fields) else "", card.line, what)
