"""Rigid elements and multipoint constraints of a Nastran file.

They are RBE1, RBE2, RBE3, RBAR, RROD, RTRPLT and MPC.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Sequence

from vibroimpact.meshes.links import COMPONENTS, Distance, Equation, Link, Mean, Rigid, equation_of
from vibroimpact.meshes.nastran_cards import Card, nastran_real
from vibroimpact.meshes.parsed_mesh import Parts
from vibroimpact.meshes.text_files import TextLine, parse_integer
from vibroimpact.structures.finite_elements.joints import AXES

_ALL = tuple(range(COMPONENTS))
_RIGID_ELEMENTS = ("RBE1", "RBE2", "RBE3", "RBAR", "RROD", "RTRPLT")
_MPC_REQUEST = re.compile(r"\s*MPC\s*=\s*(\d{1,18})\s*$", re.IGNORECASE)
_FIELDS = 8
_MOST_OF_A_RANGE = 1_000_000  # nodes
# what a number that can't be read should be, for messages
_NODE = "the number of a node"
_SET = "the number of a set"

Members = Sequence[tuple[int, Sequence[int]]]


class NastranLinks:
    """Collected cards that link nodes; of MPC those count that the case control asks for."""

    def __init__(self) -> None:
        self._cards: list[Card] = []
        self._requested_sets: set[int] = set()
        self._has_case_control = False

    def control(self, lines: Iterable[TextLine]) -> None:
        """Read what the case control asks for."""
        self._has_case_control = True
        for line in lines:
            if request := _MPC_REQUEST.match(line.text.split("$", 1)[0]):
                self._requested_sets.add(int(request[1]))

    def take(self, card: Card) -> bool:
        """Keep a card if it is one of these; return whether it is."""
        is_link = card.name in (*_RIGID_ELEMENTS, "MPC", "MPCADD")
        if is_link:
            self._cards.append(card)
        return is_link

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
            if card.name == "MPC" and _integer(card, 0, _SET) not in sets:
                parts.skipped["MPC"] += 1
                continue
            link = _link(card, turned)
            if link is None:
                parts.skipped[card.name] += 1
            else:
                parts.links.add(card.name, link)

    def _sets_in_use(self) -> set[int]:
        """Return the sets of MPC cards that apply.

        They are those of the case control; in a file without one, its only set.
        """
        members_of_sums: dict[int, set[int]] = {}  # of MPCADD
        stated = set()
        for card in self._cards:
            if card.name == "MPCADD":
                numbers = [parse_integer(field, card.line, _SET) for field in card.fields if field]
                number_of_sum = numbers[0] if numbers else 0
                members_of_sums[number_of_sum] = set(numbers[1:])
            elif card.name == "MPC":
                stated.add(_integer(card, 0, _SET))
        requested = self._requested_sets
        if not self._has_case_control:
            requested = stated
            if len(members_of_sums) == 1:
                requested = set(members_of_sums)
        if len(requested) != 1:  # subcases that differ, or a file that leaves it open
            return set()
        (number,) = requested
        return members_of_sums.get(number, {number})


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
    if link is None:
        return None
    # components of nodes with axes of their own must mean the same in the basic system
    if all(_is_whole(components) for node, components in _motions(link) if node in turned):
        return link
    return None


def _motions(link: Link) -> list[tuple[int, Sequence[int]]]:
    """Return the nodes of a link with those components of their motion that it uses.

    A distance uses none: it does not depend on axes.
    """
    if isinstance(link, Rigid):
        return list(link.members)
    if isinstance(link, Mean):
        members = [(node, axes) for node, _, axes in link.members]
        return [(link.node, link.components), *members]
    if isinstance(link, Equation):
        return [(node, (component,)) for (node, component), _ in link.terms]
    return []


def _is_whole(components: Sequence[int]) -> bool:
    """Whether components of motion mean the same in every system.

    They are none or all of the displacements, and none or all of the rotations.
    """
    displacements = set(components) & set(range(AXES))
    rotations = set(components) & set(range(AXES, COMPONENTS))
    return len(displacements) in (0, AXES) and len(rotations) in (0, AXES)


def _rbe2(card: Card) -> Rigid:
    """Return an RBE2: components of nodes that follow all of another node."""
    leader = _integer(card, 1, _NODE)
    components = _components(card, card.fields[2])
    # a real number is a thermal expansion
    entries = [field.upper() for field in card.fields[3:] if field and "." not in field]
    nodes: list[int] = []
    index = 0
    while index < len(entries):
        if entries[index] == "THRU" and nodes and index + 1 < len(entries):
            last = parse_integer(entries[index + 1], card.line, _NODE)
            if last - nodes[-1] > _MOST_OF_A_RANGE:
                raise card.line.wrong(
                    f"the range up to {last} is of more than {_MOST_OF_A_RANGE:,} nodes; "
                    "write the nodes out"
                )
            nodes += range(nodes[-1] + 1, last + 1)
            index += 2
        else:
            nodes.append(parse_integer(entries[index], card.line, _NODE))
            index += 1
    return Rigid(card.line, [(leader, _ALL), *((node, components) for node in nodes)])


def _rbe1(card: Card) -> Rigid | None:
    """Return an RBE1: pairs of node and components, those that follow after "UM"."""
    entries = [field.upper() for field in card.fields[1:] if field and "." not in field]
    pairs = [entry for entry in entries if entry != "UM"]
    if "UM" not in entries or len(pairs) % 2:
        return None
    members = []
    for node, digits in zip(pairs[::2], pairs[1::2], strict=True):
        number = parse_integer(node, card.line, _NODE)
        members.append((number, _components(card, digits)))
    leading = entries.index("UM") // 2
    return _rigid(card, members[:leading], members[leading:])


def _rbar(card: Card) -> Rigid | None:
    """Return an RBAR, a rigid bar between two nodes."""
    return _of_ends(card, 2)


def _rtrplt(card: Card) -> Rigid | None:
    """Return an RTRPLT, a rigid triangle of three nodes."""
    return _of_ends(card, 3)


def _of_ends(card: Card, count: int) -> Rigid | None:
    """Return the rigid motion of two or three nodes.

    The card has their numbers, the components of each that lead, and those that follow; if the
    latter are blank, all others follow.
    """
    padding = [""] * (2 * _FIELDS)
    fields = [*card.fields, *padding]
    nodes = [_integer(card, 1 + index, _NODE) for index in range(count)]
    first_leading = 1 + count
    first_following = 1 + 2 * count
    if count == 3:  # of a plate the components that follow are in a line of their own
        first_following = _FIELDS
    leading_fields = fields[first_leading : first_leading + count]
    following_fields = fields[first_following : first_following + count]
    leading = [_components(card, text) for text in leading_fields]
    following = [_components(card, text) for text in following_fields]
    if not any(leading):
        leading[0] = _ALL
    if not any(following):
        following = [tuple(set(_ALL) - set(components)) for components in leading]
    leading_members = list(zip(nodes, leading, strict=True))
    following_members = list(zip(nodes, following, strict=True))
    return _rigid(card, leading_members, following_members)


def _rigid(card: Card, leading: Members, following: Members) -> Rigid | None:
    """Return the rigid motion of six components that lead, which others follow.

    None if there are not six.
    """
    if sum(len(components) for _, components in leading) != COMPONENTS:
        return None
    # what leads and what follows moves alike: one rigid motion, of which all have a part
    members: dict[int, set[int]] = {}
    for node, components in [*leading, *following]:
        members.setdefault(node, set()).update(components)
    return Rigid(
        card.line,
        [(node, tuple(sorted(components))) for node, components in members.items() if components],
    )


def _rrod(card: Card) -> Distance:
    """Return an RROD, a rod between two nodes that does not stretch."""
    return Distance(card.line, (_integer(card, 1, _NODE), _integer(card, 2, _NODE)))


def _rbe3(card: Card) -> Mean | None:
    """Return an RBE3: a node, its components, and groups of a weight, components and nodes."""
    node = _integer(card, 2, _NODE)
    components = _components(card, card.fields[3])
    members: list[tuple[int, float, Sequence[int]]] = []
    weight = 0.0
    axes: tuple[int, ...] | None = None
    for field in card.fields[4:]:
        # which components follow makes no difference to the motions that are possible
        if field.upper() in ("ALPHA", "UM"):
            break
        if "." in field:
            weight = nastran_real(field, card.line, "a weight")
            axes = None
        elif field and axes is None:
            axes = _components(card, field)
        elif field and axes is not None:
            members.append((parse_integer(field, card.line, _NODE), weight, axes))
    if not members:
        return None
    for _, member_weight, member_axes in members:
        if not 0.0 < member_weight < float("inf") or not set(member_axes) <= set(range(AXES)):
            return None
    return Mean(card.line, node, components, members)


def _mpc(card: Card) -> Equation | None:
    """Return an MPC: a sum of components of motion, each of node, component and coefficient.

    None of scalar points, of which there is no body.
    """
    # each line has two terms, after the number of the set or a blank, and before another blank
    fields = []
    for start in range(0, len(card.fields), _FIELDS):
        fields += card.fields[start : start + _FIELDS][1:7]
    entries = []
    for start in range(0, len(fields), 3):
        node, digits, text = [*fields[start : start + 3], "", ""][:3]
        if node:
            entries.append((node, digits, nastran_real(text, card.line, "a coefficient")))
    terms = [
        ((parse_integer(node, card.line, _NODE), _components(card, digits)), coefficient)
        for node, digits, coefficient in entries
    ]
    for (_, components), coefficient in terms:
        if len(components) != 1 or not abs(coefficient) < float("inf"):
            return None
    return equation_of(
        card.line,
        [((node, components[0]), coefficient) for (node, components), coefficient in terms],
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
    """Return the whole number in a field of a card."""
    text = ""
    if index < len(card.fields):
        text = card.fields[index]
    return parse_integer(text, card.line, what)
