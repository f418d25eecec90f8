#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The opp-mapping authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the scene of a random furnished flat for opp-simulate.

    tests/benchmark/random_flat.py SEED flat.ini
    build/release/bin/opp-simulate --scene flat.ini --seed SEED -o flat.rawlog

Two to six rooms in a grid, doors so that all can be reached, windows, furniture along the walls,
and a way through every door and back that looks around in each room and often faces a bare wall.
Nobody tuned anything to such flats: they show what a change is worth elsewhere. The same seed gives
the same scene.
"""
import argparse
import math
import pathlib
import random

OUTER, INNER = 0.2, 0.12  # thickness of walls [m]
DOOR_HEIGHT = 2.03
# Kind and size: depth from the wall, width along it, height [m].
FURNITURE = [("shelf", (.3, 1.1, 1.9)), ("cabinet", (.45, 1.2, .9)), ("cabinet", (.55, 1.4, 2.0)),
             ("sofa", (.9, 1.7, .8)), ("table", (.7, 1.3, .74)), ("box", (.5, .5, .5)),
             ("box", (.4, .7, 1.2)), ("bed", (1.9, 1.4, .9)), ("chair", (.45, .45, .9))]


class Door:
    """Between two cells of the grid; `across` is the axis (0: x, 1: y) of the way through it."""

    def __init__(self, x, y, width, across):
        self.x, self.y, self.width, self.across = x, y, width, across


class Flat:
    def __init__(self, seed):
        self.random = random.Random(seed)
        self.lines = []
        self.pieces = 0
        columns = self.random.choice([1, 2, 2, 3])
        rows = self.random.choice([1, 2, 2])
        if columns * rows == 1:
            columns = 2
        widths = [self.random.uniform(2.9, 5.2) for _ in range(columns)]
        depths = [self.random.uniform(2.9, 4.6) for _ in range(rows)]
        self.grid = [[sum(lengths[:i]) for i in range(len(lengths) + 1)]
                     for lengths in (widths, depths)]  # where walls are, along x and along y
        self.height = self.random.uniform(2.3, 2.9)
        self.add_section("scene", f"description = random flat {seed}", "frames = 300")
        corners = [(0, 0), (self.length(0), 0), (self.length(0), self.length(1)),
                   (0, self.length(1))]
        self.add_section("room floor and ceiling", *(f"corner = {x} {y}" for x, y in corners),
                         f"height = {self.height}", "walls = none")
        self.add_outer_walls()
        self.doors = self.choose_doors()
        self.add_inner_walls()
        for cell in self.cells():
            self.furnish(cell)
        self.add_path()

    def text(self):
        return "\n".join(self.lines) + "\n"

    def length(self, axis):
        return self.grid[axis][-1]

    def rooms(self, axis):
        return len(self.grid[axis]) - 1

    def cells(self):
        return [(i, j) for i in range(self.rooms(0)) for j in range(self.rooms(1))]

    def centre(self, cell):
        return [(self.grid[axis][cell[axis]] + self.grid[axis][cell[axis] + 1]) / 2
                for axis in (0, 1)]

    def add_section(self, name, *lines):
        self.lines += [f"[{name}]", *lines, ""]

    def add_wall(self, name, start, end, thickness, openings):
        self.add_section(f"wall {name}", "from = {} {}".format(*start), "to = {} {}".format(*end),
                         f"thickness = {thickness}", f"height = {self.height}", *openings)

    def windows(self, count, length):
        result = []
        for k in range(count):
            if self.random.random() < .6:
                width = self.random.uniform(.7, 1.3)
                offset = length * (k + .5) / count - width / 2 + self.random.uniform(-.3, .3)
                result.append(f"window = {offset:.3f} {width:.3f} .9 1.2")
        return result

    def add_outer_walls(self):
        x, y, end, middle = self.length(0), self.length(1), .15, OUTER / 2
        self.add_wall("south", (-end, -middle), (x + end, -middle), OUTER,
                      self.windows(self.rooms(0), x + 2 * end))
        self.add_wall("east", (x + middle, -end), (x + middle, y + end), OUTER,
                      self.windows(self.rooms(1), y))
        self.add_wall("north", (x + end, y + middle), (-end, y + middle), OUTER,
                      self.windows(self.rooms(0), x))
        self.add_wall("west", (-middle, y + end), (-middle, -end), OUTER, [])

    def choose_doors(self):
        """Doors by the cells that they join: a spanning tree of the grid, and some more."""
        pairs = [((i, j), (i + 1, j)) for i in range(self.rooms(0) - 1)
                 for j in range(self.rooms(1))]
        pairs += [((i, j), (i, j + 1)) for i in range(self.rooms(0))
                  for j in range(self.rooms(1) - 1)]
        self.random.shuffle(pairs)
        parent = {cell: cell for cell in self.cells()}

        def root(cell):
            while parent[cell] != cell:
                cell = parent[cell]
            return cell
        doors = {}
        for a, b in pairs:
            if root(a) == root(b) and self.random.random() >= .5:
                continue
            parent[root(a)] = root(b)
            width = self.random.uniform(.85, 1.0)
            across = 0 if a[1] == b[1] else 1
            beside = self.grid[1 - across][a[1 - across]:][:2]
            along = self.random.uniform(beside[0] + .7, beside[1] - .7)
            wall = self.grid[across][a[across] + 1]
            doors[a, b] = Door(*((wall, along) if across == 0 else (along, wall)), width, across)
        return doors

    def add_inner_walls(self):
        for axis, name in ((0, "x"), (1, "y")):
            for k in range(1, self.rooms(axis)):
                openings = []
                for (a, _), door in self.doors.items():
                    if door.across == axis and a[axis] == k - 1:
                        along = door.y if axis == 0 else door.x
                        openings.append(f"door = {along - door.width / 2 + .05:.3f} "
                                        f"{door.width:.3f} {DOOR_HEIGHT}")
                wall, far = self.grid[axis][k], self.length(1 - axis) + .05
                ends = [(wall, -.05), (wall, far)] if axis == 0 else [(-.05, wall), (far, wall)]
                self.add_wall(f"{name}{k}", *ends, INNER, openings)

    def furnish(self, cell):
        """Pieces along the four walls of a room, clear of doors and of the way."""
        gap = .08
        x0, x1 = self.grid[0][cell[0]] + gap, self.grid[0][cell[0] + 1] - gap
        y0, y1 = self.grid[1][cell[1]] + gap, self.grid[1][cell[1] + 1] - gap
        for side in range(4):
            length = x1 - x0 if side % 2 == 0 else y1 - y0
            at = .15
            while at < length - .6:
                kind, size = self.random.choice(FURNITURE)
                size = [s * self.random.uniform(.85, 1.15) for s in size]
                if self.random.random() < .4:
                    at += self.random.uniform(.4, 1.0)
                    continue
                if size[0] > 1.0 and min(x1 - x0, y1 - y0) < 4:
                    at += .3
                    continue
                if at + size[1] > length - .15:
                    break
                along, off = at + size[1] / 2, size[0] / 2 + .02
                x, y, yaw = [(x0 + along, y0 + off, 90), (x1 - off, y0 + along, 180),
                             (x0 + along, y1 - off, -90), (x0 + off, y0 + along, 0)][side]
                in_corner = side % 2 == 1 and (at < 1.0 or at + size[1] > length - 1.0)
                if self.is_clear(cell, x, y, .5 * math.hypot(size[0], size[1])) and not in_corner:
                    self.add_piece(kind, x, y, size, yaw)
                at += size[1] + self.random.uniform(.05, .8)

    def is_clear(self, cell, x, y, radius):
        """Is a piece away from all doors and from the ways between them and the room's centre?"""
        centre = self.centre(cell)
        if math.hypot(x - centre[0], y - centre[1]) <= radius * .7 + .55:
            return False
        for cells, door in self.doors.items():
            if math.hypot(x - door.x, y - door.y) <= radius + .75:
                return False
            if cell not in cells:
                continue
            way = (centre[0] - door.x, centre[1] - door.y)
            share = ((x - door.x) * way[0] + (y - door.y) * way[1]) / max(1e-9, math.hypot(*way)**2)
            share = max(0, min(1, share))
            if math.hypot(x - door.x - share * way[0],
                          y - door.y - share * way[1]) <= radius * .8 + .45:
                return False
        return True

    def add_piece(self, kind, x, y, size, yaw):
        skewed = self.random.uniform(-3, 3) * (self.random.random() < .5)
        self.add_section(f"{kind} f{self.pieces}", f"at = {x:.3f} {y:.3f} 0",
                         "size = {:.3f} {:.3f} {:.3f}".format(*size),
                         f"yaw = {yaw + skewed:.1f} deg")
        self.pieces += 1
        if size[2] < 1 and self.random.random() < .5:
            width, height = self.random.uniform(.2, .4), self.random.uniform(.15, .35)
            self.add_section(f"box b{self.pieces}", f"at = {x:.3f} {y:.3f} {size[2] + .002:.3f}",
                             f"size = .2 {width:.3f} {height:.3f}",
                             f"yaw = {self.random.randint(0, 90)} deg")
            self.pieces += 1

    def tour(self):
        """Places of the way and whether a room is entered there: depth first and back."""
        beside = {cell: [] for cell in self.cells()}
        for (a, b), door in self.doors.items():
            beside[a].append((b, door))
            beside[b].append((a, door))
        places, seen = [], set()

        def pass_door(door, a, b):
            axis = door.across
            step = .45 if self.centre(b)[axis] > self.centre(a)[axis] else -.45
            dx, dy = (step, 0) if axis == 0 else (0, step)
            places.append((door.x - dx, door.y - dy, False))
            places.append((door.x + dx, door.y + dy, False))

        def visit(cell):
            seen.add(cell)
            places.append((*self.centre(cell), True))
            for other, door in beside[cell]:
                if other in seen:
                    continue
                pass_door(door, cell, other)
                visit(other)
                pass_door(door, other, cell)
                places.append((*self.centre(cell), False))
        visit(self.cells()[0])
        return places

    def add_path(self):
        places = self.tour()
        z = self.random.uniform(1.2, 1.6)
        waypoints = []
        for k, (x, y, enters) in enumerate(places):
            to_x, to_y, _ = places[(k + 1) % len(places)]
            yaw = math.degrees(math.atan2(to_y - y, to_x - x)) \
                if math.hypot(to_x - x, to_y - y) > 1e-6 else 0
            if not enters:
                waypoints.append((x, y, z, yaw, self.random.uniform(8, 16)))
                continue
            turn = self.random.choice([-1, 1])
            for turned in (-110, -55, 0):
                waypoints.append((x + self.random.uniform(-.1, .1),
                                  y + self.random.uniform(-.1, .1), z, yaw + turn * turned,
                                  self.random.uniform(8, 18)))
        self.add_section("path", *("waypoint = {:.3f} {:.3f} {:.3f}  {:.1f} deg {:.1f} deg"
                                   .format(*waypoint) for waypoint in waypoints))


def parse():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("seed", type=int)
    parser.add_argument("output", type=pathlib.Path, help="scene file")
    return parser.parse_args()


def main():
    options = parse()
    options.output.write_text(Flat(options.seed).text())


if __name__ == "__main__":
    main()
