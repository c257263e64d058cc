#!/usr/bin/env python3
"""Carry out an exported plan in MuJoCo: does the object arrive?

usage: mujoco_replay.py PLAN.json [options]      exports the plan with `regrasp` first
       mujoco_replay.py FOLDER [options]         a folder with one `STEM.mjcf.xml` and its `STEM.controls.csv`

The same replay as `regrasp replay` makes in rapier, with the same figures, in a simulator that nobody here wrote: the object is free under the
model's gravity and held by friction alone. Each joint is driven by a motor with a stiffness, a damping and the joint's effort limit, as the model
has them; it aims where `controls.csv` says (positions of the plan, the grasp's efforts fed forward through the spring) and, as
rapier's, damps the difference from the planned speed. Nothing looks at where the object is. Between two segments the forces pass
over to the fingers that hold next while everything rests. Contacts of soft fingers have torsional friction (condim 4).

Differs from rapier's: the fingers' links meet the object too, motors have more inertia, a convex mesh is met by its exact hull, and contacts are
springs (of two milliseconds), so that objects sink in by hundredths of a millimetre and creep a little.

Exit codes: 0 the object arrives; 2 bad input; 4 it does not arrive.
Needs Python 3.10, and the packages `mujoco` and `numpy`.
"""

import argparse
import csv
import json
import math
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import mujoco
import numpy as np

# What `regrasp replay` assumes too: see its help, and framework/physics/src/replay.rs.
ARRIVAL = (5e-3, math.radians(5))  # distance (m) and angle (rad) at the end
DROPPED = (20e-3, 0.5)  # distance (m) and angle (rad) at which a replay ends
SLIP = 1e-3  # slip of a contact (m) that is worth a word
GAP = 5e-4  # gap between a holding fingertip and the object (m) that is worth a word
FARTHEST = 1e-3  # gaps are looked at up to here (m)
TIME_STEP = 5e-4  # s
MEASURED = 4  # every so many steps


class BadInput(Exception):
    """What cannot be replayed, and why."""


@dataclass
class Knot:
    """What the motors are told at one time, and where the plan has the object then."""

    time: float
    target: np.ndarray
    speed_joints: np.ndarray  # positions of the driven joints, whose change is the speed
    position: np.ndarray
    orientation: np.ndarray  # w, x, y, z


@dataclass
class Segment:
    """One transfer or regrasp of the plan."""

    moving: str  # the moving fingertip's body; empty in a transfer
    knots: list = field(default_factory=list)
    holding: list = field(default_factory=list)  # fingertips' bodies, one list a knot
    margins: list = field(default_factory=list)


@dataclass
class Report:
    """What happened in one segment."""

    moving: str
    begin: float
    slip: dict
    gap: dict
    margin: float
    distance: float = 0.0
    angle: float = 0.0
    end_distance: float = 0.0
    end_angle: float = 0.0
    failure: dict | None = None
    track: list = field(default_factory=list)

    def events(self):
        """What went wrong, in the words of `regrasp replay`."""
        words = ["dropped"] if self.failure else []
        words += ["no allowed forces hold the weight"] if self.margin <= 0 else []
        words += [f"{name(tip)} slips {slip * 1e3:.1f} mm" for tip, slip in self.slip.items() if slip > SLIP]
        return words + [f"{name(tip)} loses the object" for tip, gap in self.gap.items() if gap > GAP]

    def is_off(self):
        return bool(self.failure) or self.distance > ARRIVAL[0] or self.angle > ARRIVAL[1]


def name(tip):
    """A finger's name from its fingertip's."""
    return tip.removesuffix("-tip")


def angle_between(a, b):
    """Angle (rad) between two orientations."""
    w, v = a @ b, np.linalg.norm(a[0] * b[1:] - b[0] * a[1:] - np.cross(a[1:], b[1:]))
    return 2 * math.atan2(v, abs(w))


def slerp(a, b, s):
    """The orientation a part s of the way from a to b."""
    b = b if a @ b >= 0 else -b
    half = math.acos(min(1.0, a @ b))
    if half < 1e-9:
        return b
    return (math.sin((1 - s) * half) * a + math.sin(s * half) * b) / math.sin(half)


