"""Integration of a contact in time, from first touch to release, in stretches that end where the force is not smooth.

Each drop goes through compression (to each breakpoint of the law, then to the deepest point), restitution
(back through the breakpoints to separation) and, where the tension of a law is cut, a glide: the force is zero
although the surfaces still overlap, and the sphere moves freely until the force is positive again or the surfaces
separate. A law with memory is updated at the deepest point.

A stretch is first solved up to its end, with its duration unknown. If Newton's method or the series does not
converge, the drop is marched in stretches of given, adapted durations until the end can be reached in one.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats, Indices
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.static import static_indentation, static_work
from vibroimpact.dynamics.collocation import Map, Rule, collocation_rule
from vibroimpact.dynamics.contact import CAPTURED, COMPRESSION, FAILED, GLIDE, RELEASED, RESTITUTION, Contact, Piece
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.rigid.glide import glide_until_push
from vibroimpact.dynamics.rigid.starting_values import WarmStarts, first_guess, time_scale
from vibroimpact.dynamics.rigid.stretch import Aim, Stretch, WarmStart, acceleration_unit, solve_stretch
from vibroimpact.dynamics.rigid.tension import first_tension, tensile_before_end

_MOST_STRETCHES = 2000  # the stiffest sensible contacts need about a hundred


def integrate_contact(encounter: Encounter, tolerance: float, warm_starts: WarmStarts, ids: Drops) -> Contact:
    """Integrate the contact of B drops from first touch to release.

    Parameters
    ----------
    encounter : Encounter
        The impact: law, mass, gravity, approach speed.
    tolerance : float
        Relative error allowed in the state at the end of each stretch.
    warm_starts : WarmStarts
        Solutions of the earlier impacts of the run, to which this one is added.
    ids : array of int, shape (B,)
        Indices of these drops in the run.
    """
    with np.errstate(all="ignore"):  # iterates far from the solution may overflow; values that are not finite are rejected below
        return _ContactState(encounter, tolerance, warm_starts, ids).run()


def nodes_per_stretch(tolerance: float) -> int:
    """Return the number of collocation nodes for a tolerance: 20 at the default of 1e-9."""
    return int(8 + 4 * np.ceil(-np.log10(tolerance) / 3.0))


class _ContactState:
    """The state of B drops in a contact, and the rules that advance it."""

    def __init__(self, encounter: Encounter, tolerance: float, warm_starts: WarmStarts, ids: Drops) -> None:
        size = len(encounter.mass)
        self.warm_starts, self.ids = warm_starts, ids
        self.encounter = encounter
        self.number, self.tolerance = nodes_per_stretch(tolerance), tolerance
        self.least_energy = 0.5 * encounter.mass * (tolerance * encounter.speed_scale) ** 2
        self.pieces: list[Piece] = []
        self.time, self.delta, self.velocity = np.zeros(size), encounter.law.touch_level + np.zeros(size), encounter.approach_speed.copy()
        self.outcome = np.full(size, COMPRESSION, dtype=np.int8)
        self.max_delta, self.time_of_max_delta = np.zeros(size), np.zeros(size)
        self.dissipated, self.plastic = np.zeros(size), np.zeros(size)
        self.levels = self.breakpoints()
        self.within_reach = np.ones((len(self.levels), size), dtype=bool)
        self.depth = encounter.depth
        self.march = np.zeros(size)  # duration of the next stretch of drops that are marched
        self.pace = np.zeros(size)  # the last such duration that was accepted
        self.stretches = np.zeros(size, dtype=int)  # attempted so far

    @property
    def law(self) -> CompliantLaw:
        return self.encounter.law

    def breakpoints(self) -> list[Floats]:
        return [level + np.zeros(len(self.delta)) for level in self.law.breakpoints]

    def run(self) -> Contact:
        while (moving := np.flatnonzero(self.outcome < RELEASED)).size:
            self.stretches[moving] += 1
            self.outcome[self.stretches > _MOST_STRETCHES] = FAILED
            for code, advance in ((COMPRESSION, self.compress), (RESTITUTION, self.rebound), (GLIDE, self.glide)):
                drops = moving[self.outcome[moving] == code]
                if drops.size:
                    advance(drops)
        return Contact(
            self.pieces,
            self.outcome,
            self.time,
            self.delta,
            self.velocity,
            self.max_delta,
            self.time_of_max_delta,
            self.dissipated,
            self.plastic,
            self.law.elastic_energy(self.delta),
            self.law,
        )

    # one advance of a group of drops -------------------------------------------------------------

    def compress(self, drops: Drops) -> None:
        """Advance drops in compression to the next breakpoint within reach, or to the deepest point."""
        level = np.full(len(drops), np.inf)
        for index, levels in reversed(list(enumerate(self.levels))):
            sought = self.within_reach[index, drops] | (self.march[drops] > 0.0)
            ahead = (levels[drops] > self.delta[drops]) & (levels[drops] < self.depth[drops]) & sought
            level[ahead] = levels[drops][ahead]
        touching, turning = self.time[drops] == 0.0, np.isinf(level)
        maps: tuple[tuple[Bools, Map], ...] = ((touching, "touch"), (~touching, "inside"))
        aims: tuple[tuple[Bools, Aim], ...] = ((turning, "turn"), (~turning, "indentation"))
        for here, time_map in maps:
            for there, aim in aims:
                if (both := here & there).any():
                    self.advance(drops[both], time_map, aim, level[both])

    def rebound(self, drops: Drops) -> None:
        """Advance drops in restitution to the next breakpoint below, or to separation."""
        level = self.encounter.floor[drops]
        for levels in self.levels:
            ahead = (levels[drops] < self.delta[drops]) & (levels[drops] > level)
            level[ahead] = levels[drops][ahead]
        last = level == self.encounter.floor[drops]
        maps: tuple[tuple[Bools, Map], ...] = ((last, "release"), (~last, "inside"))
        for here, time_map in maps:
            if here.any():
                self.advance(drops[here], time_map, "indentation", level[here])

    def advance(self, drops: Drops, time_map: Map, aim: Aim, level: Floats) -> None:
        """Solve one stretch up to its end or, for drops that are marched, of a given duration."""
        marching = self.march[drops] > 0.0
        if marching.any():
            self.march_on(drops[marching], "touch" if time_map == "touch" else "inside", aim, level[marching])
            drops, level = drops[~marching], level[~marching]
        early = self.warm_starts.knows(("release", "force"), self.ids[drops])
        early &= (self.outcome[drops] == RESTITUTION) & (self.velocity[drops] == 0.0)
        if early.any():  # in the last impact the force became zero here: try that event first
            stretch = self.aimed(drops[early], "release", "force", level[early])
            good = self.good(drops[early], stretch) & (stretch.node_delta[-1] > level[early])
            good &= ~tensile_before_end(self.encounter.take(drops[early]), stretch)  # otherwise it is a later zero of the force
            self.warm_starts.forget(("release", "force"), self.ids[drops[early][~good]])
            if good.any():
                self.accept(drops[early][good], stretch.take(good), "force", level[early][good])
            early[early] = good
            drops, level = drops[~early], level[~early]
        if drops.size:
            self.accept_or_march(drops, self.aimed(drops, time_map, aim, level), aim, level)

    def aimed(self, drops: Drops, time_map: Map, aim: Aim, level: Floats) -> Stretch:
        """Return a stretch up to its end, started from the last impact's solution or from a sinusoidal motion."""
        encounter, kind, ids = self.encounter.take(drops), (time_map, aim), self.ids[drops]
        duration = time_scale(encounter, self.delta[drops], self.velocity[drops], aim, level)
        known = self.warm_starts.knows(kind, ids)
        if known.all():
            start = WarmStart(self.warm_starts.starts[kind].unknowns[:, ids], self.warm_starts.starts[kind].inverse)
        else:
            unit = acceleration_unit(encounter, self.velocity[drops], duration)
            guess = first_guess(encounter, self.rule(time_map), self.delta[drops], self.velocity[drops], duration, aim, level) / unit
            start = WarmStart(np.concatenate([guess, np.ones((1, len(drops)))]))
            if known.any():
                start.unknowns[:, known] = self.warm_starts.starts[kind].unknowns[:, ids[known]]
        stretch = self.solve(drops, time_map, duration, start, aim, level)
        self.remember(drops, stretch, aim, duration, start)
        return stretch

    def remember(self, drops: Drops, stretch: Stretch, aim: Aim, scale: Floats, start: WarmStart) -> None:
        """Store a solution for the next impact, scaled by the time scale of its kind."""
        accelerations = stretch.node_acceleration / acceleration_unit(self.encounter.take(drops), stretch.velocity, scale)
        unknowns = np.concatenate([accelerations, (stretch.duration / scale)[None]])
        solved = stretch.solved
        if solved.any():
            self.warm_starts.keep((stretch.rule.time_map, aim), self.ids[drops[solved]], unknowns[:, solved], start.inverse)

    def solve(self, drops: Drops, time_map: Map, duration: Floats, start: WarmStart, aim: Aim, level: Floats) -> Stretch:
        rule = self.rule(time_map)
        return solve_stretch(self.encounter.take(drops), rule, self.delta[drops], self.velocity[drops], duration, start, aim, level)

    def rule(self, time_map: Map) -> Rule:
        return collocation_rule(self.number, time_map, self.law.root)

    # after a stretch is solved ------------------------------------------------------------

    def accept_or_march(self, drops: Drops, stretch: Stretch, aim: Aim, level: Floats) -> None:
        """Accept a stretch up to its end for the drops for which it is valid; let the others march."""
        good = self.good(drops, stretch)
        if aim == "turn":
            for index, levels in enumerate(self.levels):  # a breakpoint that was passed although it was thought out of reach
                run_over = (levels[drops] > self.delta[drops]) & (levels[drops] < stretch.node_delta[-1]) & good
                self.within_reach[index, drops[run_over]] = True
                good &= ~run_over
        if aim == "indentation":
            missed = ~good & (self.outcome[drops] == COMPRESSION)
            for index, levels in enumerate(self.levels):  # a breakpoint that is not reached because of damping
                self.within_reach[index, drops[missed & (levels[drops] == level)]] = False
            lost = drops[~good & ~missed]
        else:
            lost = drops[~good]
        self.warm_starts.forget((stretch.rule.time_map, aim), self.ids[drops[~good]])
        self.march[lost] = np.where(self.pace[lost] > 0.0, self.pace[lost], 0.25 * self.span(lost))
        if good.any():
            self.accept(drops[good], stretch.take(good), aim, level[good])

    def good(self, drops: Drops, stretch: Stretch) -> Bools:
        """Return whether the stretch is resolved, its indentation rate keeps its sign, and its indentation stays positive."""
        slack = 1e-12 * self.encounter.approach_speed[drops]
        down = self.outcome[drops] == COMPRESSION
        one_way = np.where(down, stretch.node_velocity.min(axis=0) >= -slack, stretch.node_velocity.max(axis=0) <= slack)
        above = stretch.node_delta[:-1].min(axis=0) >= self.encounter.floor[drops]
        return np.asarray(self.resolved(drops, stretch) & one_way & above)

    def resolved(self, drops: Drops, stretch: Stretch) -> Bools:
        return stretch.resolved(self.encounter.take(drops), self.tolerance)

    def has_no_push(self, drops: Drops) -> Bools:
        """Return whether the force is zero or tensile at the present state of the drops."""
        here = self.encounter.take(drops)
        return np.asarray(here.acceleration(self.delta[drops], self.velocity[drops]) >= here.gravity)

    def end_push(self, drops: Drops) -> None:
        """Begin the glide of drops whose force has become zero, or end their contact where the law ends it there."""
        self.outcome[drops] = GLIDE if self.law.contact_end == "zero-indentation" else RELEASED
        self.march[drops] = self.pace[drops] = 0.0

    def accept(self, drops: Drops, stretch: Stretch, aim: Aim, level: Floats) -> None:
        """Append a stretch to the history, unless the force of a law without tension becomes zero within it."""
        restoring = self.outcome[drops] == RESTITUTION
        if self.law.tension == "cut" and aim != "force" and restoring.any():
            first = first_tension(self.encounter.take(drops), stretch, on_the_way_out=aim == "indentation")
            first[~restoring] = np.inf
            early = np.isfinite(first)
            over = early & self.has_no_push(drops)
            if over.any():  # tension too small to be resolved in the stretch before
                self.end_push(drops[over])
                drops, stretch, level = drops[~over], stretch.take(~over), level[~over]
                first, early = first[~over], early[~over]
            if early.any():
                some = stretch.take(early)
                self.solve_to_event(drops[early], some, some.rule.map_time(first[early]), "force", level[early])
                drops, stretch, level = drops[~early], stretch.take(~early), level[~early]
        if not drops.size:
            return
        self.record(drops, stretch)
        self.delta[drops] = level if aim == "indentation" else np.maximum(stretch.node_delta[-1], self.encounter.floor[drops])
        self.velocity[drops] = 0.0 if aim == "turn" else stretch.node_velocity[-1]
        self.march[drops] = 0.0
        compressing = self.outcome[drops] == COMPRESSION
        if aim == "turn":
            self.turn(drops[compressing])
            self.outcome[drops[~compressing]] = CAPTURED  # it falls back before separation
        elif aim == "force":
            self.end_push(drops)
        elif aim == "indentation":
            self.outcome[drops[~compressing & (level == self.encounter.floor[drops])]] = RELEASED
        else:  # continue to march, unless the end is near enough to be reached in one stretch
            end = (level - self.delta[drops]) / self.velocity[drops]
            left = np.where(np.isinf(level), -self.velocity[drops] / stretch.node_acceleration[-1], end)
            near = (left > 0.0) & (left < 2.0 * self.pace[drops])
            self.march[drops] = np.where(near, 0.0, self.pace[drops])
        if aim != "duration":
            self.pace[drops] = 0.0
        self.capture(drops)

    def turn(self, drops: Drops) -> None:
        """Begin restitution at the deepest point, with the memory of the law updated."""
        self.outcome[drops] = RESTITUTION
        self.max_delta[drops], self.time_of_max_delta[drops] = self.delta[drops], self.time[drops]
        self.plastic[drops] += self.encounter.take(drops).law.plastic_work(self.delta[drops])
        deepest = np.zeros(len(self.delta))
        deepest[drops] = self.delta[drops]
        law = self.law.after_compression(deepest)
        if law is not self.law:
            self.encounter = self.encounter.under(law)
            self.levels = self.breakpoints()
            here = self.encounter.take(drops)
            weak = here.acceleration(self.delta[drops], np.zeros(len(drops))) >= 0.0  # the force does not exceed the weight
            self.outcome[drops[weak]] = CAPTURED

    def capture(self, drops: Drops) -> None:
        """End the contact of drops that cannot separate any more.

        No law adds energy, so a sphere in restitution whose energy does not suffice to leave the indentation with a
        separation speed of `tolerance` times the speed scale is captured. In compression a sphere may creep towards
        its static indentation without turning; it is followed until it is there, or as slow as that.
        """
        drops = drops[self.outcome[drops] < RELEASED]
        if not drops.size:
            return
        encounter, delta = self.encounter.take(drops), self.delta[drops]
        weight = encounter.mass * encounter.gravity
        # in compression plastic work is not yet a loss: only the static force matters
        energy = 0.5 * encounter.mass * self.velocity[drops] ** 2 + static_work(encounter.law, delta) - weight * delta
        way_out = encounter.law.elastic_energy(encounter.floor) - weight * encounter.floor
        held = energy < way_out + self.least_energy[drops]
        sinking = held & (self.outcome[drops] == COMPRESSION)
        if sinking.any():
            sag = static_indentation(encounter.law, weight)
            left = energy - (static_work(encounter.law, sag) - weight * sag)
            still = 0.5 * encounter.mass * self.velocity[drops] ** 2 < self.least_energy[drops]
            there = sinking & (still | (left < np.maximum(1e-12 * weight * sag, self.least_energy[drops])))
            self.turn(drops[there])
            self.max_delta[drops[there]] = np.maximum(delta, sag)[there]
            held &= ~sinking | there
        self.outcome[drops[held]] = CAPTURED

    def solve_to_event(self, drops: Drops, stretch: Stretch, fraction: Floats, aim: Aim, level: Floats) -> None:
        """Solve part of a stretch again, up to an event that was detected near a fraction of its duration."""
        time_map: Map = "touch" if stretch.rule.time_map == "touch" else "inside"
        if aim == "force" or (aim == "indentation" and np.all(level == self.encounter.floor[drops])):
            time_map = "release"
        rule, duration = self.rule(time_map), fraction * stretch.duration
        guess = np.empty((self.number + 1, len(drops)))
        for column, part in enumerate(fraction):
            x = stretch.rule.unmap_time(part * rule.time)
            guess[:-1, column] = stretch.rule.interpolate(x, stretch.node_acceleration[:, column])
        guess[:-1] /= acceleration_unit(self.encounter.take(drops), self.velocity[drops], duration)
        guess[-1] = 1.0
        start = WarmStart(guess)
        again = self.solve(drops, time_map, duration, start, aim, level)
        if aim == "force" and not self.velocity[drops].any():
            scale = time_scale(self.encounter.take(drops), self.delta[drops], self.velocity[drops], aim, level)
            self.remember(drops, again, aim, scale, start)
        good = self.resolved(drops, again)
        if aim == "force":
            good &= ~tensile_before_end(self.encounter.take(drops), again) & (again.node_delta[-1] > self.encounter.floor[drops])
        self.shorten(drops[~good], 0.5 * duration[~good])
        if good.any():
            self.accept(drops[good], again.take(good), aim, level[good])

    def march_on(self, drops: Drops, time_map: Map, aim: Aim, level: Floats) -> None:
        """Advance drops that are marched by a stretch of given duration, or up to the event inside it."""
        duration, rule = self.march[drops], self.rule(time_map)
        steady = np.zeros((self.number + 1, len(drops)))  # zero acceleration: a starting value that is safe under stiff damping
        steady[-1] = 1.0
        stretch = self.solve(drops, time_map, duration, WarmStart(steady), "duration", level)
        good = self.resolved(drops, stretch)
        self.shorten(drops[~good], 0.25 * duration[~good])

        compressing = self.outcome[drops] == COMPRESSION
        turned = np.where(compressing, stretch.node_velocity < 0.0, stretch.node_velocity > 0.0)
        crossed = np.where(compressing, stretch.node_delta > level, stretch.node_delta < level)
        event = (turned | crossed).any(axis=0)
        clear = good & ~event
        if clear.any():
            self.pace[drops[clear]] = 2.0 * duration[clear]
            self.accept(drops[clear], stretch.take(clear), "duration", level[clear])
        first_turn, first_cross = (np.where(seen.any(axis=0), seen.argmax(axis=0), self.number) for seen in (turned, crossed))
        turns = first_turn < first_cross
        events: tuple[tuple[Bools, Indices, Aim], ...] = (
            (turns, first_turn, "turn"),
            (~turns, first_cross, "indentation"),
        )
        for these, first, end in events:
            here = good & event & these
            if here.any():
                self.solve_to_event(drops[here], stretch.take(here), rule.time[first[here]], end, level[here])

    def shorten(self, drops: Drops, duration: Floats) -> None:
        """Shorten the next stretch of drops whose last one was rejected."""
        self.march[drops] = self.pace[drops] = duration

    def glide(self, drops: Drops) -> None:
        """Advance drops in free motion until the force is positive again or the surfaces separate."""
        motion, pushes, stays = glide_until_push(self.encounter.take(drops), self.delta[drops], self.velocity[drops])
        self.pieces.append(Piece(drops, self.time[drops], motion, self.law))
        self.dissipated[drops] += self.encounter.take(drops).law.elastic_energy(self.delta[drops])
        self.time[drops] += motion.duration
        self.delta[drops], self.velocity[drops] = motion.end()
        self.dissipated[drops] -= self.encounter.take(drops).law.elastic_energy(self.delta[drops])
        self.outcome[drops] = np.where(stays, CAPTURED, np.where(pushes, RESTITUTION, RELEASED))

    def record(self, drops: Drops, stretch: Stretch) -> None:
        self.pieces.append(Piece(drops, self.time[drops], stretch, self.law))
        self.time[drops] += stretch.duration
        self.dissipated[drops] += stretch.dissipated

    def span(self, drops: Drops) -> Floats:
        """Return the time scale of the contact [s], the first duration of marching."""
        return np.asarray(self.depth[drops] / np.maximum(self.encounter.speed_scale[drops], np.abs(self.velocity[drops])))
