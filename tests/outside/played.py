"""What a trajectory controller makes of a plan: the cubic through positions and velocities, at 1 kHz."""

import numpy as np

# Into how many parts a step is cut where tips are compared.
SUB_STEPS = 7


class Played:
    """The checks of what is played; part of a re-check."""

    def row(self):
        """All states once: times, joints, velocities."""
        once = [q for s, k, q in self.states if s == 0 or k > 0]
        t = np.array([q["time"] for q in once])
        q = np.array([np.concatenate(state["joints"]) for state in once])
        v = None
        if all(state.get("velocities") for state in once):
            v = np.array([np.concatenate(state["velocities"]) for state in once])
        return t, q, v

    def played(self):
        """The cubic through positions and velocities keeps limits at 1 kHz, and stays close to the lines."""
        t, q, v = self.row()
        self.faults.note("times", not (np.diff(t) > 0).all(), "time does not increase", np.argmin(np.diff(t)))
        self.faults.note("velocities", v is None, "there are none", "states")
        if "times" in self.faults.found or v is None:
            return
        at_rest = not (v[0].any() or v[-1].any())
        self.faults.note("accelerations", not at_rest, "the motion does not start and end at rest", "ends")
        samples = np.append(np.arange(0.0, t[-1], 1e-3), t[-1])
        positions, steps, f = cubic(t, q, v, samples)
        top = np.array([joint.get("velocity", 2.0) for joint in self.hand.joints])
        steep = np.array([joint.get("acceleration", 20.0) for joint in self.hand.joints])
        still = positions[[0, -1]]
        positions = np.vstack(
            [still[:1], positions[:-1], still[1:]]
        )  # The last, shorter interval is left out.
        speeds = np.abs(np.diff(positions[:-1], axis=0)) / 1e-3 / top
        rates = np.abs(np.diff(positions[:-1], n=2, axis=0)) / 1e-6 / steep
        self.measure("velocities", speeds.max(), 1.01, (samples[speeds.max(axis=1).argmax()], "s"))
        self.measure(
            "accelerations", rates.max(initial=0.0), 1.01, (samples[rates.max(axis=1).argmax()], "s")
        )
        self.deviation(t, q, v)

    def deviation(self, t, q, v):
        """How far tips are from where the lines have them, all joints at one progress along their line."""
        for f in np.arange(1, SUB_STEPS) / SUB_STEPS:
            h = np.diff(t)[:, None]
            change = np.diff(q, axis=0)
            played = cubic_at(q[:-1], q[1:], v[:-1] * h, v[1:] * h, f)
            square = np.maximum((change**2).sum(axis=1), 1e-300)
            progress = np.clip(((played - q[:-1]) * change).sum(axis=1) / square, 0, 1)[:, None]
            meant = q[:-1] + change * progress
            for step in np.flatnonzero(np.abs(played - meant).max(axis=1) > 1e-7):
                tips = []
                for joints in (played[step], meant[step]):
                    self.hand.place(joints)
                    tips.append([self.hand.tip(f) for f in range(len(self.hand.tips))])
                off = np.linalg.norm(np.subtract(*tips), axis=1).max()
                self.measure("controller", off, self.tolerances["closure"] / 2, (t[step], "s"))


def cubic_at(a, b, v, w, f):
    """The cubic from a to b with slopes v and w (over the unit interval) at f."""
    g = 1 - f
    return a * (1 + 2 * f) * g * g + b * f * f * (3 - 2 * f) + v * f * g * g - w * f * f * g


def cubic(t, q, v, samples):
    """The played positions at the samples, the step of each and the fraction of it."""
    steps = np.clip(np.searchsorted(t, samples, side="right") - 1, 0, len(t) - 2)
    h = (t[steps + 1] - t[steps])[:, None]
    f = (samples - t[steps])[:, None] / h
    return cubic_at(q[steps], q[steps + 1], v[steps] * h, v[steps + 1] * h, f), steps, f