def read_controls(path, model):
    """The segments of a table of controls, their times as the plan has them."""
    try:
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
        motors = [model.actuator(index).name for index in range(model.nu)]
        segments = {}
        for row in rows:
            segment = segments.setdefault(int(row["segment"]), Segment(row["moving"]))
            numbers = lambda names: np.array([float(row[name]) for name in names])
            knot = Knot(
                float(row["time"]),
                numbers(f"target.{motor}" for motor in motors),
                numbers(f"joint.{motor}" for motor in motors),
                numbers(f"object.{axis}" for axis in "xyz"),
                numbers(f"object.q{axis}" for axis in "wxyz"),
            )
            segment.knots.append(knot)
            segment.holding.append([tip for tip in row["holding"].split(";") if tip])
            segment.margins.append(float(row["force_margin"]) if row["force_margin"] else -math.inf)
    except (OSError, KeyError, ValueError) as error:
        raise BadInput(f"{path}: {error!r}: not a table of controls that `regrasp export --to mjcf` wrote") from error
    if not segments:
        raise BadInput(f"{path}: it has no rows")
    return [segments[index] for index in sorted(segments)]


class Replay:
    """A simulation under way."""

    def __init__(self, model, segments, arguments):
        self.model, self.data = model, mujoco.MjData(model)
        self.segments, self.slowdown, self.shift = segments, arguments.slowdown, arguments.shift
        self.object = model.body("object").id
        self.object_geoms = [geom for geom in range(model.ngeom) if model.geom_bodyid[geom] == self.object]
        self.tips = [model.body(body).name for body in range(model.nbody) if model.body(body).name.endswith("-tip")]
        self.tip_geom = {tip: model.geom(tip).id for tip in self.tips}
        # A motor is kp (target - q) - kv q'; with its target ahead by kv/kp of the planned speed it damps the difference of speeds.
        self.ahead = -model.actuator_biasprm[:, 2] / model.actuator_gainprm[:, 0]
        mujoco.mj_resetDataKeyframe(model, self.data, model.key("start").id)
        mujoco.mj_forward(model, self.data)
        self.clock, self.last, self.reports = 0.0, None, []

    def run(self):
        for index, segment in enumerate(self.segments):
            self.reports.append(self.segment(segment, index + 1 == len(self.segments)))
            if self.reports[-1].failure:
                break
        return self

    def schedule(self, segment, is_last):
        """Knots with the times of the replay, and who holds from each to the next: forces pass over first."""
        start, first = self.clock + self.shift, segment.knots[0].time
        knots = [Knot(**{**vars(k), "time": start + (k.time - first) * self.slowdown}) for k in segment.knots]
        before, held = self.last or (knots[0], segment.holding[0])
        knots.insert(0, Knot(**{**vars(before), "time": self.clock}))
        holding = [[tip for tip in held if tip in segment.holding[0]], *segment.holding]
        if is_last:
            knots.append(Knot(**{**vars(knots[-1]), "time": knots[-1].time + self.shift}))
            holding.append(holding[-1])
        return knots, holding

    def segment(self, segment, is_last):
        knots, holding = self.schedule(segment, is_last)
        zeros = lambda: dict.fromkeys(self.tips, 0.0)
        report = Report(segment.moving, self.clock, zeros(), zeros(), min(segment.margins))
        slip = {tip: np.zeros(3) for tip in self.tips}
        for state, (a, b) in enumerate(zip(knots, knots[1:])):
            steps = max(1, math.ceil((b.time - a.time) / TIME_STEP - 1e-9))
            self.model.opt.timestep = max((b.time - a.time) / steps, 1e-6)
            speed = (b.speed_joints - a.speed_joints) / (b.time - a.time) if b.time > a.time else 0 * a.speed_joints
            for step in range(1, steps + 1):
                s = step / steps
                self.data.ctrl[:] = a.target + s * (b.target - a.target) + self.ahead * speed
                mujoco.mj_step(self.model, self.data)
                left = step % MEASURED
                if left == 0 or step == steps:
                    self.measure((a, b, s), holding[state], (left or MEASURED) * self.model.opt.timestep, slip, report)
                    if report.failure:
                        report.failure.update(state=max(state - 1, 0))
                        self.clock = report.failure["time_s"]
                        self.end(segment, report)
                        return report
            report.track.append(self.moment(b.time))
        self.clock, self.last = knots[-1].time, (knots[-1], holding[-1])
        self.end(segment, report)
        return report

    def end(self, segment, report):
        goal = segment.knots[-1]
        report.end_distance, report.end_angle = self.off(goal.position, goal.orientation)
        if report.failure:
            report.track.append(self.moment(self.clock))

    def pose(self):
        return self.data.xpos[self.object], self.data.xquat[self.object]

    def moment(self, time):
        position, orientation = self.pose()
        return {"time_s": time, "position": position.tolist(), "orientation": orientation.tolist()}

    def off(self, position, orientation):
        """How far the object is from a pose: distance (m) and angle (rad)."""
        here, turned = self.pose()
        return float(np.linalg.norm(here - position)), angle_between(turned, orientation)

    def measure(self, when, holding, span, slip, report):
        """Takes what there is after a step into the report; slip grows by `span` seconds of the present speed."""
        a, b, s = when
        # Positions of bodies are those before the step: `mj_step` leaves them there.
        mujoco.mj_kinematics(self.model, self.data)
        distance, angle = self.off(a.position + s * (b.position - a.position), slerp(a.orientation, b.orientation, s))
        report.distance, report.angle = max(report.distance, distance), max(report.angle, angle)
        if distance > DROPPED[0] or angle > DROPPED[1] or not np.isfinite(distance + angle):
            time = a.time + s * (b.time - a.time)
            report.failure = {"what": "the object strayed", "time_s": time, "state": 0}
            return
        touching = self.touching()
        for tip in holding:
            contact = touching.get(tip)
            if contact is None:
                report.gap[tip] = max(report.gap[tip], self.gap(tip))
                continue
            slip[tip] += self.sliding(tip, contact) * span
            report.slip[tip] = max(report.slip[tip], float(np.linalg.norm(slip[tip])))

    def touching(self):
        """For each fingertip on the object its deepest contact."""
        deepest = {}
        tips = {geom: tip for tip, geom in self.tip_geom.items()}
        for contact in self.data.contact[: self.data.ncon]:
            one, other = (int(geom) for geom in contact.geom)
            tip = tips.get(one) or tips.get(other)
            is_object = self.model.geom_bodyid[other if one in tips else one] == self.object
            if tip and is_object and (tip not in deepest or contact.dist < deepest[tip].dist):
                deepest[tip] = contact
        return deepest

    def gap(self, tip):
        geom = self.tip_geom[tip]
        gaps = [mujoco.mj_geomDistance(self.model, self.data, geom, other, FARTHEST, None) for other in self.object_geoms]
        return max(0.0, min(gaps))

    def sliding(self, tip, contact):
        """Velocity (m/s, in O) with which the fingertip slides on the object at their contact."""
        normal = contact.frame[:3]
        velocity = self.velocity(self.model.body(tip).id, contact.pos) - self.velocity(self.object, contact.pos)
        along = velocity - normal * (normal @ velocity)
        return self.data.xmat[self.object].reshape(3, 3).T @ along

    def velocity(self, body, point):
        result = np.zeros(6)
        mujoco.mj_objectVelocity(self.model, self.data, mujoco.mjtObj.mjOBJ_XBODY, body, result, 0)
        return result[3:] + np.cross(result[:3], point - self.data.xpos[body])

    @property
    def arrived(self):
        last = self.reports[-1]
        made = len(self.reports) == len(self.segments) and not last.failure
        return made and last.end_distance <= ARRIVAL[0] and last.end_angle <= ARRIVAL[1]

    def why(self):
        """Where and why the object does not arrive, in the words of `regrasp replay`."""
        first = next((index for index, report in enumerate(self.reports) if report.is_off()), None)
        last, text = self.reports[-1], "the object does not arrive"
        if last.failure:
            text += f": dropped in segment {len(self.reports) - 1}, state {last.failure['state']}, at {last.failure['time_s']:.2f} s"
        else:
            text += f": in the end {last.end_distance * 1e3:.1f} mm and {math.degrees(last.end_angle):.1f}° off"
        if first is None:
            return text
        return f"{text}; first off its path in segment {first}: {', '.join(self.reports[first].events()) or 'it drifts'}"

    def json(self, plan, with_track):
        last = self.reports[-1]
        return {
            "format": "regrasp-replay",
            "version": 1,
            "simulator": f"MuJoCo {mujoco.__version__}",
            **plan,
            "arrived": self.arrived,
            "reason": None if self.arrived else self.why(),
            "segments_in_plan": len(self.segments),
            "duration_s": self.clock,
            "distance_m": max(report.distance for report in self.reports),
            "angle_rad": max(report.angle for report in self.reports),
            "end_distance_m": last.end_distance,
            "end_angle_rad": last.end_angle,
            "assumed": self.assumed(),
            "segments": [self.told(index, report, with_track) for index, report in enumerate(self.reports)],
        }

    def assumed(self):
        geom = self.object_geoms[0]
        return {
            "gravity_m_s2": self.model.opt.gravity.tolist(),
            "friction": float(self.model.geom_friction[geom, 0]),
            "torsional_friction_m": float(self.model.geom_friction[geom, 1]),
            "condim": int(self.model.geom_condim[geom]),
            "mass_kg": float(self.model.body_mass[self.object]),
            "time_step_s": TIME_STEP,
            "slowdown": self.slowdown,
            "shift_s": self.shift,
        }

    def told(self, index, report, with_track):
        told = {
            "segment": index,
            "kind": "regrasp" if report.moving else "transfer",
            "finger": name(report.moving) or None,
            "begin_s": report.begin,
            "distance_m": report.distance,
            "angle_rad": report.angle,
            "end_distance_m": report.end_distance,
            "end_angle_rad": report.end_angle,
            "margin_n": report.margin if math.isfinite(report.margin) else None,
            "slip_m": [report.slip[tip] for tip in self.tips],
            "gap_m": [report.gap[tip] for tip in self.tips],
            "events": report.events(),
            "failure": report.failure,
        }
        return {**told, "object": report.track} if with_track else told

    def text(self, title):
        worst = max(report.distance for report in self.reports), max(report.angle for report in self.reports)
        last = self.reports[-1]
        lines = [
            f"{title}: the object {'arrives' if self.arrived else 'does not arrive'} "
            f"({len(self.reports)} of {len(self.segments)} segments, {self.clock:.1f} s simulated)",
            f"  largest deviation {worst[0] * 1e3:.2f} mm, {math.degrees(worst[1]):.2f}°; "
            f"in the end {last.end_distance * 1e3:.2f} mm, {math.degrees(last.end_angle):.2f}°",
            "  segment                 begins    off by  turned by      slip   margin  end off by  turned by",
        ]
        for index, report in enumerate(self.reports):
            kind = f"regrasp {name(report.moving)}" if report.moving else "transfer"
            lines.append(
                f"  {index:7}  {kind:<14} {report.begin:6.2f} s {report.distance * 1e3:6.2f} mm {math.degrees(report.angle):9.2f}° "
                f"{max(report.slip.values()) * 1e3:6.2f} mm {report.margin:6.2f} N {report.end_distance * 1e3:8.2f} mm "
                f"{math.degrees(report.end_angle):9.2f}°  {', '.join(report.events())}".rstrip()
            )
        return "\n".join(lines)


