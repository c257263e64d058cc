"""A surface: the facets of a convex object, everything by brute force.

An object that is not convex is refused: the plane of a facet that faces a fingertip would not tell which is
closest, and paths would have to go round what the ball cannot enter (`surface/geodesic` does all that).

Shortest paths run over points on the edges (Lanthier, Maheshwari, Sack, "Approximating weighted shortest
paths on polyhedral surfaces", SoCG 1997), found by A*; with few points an edge they are some percent longer
than the shortest.
"""

import dataclasses
import heapq
import math
from collections import defaultdict

import numpy as np
import numpy.typing as npt
import regrasp as rg

Array = npt.NDArray[np.float64]

#: An edge at which the normal turns by more than this is sharp (rad).
SHARP = math.radians(30)
#: Longest step of a walk (m).
STEP = 2e-4


class Facets(rg.Surface):
    """Facets of a convex object (others are refused) by brute force, paths over points on the edges."""

    id = "surface/template"
    references = (
        "Lanthier, Maheshwari, Sack, Approximating weighted shortest paths on polyhedral surfaces, SoCG 1997",
    )

    @dataclasses.dataclass(frozen=True)
    class Settings:
        """Settings of the surface."""

        points: int = rg.setting(
            3,
            range=(1, 100),
            doc="Points that a path may cross an edge at; more make paths shorter and slower.",
        )

    def prepare(self, parts: rg.Parts) -> None:
        """Everything that the object's mesh alone tells."""
        self.radius = parts.fingertip_radius
        self.corners = parts.vertices[parts.facets]  # (F, 3, 3)
        self.sides = np.roll(self.corners, -1, axis=1) - self.corners
        cross = np.cross(self.sides[:, 0], self.sides[:, 1])
        lengths = np.linalg.norm(cross, axis=1)
        self.normals = cross / lengths[:, None]
        self.areas = np.cumsum(0.5 * lengths)
        self.offsets = (self.normals * self.corners[:, 0]).sum(axis=1)
        size = float(np.ptp(parts.vertices, axis=0).max())
        if (parts.vertices @ self.normals.T - self.offsets).max() > 1e-6 * size:
            raise ValueError("the object is not convex; use `surface/geodesic`, which takes any closed mesh")
        self._put_points_on_edges(parts)

    def _put_points_on_edges(self, parts: rg.Parts) -> None:
        """The points that paths may go through, and the sharp edges."""
        facets_of_edge: dict[tuple[int, int], list[int]] = defaultdict(list)
        for facet, (a, b, c) in enumerate(parts.facets.tolist()):
            for u, v in ((a, b), (b, c), (c, a)):
                facets_of_edge[min(u, v), max(u, v)].append(facet)
        points = [tuple(vertex) for vertex in parts.vertices.tolist()]
        self.of_facet: list[list[int]] = [list(corners) for corners in parts.facets.tolist()]
        size, sharp = math.sqrt(self.areas[-1]), []
        for (u, v), facets in facets_of_edge.items():
            ends = parts.vertices[[u, v]]
            if self.normals[facets[0]] @ self.normals[facets[-1]] < math.cos(SHARP):
                sharp.append(ends)
            # Edges that are long for the object get more.
            share = float(np.linalg.norm(ends[1] - ends[0])) / size
            count = max(self.settings.points, int(12 * self.settings.points * share))
            first = len(points)
            points += [
                tuple(ends[0] + (ends[1] - ends[0]) * i / (count + 1)) for i in range(1, count + 1)
            ]
            for facet in facets:
                self.of_facet[facet] += range(first, len(points))
        self.points: list[tuple[float, ...]] = points
        self.sharp = np.array(sharp).reshape(-1, 2, 3)
        self.facets_of: list[list[int]] = [[] for _ in points]
        for facet, here in enumerate(self.of_facet):
            for point in here:
                self.facets_of[point].append(facet)

    def sample(self, context: rg.Context) -> rg.Contact:
        """Uniform over the area."""
        wanted = context.uniform() * self.areas[-1]
        facet = min(int(np.searchsorted(self.areas, wanted, side="right")), len(self.areas) - 1)
        s, t = context.uniform(), context.uniform()
        if s + t > 1:
            s, t = 1 - s, 1 - t
        a, b, c = self.corners[facet]
        return rg.Contact(a + s * (b - a) + t * (c - a), self.normals[facet], facet)

    def geodesic(
        self, start: rg.Contact, end: rg.Contact, context: rg.Context
    ) -> tuple[list[tuple[rg.Contact, float]], float]:
        """A path over points on the edges; each corner with the normal before it, and the one after."""
        waypoints, length = [(start, 0.0)], 0.0

        def go(contact: rg.Contact) -> None:
            nonlocal length
            last, travelled = waypoints[-1]
            apart = float(np.linalg.norm(contact.point - last.point))
            step = apart + self.radius * angle(last.normal, contact.normal)
            if step > 1e-12:
                waypoints.append((contact, travelled + step))
                length += apart

        if (start.point != end.point).any() or (start.normal != end.normal).any():
            for facet, a, b in self._pieces(start.point, end.point):
                go(rg.Contact(a, self.normals[facet], facet))
                go(rg.Contact(b, self.normals[facet], facet))
        # The path ends exactly where it was asked to.
        go(end)
        if len(waypoints) == 1:
            return [*waypoints, (end, 0.0)], 0.0
        return [*waypoints[:-1], (end, waypoints[-1][1])], length

    def _pieces(self, start: Array, end: Array) -> list[tuple[int, Array, Array]]:
        """The straight pieces of a path, each in one facet."""
        starts, ends = self._facets_at(start), self._facets_at(end)
        common = [facet for facet in starts if facet in ends]
        if common:
            return [(common[0], start, end)]
        marks, last = self._spread(start, starts, end, ends)
        pieces = [(facet_of(self.of_facet, ends, last), np.array(self.points[last]), end)]
        while True:
            _, before, facet = marks[last]
            at = start if before is None else np.array(self.points[before])
            pieces.append((facet, at, np.array(self.points[last])))
            if before is None:
                return pieces[::-1]
            last = before

    def _spread(
        self, start: Array, starts: list[int], end: Array, ends: list[int]
    ) -> tuple[dict[int, tuple[float, int | None, int]], int]:
        """A* from a point to the first point of the end's facets through which nothing is shorter.

        How each point was reached: distance (m), the point before it (None: the start), the facet crossed.
        """
        goal, points = tuple(end.tolist()), self.points
        last = {point for facet in ends for point in self.of_facet[facet]}
        marks: dict[int, tuple[float, int | None, int]] = {}
        queue: list[tuple[float, float, int]] = []

        def offer(point: int, distance: float, before: int | None, facet: int) -> None:
            known = marks.get(point)
            if known is None or distance < known[0]:
                marks[point] = (distance, before, facet)
                heapq.heappush(queue, (distance + math.dist(points[point], goal), distance, point))

        begin = tuple(start.tolist())
        for facet in starts:
            for point in self.of_facet[facet]:
                offer(point, math.dist(begin, points[point]), None, facet)
        while True:
            _, distance, point = heapq.heappop(queue)
            # From the end's facets the way that is left is straight: the estimate is the length.
            if point in last:
                return marks, point
            if distance > marks[point][0]:
                continue
            for facet in self.facets_of[point]:
                for after in self.of_facet[facet]:
                    offer(after, distance + math.dist(points[point], points[after]), point, facet)

    def _facets_at(self, point: Array) -> list[int]:
        """The facets that hold a point of the surface."""
        near = np.flatnonzero(np.abs(self.normals @ point - self.offsets) < 1e-9)
        apart = np.linalg.norm(self._closest(near, point) - point, axis=1)
        found: list[int] = near[apart < 1e-9].tolist()
        return found

    def _closest(self, facets: npt.NDArray[np.int64], point: Array) -> Array:
        """The point of each facet that is closest to another: its foot on the plane if that lies inside the
        triangle, else the closest on the sides.
        """
        corners, sides, normals = self.corners[facets], self.sides[facets], self.normals[facets]
        away = point - corners
        inside = ((np.cross(sides, away) * normals[:, None]).sum(axis=2) >= 0).all(axis=1)
        s = (away * sides).sum(axis=2) / (sides * sides).sum(axis=2)
        on_sides = corners + s.clip(0, 1)[..., None] * sides
        nearest = ((on_sides - point) ** 2).sum(axis=2).argmin(axis=1)
        foot = point - (away[:, 0] * normals).sum(axis=1)[:, None] * normals
        found: Array = np.where(inside[:, None], foot, on_sides[np.arange(len(facets)), nearest])
        return found

    def project(self, point: Array, hint: int | None) -> tuple[rg.Contact, float]:
        """Inside, the closest plane has the closest point; outside, only facets that can be seen have it."""
        heights = self.normals @ point - self.offsets
        highest = int(heights.argmax())
        if heights[highest] <= 1e-9:
            n, height = self.normals[highest], float(heights[highest])
            return rg.Contact(point - height * n, n, highest), height
        seen = np.flatnonzero(heights > 0)
        found = self._closest(seen, point)
        apart = np.linalg.norm(found - point, axis=1)
        best = int(apart.argmin())
        return rg.Contact(found[best], point - found[best], int(seen[best])), float(apart[best])

    def walk(self, contact: rg.Contact, direction: Array, distance: float) -> rg.Contact:
        """Small steps in the tangent plane, each projected back: they only become shorter, hardly."""
        steps = math.ceil(distance / STEP)
        for _ in range(steps):
            direction = direction - contact.normal * float(direction @ contact.normal)
            length = float(np.linalg.norm(direction))
            if length < 1e-12:
                break
            direction = direction / length
            contact, _ = self.project(contact.point + direction * (distance / steps), None)
        return contact

    def edge_distance(self, contact: rg.Contact) -> float:
        """To the nearest of the sharp edges."""
        if not len(self.sharp):
            return math.inf
        a, b = self.sharp[:, 0], self.sharp[:, 1]
        along = b - a
        s = ((contact.point - a) * along).sum(axis=1) / (along * along).sum(axis=1)
        closest = a + along * np.clip(s, 0, 1)[:, None]
        return float(np.linalg.norm(closest - contact.point, axis=1).min())


def facet_of(of_facet: list[list[int]], facets: list[int], point: int) -> int:
    """The first of the facets that has a point."""
    return next(facet for facet in facets if point in of_facet[facet])


def angle(a: Array, b: Array) -> float:
    """Between two unit vectors (rad)."""
    return math.atan2(float(np.linalg.norm(np.cross(a, b))), float(a @ b))