def number(low, high):
    """Takes a number in a range."""

    def read(text):
        value = float(text)
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"it must be a number in {low}..={high}")
        return value

    read.__name__ = "number"
    return read


def vector(text):
    values = [float(part) for part in text.split(",")]
    if len(values) != 3 or not all(map(math.isfinite, values)):
        raise argparse.ArgumentTypeError("it must be three numbers with commas between them, such as 0,0,-9.81")
    return values


def read_arguments(words):
    head, _, tail = __doc__.partition("\n\nusage: ")
    parser = argparse.ArgumentParser(description=head, epilog=tail.partition("\n\n")[2], formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("plan", type=Path, help="a plan file, or a folder with what `regrasp export PLAN --to mjcf` wrote")
    add("--json", action="store_true", help="print one JSON object, as `regrasp replay --json` does")
    add("-o", "--output", type=Path, metavar="FILE", help="write it to this file too, with the object's poses: `regrasp view PLAN --replay FILE`")
    add("--friction-scale", type=number(0, 10), default=1.0, metavar="X", help="multiply the simulated friction by this (default 1)")
    add("--mass-scale", type=number(1e-3, 1000), default=1.0, metavar="X", help="multiply the object's mass by this (default 1)")
    add("--slowdown", type=number(0.1, 100), default=2.0, metavar="X", help="multiply the plan's times by this (default 2)")
    add("--shift", type=number(0.01, 10), default=0.1, metavar="S", help="time in which forces pass over between segments (default 0.1 s)")
    add("--gravity", type=vector, metavar="X,Y,Z", help="gravity in the hand's frame (m/s²); by default the model's")
    add("--regrasp", default=os.environ.get("REGRASP", "regrasp"), metavar="PROGRAM", help="the program that exports plans (default: $REGRASP, else regrasp)")
    return parser.parse_args(words)


def exported(arguments, scratch):
    """The folder with the export: the one given, or a fresh one."""
    if arguments.plan.is_dir():
        return arguments.plan
    if not arguments.plan.is_file():
        raise BadInput(f"{arguments.plan}: there is no such file or folder")
    refuse_points(arguments.plan)
    try:
        done = subprocess.run(
            [arguments.regrasp, "export", arguments.plan, "--to", "mjcf", "-o", scratch], capture_output=True, text=True, check=False
        )
    except OSError as error:
        raise BadInput(f"{arguments.regrasp}: {error.strerror}; name the program with --regrasp") from error
    if done.returncode:
        raise BadInput(done.stderr.strip())
    return Path(scratch)


def refuse_points(plan):
    """Refuses plans of hands that declare point fingertips: simulated ones are balls, and balls roll."""
    try:
        told = json.loads(plan.read_text())
    except (OSError, ValueError):
        return  # the export says what is wrong with the file
    hand = told.get("scenario", {}).get("problem", {}).get("hand", {}) if isinstance(told, dict) else {}
    if hand.get("fingertip") == "point":
        raise BadInput("the hand declares point fingertips, which stay where they are set down, but simulated ones are balls, which roll")


def load(folder):
    """The model and the segments of an exported plan."""
    models = sorted(folder.glob("*.mjcf.xml"))
    if len(models) != 1:
        raise BadInput(f"{folder}: it must hold one `*.mjcf.xml`, but holds {len(models)}")
    try:
        model = mujoco.MjModel.from_xml_path(str(models[0]))
    except ValueError as error:
        raise BadInput(f"{models[0]}: {error}") from error
    return model, read_controls(folder / models[0].name.replace(".mjcf.xml", ".controls.csv"), model)


def plan_of(arguments, model):
    """The plan's scenario and seed; an exported folder does not tell the seed."""
    if arguments.plan.is_dir():
        return {"scenario": mujoco_name(model), "seed": None}
    plan = json.loads(arguments.plan.read_text())
    return {"scenario": plan["scenario"]["name"], "seed": plan["seed"]}


def mujoco_name(model):
    """The name that a model gives itself: the first of its names."""
    return model.names.split(b"\0", 1)[0].decode()


def change(model, arguments):
    """Friction, mass and gravity as the arguments want them."""
    model.geom_friction[:, :2] *= arguments.friction_scale
    body = model.body("object").id
    model.body_mass[body] *= arguments.mass_scale
    model.body_inertia[body] *= arguments.mass_scale
    if arguments.gravity:
        model.opt.gravity[:] = arguments.gravity
    mujoco.mj_setConst(model, mujoco.MjData(model))


def main(words=None):
    arguments = read_arguments(words)
    try:
        with tempfile.TemporaryDirectory() as scratch:
            model, segments = load(exported(arguments, scratch))
            plan = plan_of(arguments, model)
        change(model, arguments)
        replay = Replay(model, segments, arguments).run()
        if arguments.output:
            arguments.output.write_text(json.dumps(replay.json(plan, True)))
    except BadInput as error:
        print(error, file=sys.stderr)
        return 2
    except OSError as error:
        print(f"{arguments.output}: {error.strerror}", file=sys.stderr)
        return 2
    print(json.dumps(replay.json(plan, False)) if arguments.json else replay.text(arguments.plan))
    if not replay.arrived:
        print(replay.why(), file=sys.stderr)
    return 0 if replay.arrived else 4


if __name__ == "__main__":
    sys.exit(main())
